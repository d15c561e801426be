"""Pareto front of runs, and the fastest setting for a target error."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence

from ngwear.error_estimates.ladder import Setting

ALIKE = 0.05  # relative difference of seconds that a second measurement would not repeat, on a shared machine


def pareto_front(points: Iterable[tuple[float, float]]) -> list[int]:
    """Indices of the points (seconds, error) that no other point beats in both, by increasing seconds."""
    points = list(points)
    front: list[int] = []
    for i in sorted(range(len(points)), key=lambda i: points[i]):
        if not front or points[i][1] < points[front[-1]][1]:
            front.append(i)
    return front


def cheapest(
    target: float,
    levels: Sequence[Iterable[int]],
    error: Callable[[Setting], float],
    seconds: Callable[[Setting], float],
    unfit: Iterable[Setting] = (),
    own: Setting = (),
) -> Setting | None:
    """The fastest combination of levels whose error is at most the target; None if there is none.

    Among combinations of nearly the same time, it is the one with the fewest changes from ``own``, then the most
    accurate one.

    Parameters
    ----------
    target : float
    levels : sequence of iterable of int
        Known levels of each ladder.
    error, seconds : callable
        Predicted error and time of a setting.
    unfit : iterable of Setting
        Settings whose measured error is too large.
    own : Setting
        Setting of the scene.
    """
    refused = set(unfit)
    fit = [s for s in itertools.product(*levels) if s not in refused and error(s) <= target]
    times = {s: seconds(s) for s in fit}
    fast = [s for s in fit if times[s] <= (1 + ALIKE) * min(times.values())]
    return min(fast, key=lambda s: (sum(a != b for a, b in zip(s, own, strict=False)), error(s)), default=None)


def product_seconds(base: Setting, rung_seconds: Sequence[Mapping[int, float]], setting: Setting) -> float:
    """Predicted seconds of a setting: those of the base times the factor measured on each ladder."""
    out = rung_seconds[0][base[0]]
    for k, level in enumerate(setting):
        out *= rung_seconds[k][level] / rung_seconds[k][base[k]]
    return out


def power_law(
    values: Sequence[float], seconds: Sequence[float], wanted: float, cost_exponent: float, highest: float = math.inf
) -> float:
    """Predicted seconds of the next finer value: ``t ~ value^-p``.

    p is measured from the two finest runs, but at least ``cost_exponent`` and at most 3; with a single run it is
    ``cost_exponent``. Fixed costs make p of coarse runs too small for finer ones.
    """
    p = cost_exponent
    if len(values) > 1 and values[-2] > values[-1] > 0:
        p = math.log(seconds[-1] / seconds[-2]) / math.log(values[-2] / values[-1])
        p = min(max(p, cost_exponent), 3.0)
    return min(seconds[-1] * (values[-1] / wanted) ** p, highest)
