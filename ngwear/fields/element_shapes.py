"""The elements of a mesh, of one type or of several, as arrays of one shape: integration points, shape functions.

Where types are mixed, an element with fewer points or unknowns than another is filled up to its number: by its first
point again, of weight 0, and by its first unknown again, with a shape function of 0. Then the same arrays hold for all
types; a triangle then costs as much as a quadrilateral.
"""

from __future__ import annotations

from collections.abc import Sequence

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.errors import MeshError

Array = NDArray[np.float64]
Index = NDArray[np.int64]
TYPES = {2: {3: ng.TRIG, 4: ng.QUAD}, 3: {4: ng.TET}}  # by dimension and number of corners


class Cells:
    """Integration points of a mesh's elements; ``shapes`` gives the functions of a space there.

    Parameters
    ----------
    mesh : ng.Mesh
    order : int
        Of the integration rules.

    Attributes
    ----------
    points : array, shape (elements * points,)
        Mapped points, in the order of the elements.
    weights : array, shape (elements, points)
        On the reference element; 0 for a point that fills up.
    real : array of bool, shape (elements, points)
        Whether a point counts.
    quads : array of bool, shape (elements,)
        Whether an element is a quadrilateral.
    kinds : list of arrays of int
        Numbers of the elements that share their shape functions, kind by kind.

    Raises
    ------
    MeshError
        For an element that is no triangle, quadrilateral or tetrahedron.
    """

    def __init__(self, mesh: ng.Mesh, order: int) -> None:
        self.mesh = mesh
        self._elements = [ng.ElementId(ng.VOL, i) for i in range(mesh.ne)]
        vertices = [[v.nr for v in mesh[element].vertices] for element in self._elements]
        corners = [len(v) for v in vertices]
        known = TYPES[mesh.dim]
        if not set(corners) <= set(known):
            raise MeshError(f"the mesh has elements of {sorted(set(corners) - set(known))} corners")
        # Shape functions depend on an element's type and on the order of its vertex numbers only.
        ranks = np.argsort(_filled(vertices, mesh.nv), axis=1).tolist()
        self._kinds = [(n, *rank) for n, rank in zip(corners, ranks, strict=True)]
        members: dict[tuple[int, ...], list[int]] = {}
        for i, kind in enumerate(self._kinds):
            members.setdefault(kind, []).append(i)
        self._examples = {kind: elements[0] for kind, elements in members.items()}
        self.kinds = [np.array(elements) for elements in members.values()]
        rules = {n: ng.IntegrationRule(known[n], order) for n in sorted(set(corners))}
        sizes = {n: len(rule.points) for n, rule in rules.items()}
        most = max(sizes.values())
        takes = {n: np.where(np.arange(most) < size, np.arange(most), 0) for n, size in sizes.items()}
        self._places = {n: np.array(rule.points)[takes[n], : mesh.dim] for n, rule in rules.items()}
        weights = {n: np.pad(rule.weights, (0, most - sizes[n])) for n, rule in rules.items()}
        self.points = mesh.MapToAllElements({known[n]: rule for n, rule in rules.items()}, ng.VOL)
        if len(rules) > 1:
            start = np.cumsum([0] + [sizes[n] for n in corners[:-1]])
            self.points = self.points[(start[:, None] + [takes[n] for n in corners]).ravel()]
        self.weights = np.array([weights[n] for n in corners])
        self.real = self.weights != 0
        self.quads = (np.array(corners) == 4) & (mesh.dim == 2)

    def shapes(self, space: ng.FESpace) -> tuple[Index, Array, Array]:
        """Unknowns of each element in a scalar H1 space, and its shape functions and their slopes at the points.

        Shapes (elements, n), (elements, points, n) and (elements, points, n, dim), on the reference element.
        """
        unknowns = _filled([space.GetDofNrs(element) for element in self._elements])
        most = unknowns.shape[1]
        values, slopes = {}, {}
        for kind, i in self._examples.items():
            element, places = space.GetFE(self._elements[i]), self._places[kind[0]]
            missing = (0, most - element.ndof)
            shapes = [element.CalcShape(*p) for p in places]
            changes = [np.array(element.CalcDShape(*p)) for p in places]
            values[kind] = np.pad(shapes, ((0, 0), missing))
            slopes[kind] = np.pad(changes, ((0, 0), missing, (0, 0)))
        return unknowns, np.array([values[k] for k in self._kinds]), np.array([slopes[k] for k in self._kinds])


def _filled(rows: Sequence[Sequence[int]], by: int | None = None) -> Index:
    """Rows of numbers, each filled up to the longest by a number or by its own first."""
    lengths = set(map(len, rows))
    if len(lengths) > 1:
        rows = [(*row, *[row[0] if by is None else by] * (max(lengths) - len(row))) for row in rows]
    return np.array(rows, dtype=np.int64)
