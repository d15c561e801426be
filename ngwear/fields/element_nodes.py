"""The nodes of a section's elements: corners, edge midpoints and centres of quadrilaterals, shared between elements."""

from __future__ import annotations

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.fields.element_shapes import TYPES

Array = NDArray[np.float64]
Index = NDArray[np.int64]
CORNERS = {3: [(1.0, 0.0), (0.0, 1.0), (0.0, 0.0)], 4: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]}


class ElementNodes:
    """Nodes of order 2 of the elements of a mesh in the plane; vertices come first, by the mesh's numbers.

    Parameters
    ----------
    mesh : ng.Mesh

    Attributes
    ----------
    triangles : array of int, shape (nt, 6)
        Corners of each, then the midpoint of the edge that begins at each corner.
    quadrilaterals : array of int, shape (nq, 9)
        Likewise, then the centre.
    count : int
        Number of nodes.
    """

    def __init__(self, mesh: ng.Mesh) -> None:
        elements = list(mesh.Elements(ng.VOL))
        corners = {n: [[v.nr for v in e.vertices] for e in elements if len(e.vertices) == n] for n in (3, 4)}
        of = {n: np.array(rows, dtype=np.int64).reshape(-1, n) for n, rows in corners.items()}
        sides = np.concatenate([np.stack([c, np.roll(c, -1, axis=1)], axis=-1).reshape(-1, 2) for c in of.values()])
        self._edges, number = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
        self._vertices = mesh.nv
        middles = mesh.nv + number.ravel()
        first, centre = 3 * len(of[3]), mesh.nv + len(self._edges)
        self.triangles = np.hstack([of[3], middles[:first].reshape(-1, 3)])
        centres = np.arange(centre, centre + len(of[4]))
        self.quadrilaterals = np.hstack([of[4], middles[first:].reshape(-1, 4), centres[:, None]])
        self.count = centre + len(centres)
        self._lay_points(mesh, [len(e.vertices) for e in elements])

    def _lay_points(self, mesh: ng.Mesh, kinds: list[int]) -> None:
        """Points of the elements, one after the other, at their nodes."""
        rules = {}
        for n in set(kinds):
            at = np.array(CORNERS[n])
            at = np.vstack([at, 0.5 * (at + np.roll(at, -1, axis=0)), *([at.mean(axis=0)] if n == 4 else [])])
            rules[TYPES[2][n]] = ng.IntegrationRule([tuple(p) for p in at.tolist()], [1.0] * len(at))
        self._points = mesh.MapToAllElements(rules, ng.VOL)
        rows = {3: iter(self.triangles), 4: iter(self.quadrilaterals)}
        self._nodes = np.concatenate([next(rows[n]) for n in kinds])

    def middle(self, ends: Index) -> Index:
        """The node between the two vertices of each mesh edge, shape (m, 2)."""
        keys, asked = (np.sort(pairs, axis=1) @ [self._vertices, 1] for pairs in (self._edges, ends))
        return self._vertices + np.searchsorted(keys, asked)

    def values(self, field: ng.CoefficientFunction) -> Array:
        """Values at the nodes of a field that is continuous, shape (count, k)."""
        found = np.asarray(field(self._points)).reshape(len(self._nodes), -1)
        out = np.empty((self.count, found.shape[1]))
        out[self._nodes] = found
        return out
