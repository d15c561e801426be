"""Finite element spaces of displacements of order 1, 2 or 3, and the order of the volumetric stress."""

from __future__ import annotations

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
BUBBLE = 3  # order of the function that vanishes on the edges of a triangle


def displacements(mesh: ng.Mesh, order: int, **held: str) -> ng.FESpace:
    """Space of displacements.

    Those of order 1 have a bubble in each triangle: without it a continuous volumetric stress of order 1 oscillates
    (MINI element of Arnold, Brezzi & Fortin, Calcolo 21 (1984) 337). It is for sections of triangles only.

    Parameters
    ----------
    mesh : ng.Mesh
    order : int
    held : str
        Boundaries where a component is prescribed, such as ``dirichletx="bottom"``.
    """
    space = ng.VectorH1(mesh, order=order, **held)
    if order == 1:
        space.SetOrder(ng.TRIG, BUBBLE)
        space.Update()
        space.FinalizeUpdate()
    return space


def at_vertices(space: ng.FESpace, vertices: NDArray[np.intp]) -> NDArray[np.intp]:
    """Unknowns of each component at mesh vertices: those of order 1, which come first; shape (dim, *vertices.shape)."""
    first = np.cumsum([0, *(part.ndof for part in space.components[:-1])])
    return first.reshape(-1, *(1 for _ in vertices.shape)) + vertices


def stress_order(order: int) -> int:
    """Order of the volumetric stress that is stable with displacements of an order: one less, but 1 with bubbles."""
    return max(order - 1, 1)


def from_quadratic(values: Array, space: ng.FESpace, edges: NDArray[np.intp]) -> Array:
    """Unknowns of a scalar H1 field on simplices from those of order 2; for order 1 the quadratic part is dropped.

    A field of order k has k - 1 unknowns for each of the mesh's edges, the first of which is that of order 2; the
    others become 0.
    """
    found, nv, each = np.zeros(space.ndof), len(values) - len(edges), space.globalorder - 1
    found[:nv] = values[:nv]
    if each > 0:
        found[nv : nv + each * len(edges) : each] = values[nv:]
    return found
