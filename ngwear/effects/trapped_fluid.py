"""Fluid that contacts have cut off in pockets of the outline."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import ngsolve as ng
import numpy as np
from scipy.spatial import cKDTree

from ngwear.effects.base import DISPLACEMENT, Array, Unknowns
from ngwear.effects.contact import OutlineContact
from ngwear.effects.edge_pressure import EdgePressure
from ngwear.effects.fluid_pressure import LESS, STAYS, FluidPressure
from ngwear.effects.pockets import contact_pressures, pockets


class TrappedFluid(EdgePressure):
    """Follower traction ``-q n`` in pockets: the fluid that is left there when contacts cut it off.

    Of the pockets (``effects.pockets``) those that no fluid reaches from its inlet. A pocket takes the highest pressure
    that its mesh edges had in the last equilibrium and keeps it, as far as the contacts on both sides carry it (within
    ``fluid_pressure.LESS``); what they do not carry leaks out. q does not change with the volume of the pocket. A fluid
    whose pressure falls leaves a pocket until the contact before it closes: such a stroke has to be solved in load
    steps.

    q is fixed in a solve and updated after it, until the change of load is below ``fluid_pressure.STAYS``.

    Parameters
    ----------
    edges : sequence of str
        Edges that a fluid may reach.
    fluids : sequence of FluidPressure
        They come before this term in the problem's list.
    contacts : sequence of OutlineContact
    """

    def __init__(
        self, edges: Sequence[str], fluids: Sequence[FluidPressure], contacts: Sequence[OutlineContact]
    ) -> None:
        super().__init__(edges)
        self.fluids, self.contacts = tuple(fluids), tuple(contacts)
        self._begins = True

    def nominal(self) -> Any:
        return self.field

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        super().add_to(form, unknowns)
        inlets = [edge for fluid in self.fluids for edge in fluid.inlet]
        self._wettable = np.isin(self.names, self.edges) & ~np.isin(self.names, inlets)
        self.left = np.zeros(len(self.names))

    @property
    def pressures(self) -> Array:
        """Pressure q on each mesh edge, in the order of the outline, shape (m,) [MPa]; 0 outside pockets."""
        return self.on_edges

    @property
    def leaves(self) -> Array:
        """Reference place and pressure of each mesh edge that a fluid wets, to be given to ``leave``; shape (k, 3)."""
        pressures = np.maximum(self._wet(), self.pressures)
        return np.column_stack([self._middles, pressures])[pressures > 0]

    def leave(self, places: Array) -> None:
        """Begin a stroke with what ``leaves`` has given at the end of the last one, also on another mesh."""
        self._begins = True  # nothing of the last stroke but these places counts: a resumed run goes the same way
        self.left = np.zeros(len(self._lengths))
        if len(places):
            apart, nearest = cKDTree(places[:, :2]).query(self._middles)
            self.left = np.where(apart < self._lengths, places[nearest, 2], 0.0)

    def _wet(self) -> Array:
        """Pressure of the fluids from their inlets on each mesh edge, shape (m,) [MPa]."""
        return np.max([fluid.pressure.Get() * fluid.shares for fluid in self.fluids], axis=0)

    def prepare(self) -> None:
        self._begins = False

    def refresh(self, *, solved: bool = False) -> bool:
        q, carried = np.zeros(len(self._lengths)), 0.0
        wet = self._wet() > 0
        for pocket in pockets(self._body, self._unknowns.state[DISPLACEMENT], self.contacts):
            edges = pocket.edges
            if wet[edges].any() or not self._wettable[edges].all():
                continue
            q[edges] = self.left[edges].max()
            if self.pressures[edges].any() and not self._begins:  # else the contacts do not feel it yet
                q[edges] = np.minimum(q[edges], pocket.holds / (1 - LESS))
            if solved:
                self.left[edges] = q[edges]
        if solved:
            reached = np.max([fluid.shares for fluid in self.fluids], axis=0) > 0
            closed = contact_pressures(self._body, self.contacts).max(axis=0) > 0
            self.left = np.where(reached, self._wet(), np.where(closed, 0.0, self.left))
        for contact in self.contacts:
            carried += float(self._lengths[contact.positions] @ contact.end_pressures().mean(axis=1))
        if self._lengths @ np.abs(q - self.pressures) <= STAYS * carried and not self._begins:
            return False
        self.on_edges = q
        return True
