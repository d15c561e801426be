"""What rubber remembers from stroke to stroke, and through jumps of many cycles."""

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
    """Generalised Maxwell arms under strokes, on a background of the unworn section.

    Along a smooth surface the strain stands still during a stroke and steps at the reversal. What an arm has relaxed,
    ``q = gamma S - Q``, is continuous there and follows ``q' = (gamma S_k - q) / tau`` during stroke k, of duration D.
    Wear follows the pressure's mean over the stroke, so that one solve with the arms' mean overstress does:

        Qbar_k = sum_i a_i (gamma_i S_k - q_i,start),   a_i = (1 - exp(-D / tau_i)) tau_i / D.

    In a step of many cycles the stroke that is solved is the last of its kind. q at its start is an affine map of q at
    the step's start and of the stresses S_j of all kinds of stroke; the part with S_k itself is taken implicitly, the
    others' S_j as they were solved last.

    Neglected: that strains creep during a stroke, under the fluid's pressure above all (``ngwear verify stroke_memory``
    measures it, a run states it by ``ngwear.loop.time_step_error``, and ``Accuracy.parts`` makes it less).

    Parameters
    ----------
    background : Background
    series : PronySeries
    durations : sequence of float
        Of each kind of stroke [s].
    mounted : array, shape (elements, 12, 4)
        S_iso of the mounted part at the background's points [MPa].
    rest : float
        How long it has sat mounted [s].
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
        """What ``from_data`` makes the same memory of, to the last bit."""
        return {name: getattr(self, name) for name in STORED}

    @classmethod
    def from_data(cls, data: dict[str, Any]) -> CycleMemory:
        """The memory again."""
        memory = cls.__new__(cls)
        for name in STORED:
            setattr(memory, name, data[name])
        return memory

    def in_halves(self) -> CycleMemory:
        """The same for a cycle whose strokes are divided once more, each into two."""
        halves = copy(self)
        halves.durations = tuple(duration / 2 for duration in self.durations for _ in range(2))
        halves.stresses = tuple(stress for stress in self.stresses for _ in range(2))
        return halves

    def enter(self, term: StrokeMemory, plan: Plan, kind: int) -> None:
        """Prepare the term for the solve of the last stroke of a kind in a plan that starts at what is committed."""
        before = before_last(plan, kind, self.durations, self.times)
        _, mean = step_factors(self.durations[kind], self.times)
        weight = mean * self.ratios
        history = -np.tensordot(mean * before.decay, self.relaxed, axes=1)
        for other, feed in enumerate(before.feed):
            if other != kind and feed.any():
                history -= float(weight @ feed) * self.stresses[other]
        term.hold(float(weight @ (1 - before.feed[kind])), history)

    def leave(self, term: StrokeMemory, kind: int) -> None:
        """Take note of the stress at the equilibrium of a stroke."""
        stresses = list(self.stresses)
        stresses[kind] = term.stress()
        self.stresses = tuple(stresses)

    def commit(self, plan: Plan) -> None:
        """Move the memory to the end of a plan whose strokes have all been solved."""
        done = whole(plan, self.durations, self.times)
        relaxed = done.decay[:, None, None, None] * self.relaxed
        for stress, feed in zip(self.stresses, done.feed, strict=True):
            for q, weight in zip(relaxed, self.ratios * feed, strict=True):
                q += weight * stress
        self.relaxed = relaxed
