"""Base class of meshed parts, sections and solids."""

from __future__ import annotations

import abc
from collections.abc import Sequence
from functools import cached_property

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.errors import MeshError
from ngwear.geometry import nodal


class Meshed(abc.ABC):
    """A part and its mesh.

    Attributes
    ----------
    mesh : ng.Mesh
    deformation : ng.GridFunction or None
        Displacement of the mesh since it was made [mm].
    moves : int
        How often it has been moved.
    """

    mesh: ng.Mesh
    deformation: ng.GridFunction | None = None
    moves: int = 0

    @property
    @abc.abstractmethod
    def size(self) -> float:
        """Largest extent [mm]."""

    @cached_property
    def edges(self) -> NDArray[np.intp]:
        """Vertices of each mesh edge, shape (m, 2)."""
        return nodal.edge_vertices(self.mesh)

    @cached_property
    def quads(self) -> NDArray[np.intp]:
        """Nodes of each quadrilateral, shape (k, 8): see ``nodal.quad_nodes``."""
        return nodal.quad_nodes(self.mesh)

    def node_places(self) -> NDArray[np.float64]:
        """Coordinates of the nodes of a mesh with straight edges [mm]: see ``nodal.places``."""
        return nodal.places(self.mesh, self.edges, self.quads)

    def set_nodal(self, field: ng.GridFunction, values: NDArray[np.float64]) -> None:
        """Give a ``VectorH1`` field of order 2 its values at the nodes, shape (n, dim)."""
        for component, part in zip(field.components, values.T, strict=True):
            component.vec.FV().NumPy()[:] = nodal.join(part, self.edges, self.quads)

    @cached_property
    def region_names(self) -> tuple[str, ...]:
        """Names of the pieces of the surface that the mesh knows."""
        return tuple(self.mesh.GetBoundaries())

    def boundary(self, edges: Sequence[str]) -> ng.Region:
        """Return the region of the named pieces; MeshError names one that the mesh does not have."""
        missing = [name for name in edges if name not in self.region_names]
        if missing:
            raise MeshError(f"the mesh has no edges {missing}; it has {sorted(set(self.region_names))}")
        return self.mesh.Boundaries("|".join(edges))
