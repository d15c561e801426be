"""Locate points in a mesh again after small moves of its outline, without a full search."""

from __future__ import annotations

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.fields.transfer import nearest_places

Array = NDArray[np.float64]

# Corners and middles of the edges opposite to them, on the reference triangle.
NODES = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [0.0, 0.5], [0.5, 0.0], [0.5, 0.5]])
OUTSIDE = 1e-6  # of an element's height: beyond, a point lies outside of it; above the error of ``_inverted``
MOST_MOVES = 12  # from element to element: an outline moves by one or so on a mesh; points outside go to and fro


class Locator:
    """Places of points in a mesh: element and coordinates there.

    A mesh of curved triangles of order 2 under a deformation of order 2 is, in each element, the quadratic image
    of the reference triangle. A point is found by Newton's method in the element where it was, else by walking over
    the edges towards it.

    Parameters
    ----------
    mesh : ng.Mesh
    points : array, shape (n, 2)
        Where the points lie before the mesh is deformed [mm].

    Attributes
    ----------
    mapped : structured array, shape (n,)
        Points as fields of the mesh take them; one outside the section is put on its edge.
    inside : array of bool, shape (n,)
    """

    def __init__(self, mesh: ng.Mesh, points: Array) -> None:
        self.mesh = mesh
        self._rule = ng.IntegrationRule(points=[tuple(p) for p in NODES], weights=[0.0] * len(NODES))
        self._nodes = mesh.MapToAllElements(self._rule, ng.VOL)
        self._neighbours = _neighbours(mesh)
        active = mesh.deformation
        mesh.UnsetDeformation()
        self._first = nearest_places(mesh, points)
        if active is not None:
            mesh.SetDeformation(active)
        self.follow(points)

    def follow(self, points: Array) -> None:
        """Find the points in the present section; each starts from where it was first, whatever came between."""
        nodes = np.stack([np.asarray(c(self._nodes)) for c in (ng.x, ng.y)], axis=-1).reshape(-1, len(NODES), 2)
        maps = _polynomials(nodes)
        element = self._first["nr"].astype(np.int64)
        place = np.stack([self._first["x"], self._first["y"]], axis=1)
        still = np.arange(len(points))
        for moves in range(MOST_MOVES + 1):
            place[still] = _inverted(maps[..., element[still]], points[still], place[still])
            beyond = _barycentric(place[still])
            beyond[self._neighbours[element[still]] < 0] = 0.0
            side = beyond.argmin(axis=1)
            leaves = beyond[np.arange(len(still)), side] < -OUTSIDE
            if moves == MOST_MOVES or not leaves.any():  # a point outside may go to and fro between two elements
                break
            still, side = still[leaves], side[leaves]
            element[still] = self._neighbours[element[still], side]
            place[still] = 1 / 3
        corners = _barycentric(place)
        self.inside = corners.min(axis=1) >= -OUTSIDE
        corners = np.maximum(corners, 0.0)
        corners /= corners.sum(axis=1, keepdims=True)
        self.mapped = self._first.copy()
        self.mapped["nr"], self.mapped["x"], self.mapped["y"] = element, corners[:, 0], corners[:, 1]


def _barycentric(place: Array) -> Array:
    return np.column_stack([place, 1 - place.sum(axis=1)])


def _polynomials(nodes: Array) -> Array:
    """Coefficients of 1, x, y, xx, xy and yy in each element's map, shape (6, 2, elements), from its nodes."""
    a, b, c, bc, ac, ab = nodes.transpose(1, 2, 0)
    xx, xy, yy = 2 * (a + c - 2 * ac), 4 * (c + ab - ac - bc), 2 * (b + c - 2 * bc)
    return np.stack([c, a - c - xx, b - c - yy, xx, xy, yy])


def _inverted(maps: Array, points: Array, place: Array) -> Array:
    """Reference coordinates at which maps, shape (6, 2, n), take the points, shape (n, 2), by Newton's method."""
    place, still = place.copy(), np.arange(len(points))
    aim, (x, y) = points.T, place.T
    for _ in range(10):
        one, gx, gy, xx, xy, yy = maps
        off = one + (gx + xx * x + xy * y) * x + (gy + yy * y) * y - aim
        along, across = gx + 2 * xx * x + xy * y, gy + 2 * yy * y + xy * x
        det = along[0] * across[1] - along[1] * across[0]
        step = np.stack([off[0] * across[1] - off[1] * across[0], along[0] * off[1] - along[1] * off[0]]) / det
        found = np.clip(np.stack([x, y]) - step, -3.0, 4.0)  # far outside the map may not be unique
        place[still] = found.T
        left = np.abs(step).max(axis=0) > 1e-10
        if not left.any():
            return place
        still, maps, aim, (x, y) = still[left], maps[..., left], aim[:, left], found[:, left]
    # Beyond the fold of a curved element there is no solution: the plane through its corners shows the way.
    corner, gx, gy, xx, _, yy = maps
    sides = np.stack([gx + xx, gy + yy], axis=1).T
    place[still] = np.linalg.solve(sides.transpose(0, 2, 1), (aim - corner).T[..., None])[..., 0]
    return place


def _neighbours(mesh: ng.Mesh) -> NDArray[np.int64]:
    """Element across the edge opposite to each corner, shape (elements, 3); -1 at the outline."""
    corners = mesh.ngmesh.Elements2D().NumPy()["nodes"][:, :3].astype(np.int64)
    edges = np.sort(np.stack([corners[:, [1, 2]], corners[:, [2, 0]], corners[:, [0, 1]]], axis=1), axis=2).reshape(
        -1, 2
    )
    order = np.lexsort(edges.T)
    same = np.flatnonzero((edges[order[1:]] == edges[order[:-1]]).all(axis=1))
    found = np.full(len(edges), -1)
    first, second = order[same], order[same + 1]
    found[first], found[second] = second // 3, first // 3
    return found.reshape(-1, 3)
