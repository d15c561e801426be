"""Viscoelastic memory of rubber from stroke to stroke, and over jumps of many cycles."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.memory import step_factors
from ngwear.effects.stroke_memory import StrokeMemory
from ngwear.fields.background_mesh import Background
from ngwear.materials import PronySeries
from ngwear.wear.cycle_jumps import Plan, before_last, whole

Array = NDArray[np.float64]
STORED = ("background", "durations", "ratios", "times", "relaxed", "stresses")


class CycleMemory:
    """Generalised Maxwell arms in cyclic sliding, stored on a background mesh of the unworn section.

    On a smooth surface the strain is constant during a stroke and steps at the reversal. The relaxed part of an arm,
    ``q = gamma S - Q``, is continuous there and follows ``q' = (gamma S_k - q) / tau`` during stroke k, of duration D.
    Wear depends on the mean pressure over the stroke: so one solve is done with the mean overstress of the arms:

        Qbar_k = sum_i a_i (gamma_i S_k - q_i,start),   a_i = (1 - exp(-D / tau_i)) tau_i / D.

    In a step of many cycles the stroke that is solved is the last of its kind. q at its start is an affine function of
    q at the start of the step and of the stresses S_j of all strokes of the cycle. The part with S_k is implicit; the
    other S_j are those of their last solve.

    Neglected: creep of the strain during a stroke, above all under fluid pressure. ``ngwear verify stroke_memory``
    measures it, ``ngwear.loop.time_step_error`` estimates it in a run, and ``Accuracy.parts`` reduces it.

    Parameters
    ----------
    background : Background
    series : PronySeries
    durations : sequence of float
        Duration of each stroke of the cycle [s].
    mounted : array, shape (elements, 12, 4)
        S_iso of the mounted part at the points of the background mesh [MPa].
    rest : float
        Time from mounting to the first stroke [s].
    """

    def __init__(
        self, background: Background, series: PronySeries, durations: Sequence[float], *, mounted: Array, rest: float
    ) -> None:
        self.background, self.durations = background, tuple(durations)
        self.ratios, self.times = np.array(series.ratios), np.array(series.times)
        relaxed = -self.ratios * np.expm1(-rest / self.times)
        self.relaxed = relaxed[:, None, None, None] * mounted  # q_i; replaced, never written to
        self.stresses = (mounted,) * len(self.durations)  # S_k, likewise

    def to_data(self) -> dict[str, Any]:
        """The memory as plain data, from which ``from_data`` restores it exactly."""
        return {name: getattr(self, name) for name in STORED}

    @classmethod
    def from_data(cls, data: dict[str, Any]) -> CycleMemory:
        """Restore the memory from plain data."""
        memory = cls.__new__(cls)
        for name in STORED:
            setattr(memory, name, data[name])
        return memory

    def in_halves(self) -> CycleMemory:
        """The same memory for a cycle in which each stroke is divided into two halves."""
        halves = copy(self)
        halves.durations = tuple(duration / 2 for duration in self.durations for _ in range(2))
        halves.stresses = tuple(stress for stress in self.stresses for _ in range(2))
        return halves

    def prepare(self, term: StrokeMemory, plan: Plan, kind: int) -> None:
        """Give the term its history for the solve of the last stroke of a kind; the memory is at the plan's start."""
        before = before_last(plan, kind, self.durations, self.times)
        _, mean = step_factors(self.durations[kind], self.times)
        weight = mean * self.ratios
        history = -np.tensordot(mean * before.decay, self.relaxed, axes=1)
        for other, feed in enumerate(before.feed):
            if other != kind and feed.any():
                history -= float(weight @ feed) * self.stresses[other]
        term.hold(float(weight @ (1 - before.feed[kind])), history)

    def record(self, term: StrokeMemory, kind: int) -> None:
        """Store the stress at the equilibrium of a stroke."""
        stresses = list(self.stresses)
        stresses[kind] = term.stress()
        self.stresses = tuple(stresses)

    def commit(self, plan: Plan) -> None:
        """Advance the memory to the end of a plan whose strokes are all solved."""
        done = whole(plan, self.durations, self.times)
        relaxed = done.decay[:, None, None, None] * self.relaxed
        for stress, feed in zip(self.stresses, done.feed, strict=True):
            for q, weight in zip(relaxed, self.ratios * feed, strict=True):
                q += weight * stress
        self.relaxed = relaxed
