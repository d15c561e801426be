"""Fluid that contacts have cut off in pockets of the outline."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ngwear.effects.base import DISPLACEMENT, Array, Term, Unknowns
from ngwear.effects.contact import OutlineContact
from ngwear.effects.fluid_pressure import LESS, STAYS, FluidPressure


class TrappedFluid(Term):
    """Follower traction ``-q n`` in pockets: the fluid that is left there when contacts cut it off.

    A pocket is a piece of the outline without contact, between two contacts with the same surface, that no fluid
    reaches from its inlet. A piece between contacts with two surfaces, such as the air side of a ring, is open to the
    surroundings: the gap between the surfaces is. A pocket takes the highest pressure that its mesh edges had in the
    last equilibrium and keeps it, as far as the contacts on both sides carry it (within ``fluid_pressure.LESS``); what
    they do not carry leaks out. q does not change with the volume of the pocket. A fluid whose pressure falls leaves a
    pocket until the contact before it closes: such a stroke has to be solved in load steps.

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
        self._solved, self._closed = False, np.zeros(0, dtype=bool)

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
        self.left = np.zeros(len(self._lengths))
        if len(places):
            apart, nearest = cKDTree(places[:, :2]).query(self._middles)
            self.left = np.where(apart < self._lengths, places[nearest, 2], 0.0)

    def _wet(self) -> Array:
        """Pressure of the fluids from their inlets on each mesh edge, shape (m,) [MPa]."""
        return np.max([fluid.pressure.Get() * fluid.shares for fluid in self.fluids], axis=0)

    def prepare(self) -> None:
        self._solved = True

    def refresh(self) -> bool:
        q, carried = np.zeros(len(self._lengths)), 0.0
        for pocket, holds in self._pockets():
            q[pocket] = self.left[pocket].max()
            if self.pressures[pocket].any():  # else the contacts do not feel it yet
                q[pocket] = np.minimum(q[pocket], holds / (1 - LESS))
            if self._solved:
                self.left[pocket] = q[pocket]
        if self._solved:
            reached = np.max([fluid.shares for fluid in self.fluids], axis=0) > 0
            self.left = np.where(reached, self._wet(), np.where(self._closed, 0.0, self.left))
        self._solved = False
        for contact in self.contacts:
            carried += float(self._lengths[contact.positions] @ contact.end_pressures().mean(axis=1))
        if self._lengths @ np.abs(q - self.pressures) <= STAYS * carried:
            return False
        self.field.vec.FV().NumPy()[self._unknown] = q
        return True

    def _pockets(self) -> Iterator[tuple[NDArray[np.intp], float]]:
        """The mesh edges of each pocket, and the pressure that the contacts beside it carry [MPa]."""
        m = len(self._lengths)
        pressures = np.zeros((len(self.contacts), m))
        for row, contact in zip(pressures, self.contacts, strict=True):
            profile, touching = contact.profile(), contact.touching()
            highest = profile.pressure[profile.edges].max(axis=1)
            row[contact.positions] = np.where(touching, highest, 0.0)
        wet = self._wet() > 0
        self._closed = closed = pressures.max(axis=0) > 0
        if not closed.any():
            return
        first = int(np.flatnonzero(closed)[0])
        order = (np.arange(m) + first) % m
        for piece in np.split(order, np.flatnonzero(np.diff(closed[order])) + 1):
            before, after = (piece[0] - 1) % m, (piece[-1] + 1) % m
            beside = [row for row in pressures if row[before] > 0 and row[after] > 0]
            if closed[piece[0]] or wet[piece].any() or not self._wettable[piece].all() or not beside:
                continue
            yield piece, max(min(_highest(row, before, -1), _highest(row, after, 1)) for row in beside)

    def force(self) -> Array:
        """Resultant of the trapped fluid on the part; shape (2,) [N], or N/mm in plane strain."""
        u, kinematics = self._unknowns.state[DISPLACEMENT], self._unknowns.kinematics
        area = kinematics.area_vector(u, ng.Grad(u))
        measure = ng.ds(definedon=self._region, bonus_intorder=2)
        loads = [-self.field * kinematics.weight * area[k] for k in range(2)]
        return np.array([ng.Integrate(load * measure, self._body.mesh) for load in loads])


def _highest(pressures: Array, begin: int, step: int) -> float:
    """Highest pressure of the contact that begins at a mesh edge and goes on in one direction [MPa]."""
    onward = np.roll(pressures[::step], -(begin if step == 1 else len(pressures) - 1 - begin))
    return float(onward[: int(np.argmin(onward > 0)) or len(onward)].max())
