"""Nodal values of H1 fields of order 1 and 2, whose own edge unknowns are hierarchical.

The nodes are the vertices, the edge midpoints and the centres of quadrilaterals, if there are any; the unknowns have
the same order. So a displacement that is biquadratic in each quadrilateral, or quadratic in each triangle, is set
exactly by ``join`` of its values at the ``places``.
"""

from __future__ import annotations

from functools import lru_cache

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NO_QUADS = np.empty((0, 8), dtype=np.intp)


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


def quad_nodes(mesh: ng.Mesh) -> NDArray[np.intp]:
    """Nodes at the corners (four) and edges (four) of each quadrilateral, in the order of the centres; shape (k, 8)."""
    space = ng.H1(mesh, order=2)
    if mesh.dim != 2 or space.ndof == mesh.nv + mesh.nedge:
        return NO_QUADS
    unknowns = [space.GetDofNrs(ng.ElementId(ng.VOL, i)) for i in range(mesh.ne)]
    quads = np.array([numbers for numbers in unknowns if len(numbers) == 9])
    return quads[np.argsort(quads[:, 8]), :8]


def places(mesh: ng.Mesh, edges: NDArray[np.intp], quads: NDArray[np.intp] = NO_QUADS) -> Array:
    """Coordinates of the nodes of a mesh with straight edges that is not deformed [mm], shape (n, dim)."""
    vertices = np.array(mesh.ngmesh.Coordinates())[:, : mesh.dim]
    return np.concatenate([vertices, vertices[edges].mean(axis=1), vertices[quads[:, :4]].mean(axis=1)])


def split(values: Array, edges: NDArray[np.intp], quads: NDArray[np.intp] = NO_QUADS) -> Array:
    """Return nodal values of hierarchical unknowns, shape (nv + nedge + nquad,)."""
    nv, n = len(values) - len(edges) - len(quads), len(values) - len(quads)
    middle = values[edges].mean(axis=1) + _bubble() * values[nv:n]
    nodal = np.concatenate([values[:nv], middle])
    return np.concatenate([nodal, _centres(nodal, quads) + _inner_bubble() * values[n:]]) if len(quads) else nodal


def join(nodal: Array, edges: NDArray[np.intp], quads: NDArray[np.intp] = NO_QUADS) -> Array:
    """Return hierarchical unknowns of nodal values: the inverse of ``split``."""
    nv, n = len(nodal) - len(edges) - len(quads), len(nodal) - len(quads)
    values = np.concatenate([nodal[:nv], (nodal[nv:n] - nodal[edges].mean(axis=1)) / _bubble()])
    return np.concatenate([values, (nodal[n:] - _centres(nodal, quads)) / _inner_bubble()]) if len(quads) else values


def _centres(nodal: Array, quads: NDArray[np.intp]) -> Array:
    """Value at a quadrilateral's centre from its corners and edges alone."""
    return nodal[quads[:, 4:]].sum(axis=1) / 2 - nodal[quads[:, :4]].sum(axis=1) / 4


@lru_cache(maxsize=1)
def _inner_bubble() -> float:
    """Value of the order-2 function of a quadrilateral's inside at its centre."""
    return float(ng.fem.H1FE(ng.QUAD, 2).CalcShape(0.5, 0.5)[8])
