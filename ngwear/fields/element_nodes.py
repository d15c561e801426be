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
        vertices = mesh.ngmesh.Elements2D().NumPy()["nodes"].astype(np.int64) - 1
        quads = vertices[:, 3] >= 0 if vertices.shape[1] > 3 else np.zeros(len(vertices), dtype=bool)
        corners = vertices[~quads, :3], vertices[quads, :4].reshape(-1, 4)
        sides = [np.stack([c, np.roll(c, -1, axis=1)], axis=-1).reshape(-1, 2) for c in corners]
        self._vertices = mesh.nv
        self._edges, number = np.unique(self._keys(np.concatenate(sides)), return_inverse=True)
        middles, centre = mesh.nv + number, mesh.nv + len(self._edges)
        centres = np.arange(centre, centre + len(corners[1]))
        self.triangles = np.hstack([corners[0], middles[: 3 * len(corners[0])].reshape(-1, 3)])
        self.quadrilaterals = np.hstack([corners[1], middles[3 * len(corners[0]) :].reshape(-1, 4), centres[:, None]])
        self.count = centre + len(centres)
        self._place_points(mesh, quads)

    def _place_points(self, mesh: ng.Mesh, quads: NDArray[np.bool_]) -> None:
        """Points of the elements, one after the other, at their nodes."""
        rules = {}
        for n in {4 if quad else 3 for quad in quads.tolist()}:
            at = np.array(CORNERS[n])
            at = np.vstack([at, 0.5 * (at + np.roll(at, -1, axis=0)), *([at.mean(axis=0)] if n == 4 else [])])
            rules[TYPES[2][n]] = ng.IntegrationRule([tuple(p) for p in at.tolist()], [1.0] * len(at))
        self._points = mesh.MapToAllElements(rules, ng.VOL)
        nodes = np.full((len(quads), 9), -1)
        nodes[~quads, :6], nodes[quads] = self.triangles, self.quadrilaterals
        self._nodes = nodes[nodes >= 0]

    def _keys(self, ends: Index) -> Index:
        """One number for each pair of vertices, shape (m,)."""
        return ends.min(axis=1) * self._vertices + ends.max(axis=1)

    def middle(self, ends: Index) -> Index:
        """The node between the two vertices of each mesh edge, shape (m, 2)."""
        return self._vertices + np.searchsorted(self._edges, self._keys(ends))

    def values(self, field: ng.CoefficientFunction) -> Array:
        """Values at the nodes of a field that is continuous, shape (count, k)."""
        found = np.asarray(field(self._points)).reshape(len(self._nodes), -1)
        out = np.empty((self.count, found.shape[1]))
        out[self._nodes] = found
        return out
