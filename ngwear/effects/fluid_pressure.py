"""Fluid pressure that reaches from the sealed side to the first point in contact."""

from __future__ import annotations

from collections.abc import Sequence

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT, Term, Unknowns
from ngwear.effects.contact import Contact
from ngwear.errors import SceneError
from ngwear.geometry.body import Body


class FluidPressure(Term):
    """Follower traction ``-chi p n`` on the wetted part of named edges.

    chi is 1 from the inlet edges, in both directions along the outline, up to the first mesh node in
    contact, falls linearly over the last edge before it, and is 0 beyond. It is fixed in a solve and found
    anew after it, until it stays. If the fluid meets no contact before the named edges end, ``leaks`` is
    True: the seal does not hold.

    Parameters
    ----------
    edges : sequence of str
        Edges that the fluid may reach; they must be one piece of the outline with the inlet among them.
    inlet : sequence of str
        Edges that are always wetted.
    contacts : sequence of Contact
        Contacts that can stop the fluid.

    Raises
    ------
    SceneError
        If the inlet is not among the edges.
    """

    symmetric = False

    def __init__(self, edges: Sequence[str], inlet: Sequence[str], contacts: Sequence[Contact]) -> None:
        super().__init__()
        self.edges, self.inlet, self.contacts = tuple(edges), tuple(inlet), tuple(contacts)
        if not self.inlet or not set(self.inlet) <= set(self.edges):
            raise SceneError("fluid.inlet", list(self.inlet), f"must name some of the fluid's edges {list(self.edges)}")
        self.pressure = ng.Parameter(0.0)
        self.loads = {"fluid pressure [MPa]": self.pressure}
        self.leaks = False

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        body = unknowns.body
        region = body.boundary(self.edges)
        self._body, self._unknowns, self._region = body, unknowns, region
        self.wetted = ng.GridFunction(ng.H1(body.mesh, order=1))
        u, v = unknowns.u, unknowns.v
        area = unknowns.kinematics.area_vector(u, ng.Grad(u).Trace())
        work = self.pressure * self.wetted * unknowns.kinematics.weight * (area * v)
        form += work.Compile() * ng.ds(definedon=region, bonus_intorder=2)
        self._lay_path(body)
        self.refresh()

    def _lay_path(self, body: Body) -> None:
        """Order the reachable nodes outwards from the inlet, once in each direction."""
        line = body.outline
        reach = np.isin(line.names, self.edges)
        inlet = np.isin(line.names, self.inlet)
        m = len(line.names)
        self._inlet_nodes = np.unique(line.vertices[inlet])
        self._paths = []
        for step, end in ((1, 1), (-1, 0)):
            position = int(np.flatnonzero(inlet & ~np.roll(inlet, -step))[0])
            path = [line.vertices[position, end]]
            while reach[(position + step) % m] and len(path) < m:
                position = (position + step) % m
                path.append(line.vertices[position, end])
            self._paths.append(np.array(path, dtype=int))

    def refresh(self) -> bool:
        """Find the front anew; True if it has moved."""
        touching = self._touching_nodes()
        wetted = np.zeros(self._body.mesh.nv)
        wetted[self._inlet_nodes] = 1.0
        self.leaks = False
        for path in self._paths:
            stop = np.flatnonzero(touching[path])
            self.leaks |= len(stop) == 0
            wetted[path[: stop[0]] if len(stop) else path] = 1.0
        old = self.wetted.vec.FV().NumPy()
        moved = bool(np.any(old != wetted))
        old[:] = wetted
        return moved and self.pressure.Get() != 0.0

    def _touching_nodes(self) -> np.ndarray:
        """Which mesh nodes end an edge that carries contact pressure."""
        touching = np.zeros(self._body.mesh.nv, dtype=bool)
        line = self._body.outline
        for contact in self.contacts:
            ends = contact.touching()
            touching[line.vertices[contact.positions[ends]]] = True
        return touching

    def force(self) -> np.ndarray:
        """Resultant of the fluid on the part; shape (2,) [N], or N/mm in plane strain."""
        u, kinematics = self._unknowns.state[DISPLACEMENT], self._unknowns.kinematics
        area = kinematics.area_vector(u, ng.Grad(u))
        scale = -self.pressure.Get() * self.wetted * kinematics.weight
        measure = ng.ds(definedon=self._region, bonus_intorder=2)
        return np.array([ng.Integrate(scale * area[k] * measure, self._body.mesh) for k in range(2)])
