"""Layers of quadrilaterals below the edges that wear, triangles in the rest of the section."""

from __future__ import annotations

import math
from itertools import pairwise

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.errors import GeometryError, MeshError
from ngwear.geometry import section
from ngwear.geometry.cells import Cells, outlined
from ngwear.geometry.outline import Array, Outline
from ngwear.geometry.sizing import SizeField, fitted, mesh_nodes

Index = NDArray[np.intp]
SAME = 1e-7  # of the section's size: points nearer are one; above rounding, far below an element
INSIDE = "between layers and triangles"


def layered(
    contour: Outline, edges: tuple[str, ...], *, depth: float, edge: float, coarse: float, grading: float
) -> Cells:
    """Mesh a section with layers of quadrilaterals below the named edges, and triangles in the rest.

    Parameters
    ----------
    contour : Outline
    edges : tuple of str
        Edges that wear, one connected piece; they must not overhang the line from their first to their last point.
    depth : float
        Thickness of all layers [mm].
    edge : float
        Length of the elements' sides, along the edge and across [mm].
    coarse, grading : float
        Side of the triangles far away [mm], and its growth with the distance [-].

    Raises
    ------
    GeometryError
        If the edges are not in one piece or overhang, or the layers leave the section.
    """
    face, names = _face(contour, edges, edge)
    chord = face[-1] - face[0]
    along = chord / np.linalg.norm(chord)
    inward = np.array([-along[1], along[0]])  # the section lies on the left of its outline
    steps = np.diff(face, axis=0) @ along
    if steps.min() <= 0.05 * edge:  # columns so close, or backwards, make no element
        place = face[int(steps.argmin())].round(3).tolist()
        raise GeometryError(f"the edges {list(edges)} overhang at {place}: layers of elements cannot follow them")
    rows = max(1, round(depth / edge))
    grid = face[None] + (depth / rows * np.arange(rows + 1))[:, None, None] * inward
    number = np.arange(grid[..., 0].size).reshape(rows + 1, len(face))
    rest, named = _rest(contour, edges, grid, number, SAME * float(np.ptp(contour.points, axis=0).max()))
    quads = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], axis=-1).reshape(-1, 4)
    points, triangles, sides = _filled(rest, edge, coarse, grading)
    place, where = _merged(grid.reshape(-1, 2), points, 1e-6 * edge)
    corners = np.vstack([quads, np.column_stack([where[triangles], np.full(len(triangles), -1)])])
    named |= {(a, b): name for a, b, name in zip(number[0, :-1], number[0, 1:], names, strict=True)}
    named |= {(where[a], where[b]): name for (a, b), name in sides.items() if name != INSIDE}
    below = np.full(len(place), -1)
    below[number[:-1]] = number[1:]
    try:
        cells = outlined(place, corners, named, below, contour.provenance)
    except KeyError:
        raise MeshError("triangles and layers do not meet: choose other lengths of elements") from None
    if abs(cells.area - cells.contour.area) > 1e-9 * cells.area:
        raise MeshError("triangles and layers overlap or leave a gap: choose other lengths of elements")
    return cells


def _require_inside(contour: Outline, grid: Array) -> None:
    """The layers' far side must lie in the section, with room for triangles beyond it."""
    from shapely import Polygon, contains_xy

    inner = grid[-1, 1:-1]
    out = ~contains_xy(Polygon(contour.points), *inner.T)
    if out.any():
        place, depth = inner[out][0].round(3).tolist(), float(np.linalg.norm(grid[-1, 0] - grid[0, 0]))
        raise GeometryError(f"layers of {depth:.3g} mm leave the section at {place}: take fewer")


def _face(contour: Outline, edges: tuple[str, ...], edge: float) -> tuple[Array, list[str]]:
    """Nodes along the named edges, about ``edge`` apart, and the name of each piece between two."""
    on = contour.on(edges)
    starts = np.flatnonzero(on & ~np.roll(on, 1))
    if len(starts) != 1:
        raise GeometryError(f"the edges {list(edges)} must be one connected piece of the outline, and not all of it")
    n, count = len(contour), int(on.sum())
    run = (starts[0] + np.arange(count + 1)) % n
    chord = contour.points[run[-1]] - contour.points[run[0]]
    height = contour.points[run] @ np.array([-chord[1], chord[0]]) / np.linalg.norm(chord)
    name = np.array([contour.names[i] for i in run[:-1]])
    fixed = np.zeros(count + 1, dtype=bool)
    fixed[[0, -1]] = True
    fixed[1:-1] = contour.corners[run[1:-1]] | (name[1:] != name[:-1])
    fixed[1:-1] |= (height[1:-1] < height[:-2]) & (height[1:-1] <= height[2:])  # the tips of ridges
    way = np.concatenate([[0.0], np.cumsum(contour.lengths[run[:-1]])])
    nodes, names = [contour.points[run[0]]], []
    marks = np.flatnonzero(fixed)
    for a, b in pairwise(marks):
        parts = max(1, math.ceil((way[b] - way[a]) / edge - 0.25))
        at = way[a] + (way[b] - way[a]) * np.arange(1, parts + 1) / parts
        where = np.interp(at, way, np.arange(count + 1))
        nodes += list(contour.at(starts[0] + where))
        names += [str(name[min(int(w), count - 1)]) for w in np.interp(at - 1e-9 * way[-1], way, np.arange(count + 1))]
    return np.array(nodes), names


def _rest(
    contour: Outline, edges: tuple[str, ...], grid: Array, number: Index, same: float
) -> tuple[Outline, dict[tuple[int, int], str]]:
    """Outline of the section without its layers, and the names of the layers' own sides."""
    on, n = contour.on(edges), len(contour)
    end = int(np.flatnonzero(on & ~np.roll(on, -1))[0]) + 1  # the worn run's last point
    others = (end + np.arange(n - int(on.sum()) + 1)) % n
    points, corners = contour.points[others], contour.corners[others]
    names = [contour.names[i] for i in others[:-1]]
    sides: dict[tuple[int, int], str] = {}
    skip, name = _beside(points, names, grid[:, -1], same)
    if skip:
        points, corners, names = np.vstack([grid[-1:, -1], points[skip:]]), corners[skip - 1 :], names[skip - 1 :]
        sides |= {(a, b): name for a, b in zip(number[:-1, -1], number[1:, -1], strict=True)}
    down = [] if skip else list(grid[:0:-1, -1])
    skip, name = _beside(points[::-1], names[::-1], grid[:, 0], same)
    up = [] if skip else list(grid[1:, 0])
    if skip:
        points, corners = np.vstack([points[:-skip], grid[-1:, 0]]), corners[: len(corners) - skip + 1]
        names = names[: len(names) - skip + 1]
        sides |= {(b, a): name for a, b in zip(number[:-1, 0], number[1:, 0], strict=True)}
    _require_inside(contour, grid)
    ring = [*points, *up, *grid[-1, 1:-1], *down]
    more = len(ring) - len(names)
    flags = np.concatenate([corners, np.ones(len(ring) - len(corners), dtype=bool)])
    flags[[0, len(points) - 1]] = True
    return Outline(np.array(ring), (*names, *[INSIDE] * more), flags), sides


def _beside(points: Array, names: list[str], side: Array, same: float) -> tuple[int, str]:
    """Number of the outline's first points on the layers' side, and the edge's name there; 0 if there are none."""
    depth = float(np.linalg.norm(side[-1] - side[0]))
    inward = (side[-1] - side[0]) / depth
    off = points - side[0]
    across = np.abs(off[:, 0] * inward[1] - off[:, 1] * inward[0])
    along = off @ inward
    if across[1] > same or along[1] < 0:
        return 0, ""
    k = int(np.flatnonzero((along > depth + same) | (across > same))[0])
    if across[k] > same or len(set(names[:k])) > 1:
        raise GeometryError(
            f"the layers are {depth:.3g} mm thick, more than the edge '{names[0]}' beside them is long: take fewer"
        )
    return k, names[0]


def _filled(
    rest: Outline, edge: float, coarse: float, grading: float
) -> tuple[Array, Index, dict[tuple[int, int], str]]:
    """Triangles of the rest: points, corners, and the name of each side on its outline."""
    interface = rest.on((INSIDE,))
    seeds = rest.points[interface | np.roll(interface, 1)]
    field = SizeField(seeds, np.full(len(seeds), edge), coarse, grading)
    base = fitted(rest, field)
    mesh = section.mesh(base, mesh_nodes(base, field), field)
    points, triangles = section.mesh_arrays(mesh)
    sides = {}
    for element in mesh.Elements(ng.BND):
        a, b = (v.nr for v in element.vertices)
        sides[a, b] = sides[b, a] = element.mat
    return points, triangles, sides


def _merged(first: Array, second: Array, same: float) -> tuple[Array, Index]:
    """Points of both, common ones once, and where each of the second ones is."""
    from scipy.spatial import cKDTree

    distance, nearest = cKDTree(first).query(second)
    new = distance > same
    where = np.where(new, len(first) + np.cumsum(new) - 1, nearest)
    return np.vstack([first, second[new]]), where
