"""Fluid that contacts have cut off in pockets of the outline."""

from __future__ import annotations

from collections.abc import Sequence

import ngsolve as ng
import numpy as np
from scipy.spatial import cKDTree

from ngwear.effects.base import DISPLACEMENT, Array, Term, Unknowns
from ngwear.effects.contact import OutlineContact
from ngwear.effects.fluid_pressure import LESS, STAYS, FluidPressure
from ngwear.effects.pockets import contact_pressures, pockets


class TrappedFluid(Term):
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

    symmetric = False

    def __init__(
        self, edges: Sequence[str], fluids: Sequence[FluidPressure], contacts: Sequence[OutlineContact]
    ) -> None:
        super().__init__()
        self.edges, self.fluids, self.contacts = tuple(edges), tuple(fluids), tuple(contacts)
        self._solved, self._begins = False, True

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        body = unknowns.section
        self._body, self._unknowns, self._region = body, unknowns, body.boundary(self.edges)
        self.field = ng.GridFunction(ng.SurfaceL2(body.mesh, order=0))
        line, space = body.outline, self.field.space
        self._unknown = np.array([space.GetDofNrs(ng.ElementId(ng.BND, int(nr)))[0] for nr in line.element])
        inlets = [edge for fluid in self.fluids for edge in fluid.inlet]
        self._wettable = np.isin(line.names, self.edges) & ~np.isin(line.names, inlets)
        self._lengths = body.contour.arc_lengths(*line.t.T)
        self._middles = body.base.at(line.t.ravel()).reshape(-1, 2, 2).mean(axis=1)
        self.left = np.zeros(len(line.names))
        u, v = unknowns.u, unknowns.v
        area = unknowns.kinematics.area_vector(u, ng.Grad(u).Trace())
        form += (self.field * unknowns.kinematics.weight * (area * v)).Compile() * ng.ds(
            definedon=self._region, bonus_intorder=2
        )

    @property
    def pressures(self) -> Array:
        """Pressure q on each mesh edge, in the order of the outline, shape (m,) [MPa]; 0 outside pockets."""
        return self.field.vec.FV().NumPy()[self._unknown]

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
        self._solved, self._begins = True, False

    def refresh(self) -> bool:
        q, carried = np.zeros(len(self._lengths)), 0.0
        wet = self._wet() > 0
        for pocket in pockets(self._body, self._unknowns.state[DISPLACEMENT], self.contacts):
            edges = pocket.edges
            if wet[edges].any() or not self._wettable[edges].all():
                continue
            q[edges] = self.left[edges].max()
            if self.pressures[edges].any() and not self._begins:  # else the contacts do not feel it yet
                q[edges] = np.minimum(q[edges], pocket.holds / (1 - LESS))
            if self._solved:
                self.left[edges] = q[edges]
        if self._solved:
            reached = np.max([fluid.shares for fluid in self.fluids], axis=0) > 0
            closed = contact_pressures(self._body, self.contacts).max(axis=0) > 0
            self.left = np.where(reached, self._wet(), np.where(closed, 0.0, self.left))
        self._solved = False
        for contact in self.contacts:
            carried += float(self._lengths[contact.positions] @ contact.end_pressures().mean(axis=1))
        if self._lengths @ np.abs(q - self.pressures) <= STAYS * carried and not self._begins:
            return False
        self.field.vec.FV().NumPy()[self._unknown] = q
        return True

    def force(self) -> Array:
        """Resultant of the trapped fluid on the part; shape (2,) [N], or N/mm in plane strain."""
        u, kinematics = self._unknowns.state[DISPLACEMENT], self._unknowns.kinematics
        area = kinematics.area_vector(u, ng.Grad(u))
        measure = ng.ds(definedon=self._region, bonus_intorder=2)
        loads = [-self.field * kinematics.weight * area[k] for k in range(2)]
        return np.array([ng.Integrate(load * measure, self._body.mesh) for load in loads])
