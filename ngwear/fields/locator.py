"""Follow points through a mesh whose outline moves a little, without searching all of it again."""

from __future__ import annotations

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.fields.transfer import nearest_places

Array = NDArray[np.float64]

# Corners and middles of the edges opposite to them, on the reference triangle.
NODES = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [0.0, 0.5], [0.5, 0.0], [0.5, 0.5]])
OUTSIDE = 1e-6  # of an element's height: beyond, a point lies outside of it
MOST_MOVES = 12  # from element to element


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
        shape = np.stack([np.asarray(c(self._nodes)) for c in (ng.x, ng.y)], axis=-1).reshape(-1, len(NODES), 2)
        element = self._first["nr"].astype(np.int64)
        place = np.stack([self._first["x"], self._first["y"]], axis=1)
        todo = np.arange(len(points))
        for moves in range(MOST_MOVES + 1):
            place[todo] = _inverted(shape[element[todo]], points[todo], place[todo])
            beyond = _barycentric(place[todo])
            beyond[self._neighbours[element[todo]] < 0] = 0.0
            side = beyond.argmin(axis=1)
            leaves = beyond[np.arange(len(todo)), side] < -OUTSIDE
            if moves == MOST_MOVES or not leaves.any():  # a point outside may go to and fro between two elements
                break
            todo, side = todo[leaves], side[leaves]
            element[todo] = self._neighbours[element[todo], side]
            place[todo] = 1 / 3
        corners = _barycentric(place)
        self.inside = corners.min(axis=1) >= -OUTSIDE
        corners = np.maximum(corners, 0.0)
        corners /= corners.sum(axis=1, keepdims=True)
        self.mapped = self._first.copy()
        self.mapped["nr"], self.mapped["x"], self.mapped["y"] = element, corners[:, 0], corners[:, 1]


def _barycentric(place: Array) -> Array:
    return np.column_stack([place, 1 - place.sum(axis=1)])


def _inverted(shape: Array, points: Array, place: Array) -> Array:
    """Reference coordinates at which elements with nodes ``shape``, (n, 6, 2), take the points."""
    # The map as a polynomial: c + g x + h y + (products of order 2), from its values at the nodes.
    a, b, c, bc, ac, ab = np.moveaxis(shape, 1, 0)
    xx, yy = 2 * (a + c - 2 * ac), 2 * (b + c - 2 * bc)
    xy = 4 * (c + ab - ac - bc)
    gx, gy = a - c - xx, b - c - yy
    place, todo = place.copy(), np.arange(len(points))
    for _ in range(10):
        x, y = place[todo, 0, None], place[todo, 1, None]
        off = c[todo] + (gx[todo] + xx[todo] * x + xy[todo] * y) * x + (gy[todo] + yy[todo] * y) * y - points[todo]
        dx, dy = gx[todo] + 2 * xx[todo] * x + xy[todo] * y, gy[todo] + 2 * yy[todo] * y + xy[todo] * x
        det = dx[:, 0] * dy[:, 1] - dx[:, 1] * dy[:, 0]
        step = np.stack([off[:, 0] * dy[:, 1] - off[:, 1] * dy[:, 0], dx[:, 0] * off[:, 1] - dx[:, 1] * off[:, 0]])
        step = (step / det).T
        place[todo] = np.clip(place[todo] - step, -3.0, 4.0)  # far outside the map may fold
        todo = todo[np.abs(step).max(axis=1) > 1e-10]
        if len(todo) == 0:
            return place
    # Beyond the fold of a curved element there is no solution: the plane through its corners shows the way.
    sides = np.stack([a[todo] - c[todo], b[todo] - c[todo]], axis=-1)
    place[todo] = np.linalg.solve(sides, (points[todo] - c[todo])[..., None])[..., 0]
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
