"""Nodal values of H1 fields of order 1 and 2, whose own edge unknowns are hierarchical."""

from __future__ import annotations

from functools import lru_cache

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@lru_cache(maxsize=1)
def _bubble() -> float:
    """Value of the order-2 edge function at its edge's midpoint."""
    from netgen.geom2d import unit_square

    mesh = ng.Mesh(unit_square.GenerateMesh(maxh=1))
    space = ng.H1(mesh, order=2)
    edge = next(iter(mesh.edges))
    field = ng.GridFunction(space)
    field.vec[space.GetDofNrs(edge)[0]] = 1.0
    x, y = np.mean([mesh[v].point for v in edge.vertices], axis=0)
    return float(field(mesh(x, y)))


def edge_vertices(mesh: ng.Mesh) -> NDArray[np.intp]:
    """Vertices of each mesh edge, shape (nedge, 2)."""
    return np.array([[v.nr for v in edge.vertices] for edge in mesh.edges])


def split(values: Array, edges: NDArray[np.intp]) -> Array:
    """Return nodal values (vertices, then edge midpoints) of hierarchical unknowns, shape (nv + nedge,)."""
    nv = len(values) - len(edges)
    middle = values[edges].mean(axis=1) + _bubble() * values[nv:]
    return np.concatenate([values[:nv], middle])


def join(nodal: Array, edges: NDArray[np.intp]) -> Array:
    """Return hierarchical unknowns of nodal values: the inverse of ``split``."""
    nv = len(nodal) - len(edges)
    return np.concatenate([nodal[:nv], (nodal[nv:] - nodal[edges].mean(axis=1)) / _bubble()])
