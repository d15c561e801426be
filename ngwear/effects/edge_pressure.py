"""Pressure of a fluid on the mesh edges of an outline."""

from __future__ import annotations

import abc
from collections.abc import Sequence
from typing import Any

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT, Array, Term, Unknowns


class EdgePressure(Term):
    """Follower traction ``-p n`` on named edges, with a field that is constant on each mesh edge.

    Parameters
    ----------
    edges : sequence of str

    Attributes
    ----------
    field : ng.GridFunction
        Once it has been added to a form, as are the next one.
    names : array of str, shape (m,)
        Of the mesh edges, in the order of the outline.
    """

    symmetric = False

    def __init__(self, edges: Sequence[str]) -> None:
        super().__init__()
        self.edges = tuple(edges)

    @abc.abstractmethod
    def nominal(self) -> Any:
        """The pressure p [MPa], as a function of ``field``."""

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        body, line = unknowns.section, unknowns.section.outline
        self._body, self._unknowns, self._region = body, unknowns, body.boundary(self.edges)
        self.field = ng.GridFunction(ng.SurfaceL2(body.mesh, order=0))
        space = self.field.space
        self._unknown = np.array([space.GetDofNrs(ng.ElementId(ng.BND, int(nr)))[0] for nr in line.element])
        self.names, self._lengths = line.names, body.contour.arc_lengths(*line.t.T)
        self._middles = body.base.at(line.t.ravel()).reshape(-1, 2, 2).mean(axis=1)
        u, v = unknowns.u, unknowns.v
        area = unknowns.kinematics.area_vector(u, ng.Grad(u).Trace())
        work = self.nominal() * unknowns.kinematics.weight * (area * v)
        form += work.Compile() * ng.ds(definedon=self._region, bonus_intorder=2)

    @property
    def on_edges(self) -> Array:
        """Values of ``field`` on the mesh edges, in the order of the outline, shape (m,)."""
        values: Array = self.field.vec.FV().NumPy()[self._unknown]
        return values

    @on_edges.setter
    def on_edges(self, values: Array) -> None:
        self.field.vec.FV().NumPy()[self._unknown] = values

    def force(self) -> Array:
        """Resultant on the part; shape (2,) [N], or N/mm in plane strain."""
        u, kinematics = self._unknowns.state[DISPLACEMENT], self._unknowns.kinematics
        area = kinematics.area_vector(u, ng.Grad(u))
        scale = -self.nominal() * kinematics.weight
        measure = ng.ds(definedon=self._region, bonus_intorder=2)
        return np.array([ng.Integrate(scale * area[k] * measure, self._body.mesh) for k in range(2)])
