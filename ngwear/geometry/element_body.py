"""A body whose elements can be lost; its surface nodes move with the wear, inner nodes stay."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import netgen.meshing as ngm
import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.errors import MeshError
from ngwear.geometry.cells import HOLE, Cells
from ngwear.geometry.meshed import Meshed
from ngwear.geometry.meshed_section import BoundaryEdges, MeshedSection
from ngwear.geometry.outline import Outline

Index = NDArray[np.intp]
FLATTEST = 1e-3  # of an element's corner as it was made: below, a corner counts as folded; a filter acts before


class ElementBody(MeshedSection):
    """The remaining section, meshed with its remaining elements only: lost ones have no unknowns and no energy.

    The displacement of the outline since the mesh was made is the mesh's deformation;
    it ends at the first row of nodes inside.

    Parameters
    ----------
    cells : Cells

    Attributes
    ----------
    base, contour : Outline
        The outline that was meshed, and the present one: closed polygons of element edges.
    outline : BoundaryEdges
    vertices : array of int, shape (nv,)
        Point of ``cells`` at each mesh vertex.
    numbers : array of int, shape (ne,)
        Element of ``cells`` that each mesh element is: quadrilaterals come first.
    """

    def __init__(self, cells: Cells) -> None:
        self.cells = cells
        self.base = self.contour = cells.contour
        self._set_up()

    def _set_up(self) -> None:
        self.mesh, self.vertices, self.numbers = _mesh(self.cells)
        self.outline = self._outline()
        self.deformation = ng.GridFunction(ng.VectorH1(self.mesh, order=1))

    def to_data(self) -> dict[str, Any]:
        """Data from which ``from_data`` restores the body exactly."""
        return {"cells": self.cells, "base": self.base, "contour": self.contour}

    @classmethod
    def from_data(cls, data: dict[str, Any]) -> ElementBody:
        """Restore the body."""
        body = cls.__new__(cls)
        body.cells, body.base, body.contour = (data[name] for name in ("cells", "base", "contour"))
        body._set_up()
        body._deform()
        return body

    @property
    def now(self) -> Cells:
        return self.cells.moved(self.contour.points)

    def boundary(self, edges: Sequence[str]) -> ng.Region:
        """As in ``Meshed``; edges whose elements are all lost are left out."""
        left = tuple(name for name in edges if name in self.region_names)
        if not left:
            raise MeshError(f"nothing of the edges {list(edges)} is left: all of their elements are lost")
        return super().boundary(left)

    def move_to(self, contour: Outline) -> None:
        """Move the surface nodes to an outline that has the points of ``base``, displaced.

        Raises
        ------
        MeshError
            If an element would turn inside out; the body is left as it was.
        """
        moved = self.cells.moved(contour.points)
        least = (moved.least_jacobians() / moved.made)[moved.living]
        if not least.min() > FLATTEST:
            raise MeshError(f"moving the nodes with the outline would shrink an element to {least.min():.2g} of itself")
        self.contour = contour
        self.moves += 1
        self._deform()

    def _deform(self) -> None:
        shift = self.contour.points - self.base.points
        if not shift.any():
            self.mesh.UnsetDeformation()
            return
        where = self.outline.vertices[:, 0]
        for component in range(2):
            self.deformation.components[component].vec.FV().NumPy()[where] = shift[:, component]
        self.mesh.SetDeformation(self.deformation)

    def _outline(self) -> BoundaryEdges:
        """The boundary elements in the order of the outline, whose points are the mesh's vertices."""
        n = len(self.base)
        vertex = {point: k for k, point in enumerate(self.vertices.tolist())}
        ends = np.array([vertex[point] for point in self.cells.rim.tolist()])
        vertices = np.stack([ends, np.roll(ends, -1)], axis=1)
        element = {tuple(sorted(v.nr for v in e.vertices)): (e.nr, e.edges[0].nr) for e in self.mesh.Elements(ng.BND)}
        found = np.array([element[tuple(sorted(pair))] for pair in vertices.tolist()])
        t = np.stack([np.arange(n), np.arange(1, n + 1)], axis=1).astype(float)
        return BoundaryEdges(found[:, 0], vertices, found[:, 1], t, np.array(self.base.names))


def elements(body: Meshed) -> ElementBody:
    """The body as one whose elements can be lost; MeshError for one of another kind."""
    if not isinstance(body, ElementBody):
        raise MeshError(f"the elements of a {type(body).__name__} cannot be lost")
    return body


def _mesh(cells: Cells) -> tuple[ng.Mesh, Index, Index]:
    """Mesh of the living elements, the point at each of its vertices, and which element each of its elements is."""
    living, quads = cells.living, cells.quads
    kept = cells.corners[living]
    used = np.unique(kept[kept >= 0])
    number = np.full(len(cells.points), -1, dtype=np.int32)
    number[used] = np.arange(len(used))
    mesh = ngm.Mesh(2)
    mesh.AddPoints(np.column_stack([cells.points[used], np.zeros(len(used))]))
    mesh.Add(ngm.FaceDescriptor(surfnr=1, domin=1, domout=0, bc=1))
    mesh.SetMaterial(1, "rubber")
    kinds = [(np.flatnonzero(living & quads), 4), (np.flatnonzero(living & ~quads), 3)]
    for which, count in kinds:
        if len(which):
            mesh.AddElements(dim=2, index=1, data=number[cells.corners[which, :count]], base=0)
    sides = np.stack([cells.rim, np.roll(cells.rim, -1)], axis=1)
    names = np.array(cells.names)
    holes = cells.holes()
    pieces = [(name, sides[names == name]) for name in dict.fromkeys(cells.names)]
    pieces += [(HOLE, holes)] if len(holes) else []
    for k, (name, piece) in enumerate(pieces):
        mesh.AddElements(dim=1, index=k + 1, data=number[piece], base=0)
        mesh.SetBCName(k, name)
    return ng.Mesh(mesh), used, np.concatenate([which for which, _ in kinds])
