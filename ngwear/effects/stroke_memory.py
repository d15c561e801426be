"""Viscoelasticity in strokes: a known mean overstress, and the part that depends on the stroke's own strain."""

from __future__ import annotations

import ngsolve as ng

from ngwear.effects.base import Array, Unknowns
from ngwear.effects.memory import Memory
from ngwear.fields.background_mesh import Background
from ngwear.materials import Hyperelastic, PronySeries


class StrokeMemory(Memory):
    """Mean overstress of the arms over one stroke, ``share S + h`` (see ``ngwear.loop.memory_over_cycles``).

    Has no time steps: ``hold`` sets the data of a solve.

    Parameters
    ----------
    material : Hyperelastic
        Of the long-term behaviour.
    series : PronySeries
    background : Background
        Points at which h is stored.
    """

    def __init__(self, material: Hyperelastic, series: PronySeries, background: Background) -> None:
        super().__init__(material, series)
        self.background = background

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        self.lay(unknowns)
        self._seat = unknowns.seat(self.background)

    def hold(self, share: float, history: Array) -> None:
        """Set ``share`` and h for the next solve; h at the background's points, shape (elements, 12, 4) [MPa]."""
        self.share, self.history = share, self._seat.at_points(history)

    def stress(self) -> Array:
        """S_iso of the present state at the background's points, shape (elements, 12, 4) [MPa]."""
        return self.second_piola(self._seat.strain())
