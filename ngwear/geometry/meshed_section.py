"""A meshed section: its outline, and where the mesh's boundary lies on it."""

from __future__ import annotations

import abc
from dataclasses import dataclass
from typing import TYPE_CHECKING

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.geometry.meshed import Meshed
from ngwear.geometry.outline import Array, Outline

if TYPE_CHECKING:  # only sections that lose elements have cells
    from ngwear.geometry.cells import Cells


@dataclass(frozen=True)
class BoundaryEdges:
    """The mesh's boundary edges in the order of the outline (counter-clockwise).

    Attributes
    ----------
    element : array of int, shape (m,)
        Boundary element numbers.
    vertices : array of int, shape (m, 2)
        Mesh vertices at start and end.
    edge : array of int, shape (m,)
        Mesh edge numbers.
    t : array, shape (m, 2)
        Outline parameters at start and end; the last one ends at n, the outline's number of points.
    names : array of str, shape (m,)
    """

    element: NDArray[np.intp]
    vertices: NDArray[np.intp]
    edge: NDArray[np.intp]
    t: Array
    names: NDArray[np.str_]

    def on(self, edges: tuple[str, ...]) -> NDArray[np.intp]:
        """Return the positions of the boundary edges that carry one of the names."""
        return np.flatnonzero(np.isin(self.names, edges))


class MeshedSection(Meshed):
    """A section and its mesh, which follows the outline as it moves.

    Attributes
    ----------
    base, contour : Outline
        The outline that was meshed, and the present one: the same points, displaced.
    outline : BoundaryEdges
    """

    base: Outline
    contour: Outline
    outline: BoundaryEdges
    deformation: ng.GridFunction

    @property
    def size(self) -> float:
        return float(np.ptp(self.contour.points, axis=0).max())

    @abc.abstractmethod
    def move_to(self, contour: Outline) -> None:
        """Move the mesh to an outline that has the points of ``base``, displaced.

        Raises
        ------
        MeshError
            If an element would be inverted or too distorted; the body then stays as it was.
        """

    @property
    def now(self) -> Cells | None:
        """The elements at their present places, if the section can lose elements; else None."""
        return None
