"""Which runs no other run beats, and which settings are accurate enough for the least time."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence

from ngwear.error_estimates.ladder import Setting

ALIKE = 0.05  # relative difference of seconds that a second measurement would not repeat, on a shared machine


def pareto_front(points: Iterable[tuple[float, float]]) -> list[int]:
    """Indices of the points (seconds, error) that none beats in both, by rising seconds."""
    points = list(points)
    front: list[int] = []
    for i in sorted(range(len(points)), key=lambda i: points[i]):
        if not front or points[i][1] < points[front[-1]][1]:
            front.append(i)
    return front


def cheapest(
    target: float,
    rungs: Sequence[Iterable[int]],
    error: Callable[[Setting], float],
    seconds: Callable[[Setting], float],
    unfit: Iterable[Setting] = (),
    own: Setting = (),
) -> Setting | None:
    """The combination of rungs of least seconds whose error is at most the target; None if there is none.

    Among those that take hardly longer than the least, it is the one that changes the fewest knobs of ``own``, and of
    these the most accurate.

    Parameters
    ----------
    target : float
    rungs : sequence of iterable of int
        Of each ladder, those that are known.
    error, seconds : callable
        Of a setting, as predicted.
    unfit : iterable of Setting
        Those that measurement has shown not to be accurate enough.
    own : Setting
        The scene's.
    """
    refused = set(unfit)
    fit = [s for s in itertools.product(*rungs) if s not in refused and error(s) <= target]
    times = {s: seconds(s) for s in fit}
    fast = [s for s in fit if times[s] <= (1 + ALIKE) * min(times.values())]
    return min(fast, key=lambda s: (sum(a != b for a, b in zip(s, own, strict=False)), error(s)), default=None)


def product_seconds(base: Setting, rung_seconds: Sequence[Mapping[int, float]], setting: Setting) -> float:
    """Seconds of a combination: each ladder changes those of the base by the factor measured on it."""
    out = rung_seconds[0][base[0]]
    for k, rung in enumerate(setting):
        out *= rung_seconds[k][rung] / rung_seconds[k][base[k]]
    return out


def power_law(
    values: Sequence[float], seconds: Sequence[float], wanted: float, growth: float, highest: float = math.inf
) -> float:
    """Seconds of the next, finer value after the measured ones: ``t ~ value^-p``.

    p is that of the two finest, between the first guess ``growth`` and 3; the guess for a single one. Fixed costs make
    coarse runs alike, so that less than the guess says nothing of finer ones.
    """
    p = growth
    if len(values) > 1 and values[-2] > values[-1] > 0:
        p = math.log(seconds[-1] / seconds[-2]) / math.log(values[-2] / values[-1])
        p = min(max(p, growth), 3.0)
    return min(seconds[-1] * (values[-1] / wanted) ** p, highest)
