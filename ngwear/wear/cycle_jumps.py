"""Effect of many strokes on the Maxwell arms, in closed form."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

Plan = Sequence[tuple[int, int]]  # (kind of stroke, how many of its kind), in the order in which they follow each other


def planned(kinds: int, done: int, cycles: int, end: int) -> Plan:
    """Strokes of a step of ``cycles`` cycles after ``done`` strokes, up to ``end``: each kind and its number."""
    plan = [((done + k) % kinds, min(cycles, math.ceil((end - done - k) / kinds))) for k in range(kinds)]
    return [(kind, repeats) for kind, repeats in plan if repeats > 0]


@dataclass(frozen=True)
class ArmMap:
    """``q -> exp(-span / tau) q + gamma sum_k feed_k S_k``: change of the relaxed stress q of an arm by some strokes.

    During a stroke the strain is taken as constant, so that ``q' = (gamma S - q) / tau`` has an exact solution. A
    sequence of strokes is again such a map, and so are N equal cycles, by the sum of a geometric series.

    Attributes
    ----------
    times : array, shape (arms,)
        tau [s].
    span : float
        Duration of the strokes [s].
    feed : array, shape (kinds, arms)
        Weights of the stresses S of each kind of stroke [-].
    """

    times: Array
    span: float
    feed: Array

    @classmethod
    def nothing(cls, times: Array, kinds: int) -> ArmMap:
        """The map without any stroke."""
        return cls(times, 0.0, np.zeros((kinds, len(times))))

    @property
    def decay(self) -> Array:
        """Factor on q [-], shape (arms,)."""
        return np.exp(-self.span / self.times)

    def stroke(self, kind: int, duration: float) -> ArmMap:
        """Return this map followed by one stroke."""
        feed = self.feed * np.exp(-duration / self.times)
        feed[kind] -= np.expm1(-duration / self.times)
        return ArmMap(self.times, self.span + duration, feed)

    def repeated(self, count: int) -> ArmMap:
        """Return this map ``count`` times, >= 0."""
        # (1 - x^count) / (1 - x) with x = exp(-span / tau)
        x = self.span / self.times
        return ArmMap(self.times, count * self.span, self.feed * (np.expm1(-count * x) / np.expm1(-x)))

    def then(self, later: ArmMap) -> ArmMap:
        """Return this map followed by ``later``."""
        return ArmMap(self.times, self.span + later.span, self.feed * later.decay + later.feed)


def before_last(plan: Plan, kind: int, durations: Sequence[float], times: Array) -> ArmMap:
    """Map from the start of a plan of strokes to the start of its last stroke of a kind.

    A plan's strokes follow each other in turn, A B A B ...; the last cycle may be cut short, so that the first kinds
    have one stroke more than the others.
    """
    nothing = ArmMap.nothing(times, len(durations))
    cycle, start = nothing, nothing
    for index, _ in plan:
        if index == kind:
            start = cycle
        cycle = cycle.stroke(index, durations[index])
    count = dict(plan)[kind] - 1
    return cycle.repeated(count).then(start) if count else start


def whole(plan: Plan, durations: Sequence[float], times: Array) -> ArmMap:
    """Map of all strokes of a plan."""
    most = max(count for _, count in plan)
    last = [index for index, count in plan if count == most][-1]
    return before_last(plan, last, durations, times).stroke(last, durations[last])
