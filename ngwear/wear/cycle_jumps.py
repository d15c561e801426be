"""What many strokes do to the arms of a memory, all at once."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

Plan = Sequence[tuple[int, int]]  # (kind of stroke, how many of its kind), in the order in which they follow each other


def planned(kinds: int, done: int, cycles: int, end: int) -> Plan:
    """Strokes of a step of so many cycles after ``done`` strokes: each kind in turn, how often, to ``end`` at most."""
    plan = [((done + k) % kinds, min(cycles, math.ceil((end - done - k) / kinds))) for k in range(kinds)]
    return [(kind, repeats) for kind, repeats in plan if repeats > 0]


@dataclass(frozen=True)
class ArmMap:
    """``q -> exp(-span / tau) q + gamma sum_k feed_k S_k``: what some strokes do to what an arm has relaxed.

    While a stroke of duration D lasts, its strain stands still, and ``q' = (gamma S - q) / tau`` has an exact solution.
    Strokes one after the other make such a map again, and so do N equal cycles, by the sum of a geometric series.

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
        """No stroke at all."""
        return cls(times, 0.0, np.zeros((kinds, len(times))))

    @property
    def decay(self) -> Array:
        """What is left of q [-], shape (arms,)."""
        return np.exp(-self.span / self.times)

    def stroke(self, kind: int, duration: float) -> ArmMap:
        """One stroke more."""
        feed = self.feed * np.exp(-duration / self.times)
        feed[kind] -= np.expm1(-duration / self.times)
        return ArmMap(self.times, self.span + duration, feed)

    def repeated(self, count: int) -> ArmMap:
        """The same ``count`` times, >= 0."""
        # (1 - x^count) / (1 - x) with x = exp(-span / tau)
        x = self.span / self.times
        return ArmMap(self.times, count * self.span, self.feed * (np.expm1(-count * x) / np.expm1(-x)))

    def then(self, later: ArmMap) -> ArmMap:
        """Both, one after the other."""
        return ArmMap(self.times, self.span + later.span, self.feed * later.decay + later.feed)


def before_last(plan: Plan, kind: int, durations: Sequence[float], times: Array) -> ArmMap:
    """What happens from the start of a plan of strokes to the start of its last stroke of a kind.

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
    """What all strokes of a plan do."""
    most = max(count for _, count in plan)
    last = [index for index, count in plan if count == most][-1]
    return before_last(plan, last, durations, times).stroke(last, durations[last])
