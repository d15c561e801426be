"""Curved elements filled by a field, and their edges as curves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.results.section import Section

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Normalize
    from matplotlib.path import Path

Array = NDArray[np.float64]
Index = NDArray[np.intp]

FINEST = 0.012  # of the section's extent: elements are divided until their pieces are no longer
MOST = 6  # pieces along an edge


def fill(axes: Axes, section: Section, values: Array, *, cmap: str, norm: Normalize) -> Any:
    """Fill the deformed elements by values at the vertices, shape (nv,); return what a colour bar needs."""
    from matplotlib.tri import Triangulation

    points, colours, triangles, start = [np.zeros((0, 2))], [np.zeros(0)], [np.zeros((0, 3), dtype=np.intp)], 0
    for nodes, corners in ((section.triangles, 3), (section.quadrilaterals, 4)):
        parts = _parts(section, nodes, corners)
        for n in np.unique(parts):
            mine = nodes[parts == n]
            place, linear, pieces = _divided(corners, int(n))
            points.append((place @ section.points[mine]).reshape(-1, 2))
            colours.append((values[mine[:, :corners]] @ linear.T).ravel())
            offset = start + len(place) * np.arange(len(mine))[:, None, None]
            triangles.append((pieces + offset).reshape(-1, 3))
            start += len(place) * len(mine)
    x, y = np.concatenate(points).T
    drawn = Triangulation(x, y, np.concatenate(triangles))
    return axes.tripcolor(drawn, np.concatenate(colours), shading="gouraud", cmap=cmap, norm=norm)


def _parts(section: Section, nodes: Index, corners: int) -> Index:
    """Into how many pieces each element's edges are divided: one for those that are small already."""
    if len(nodes) == 0:
        return np.empty(0, dtype=np.intp)
    extent = float(np.ptp(section.points, axis=0).max())
    size = np.ptp(section.points[nodes[:, :corners]], axis=1).max(axis=1)
    return np.clip(np.ceil(size / (FINEST * extent)).astype(np.intp), 1, MOST)


def _divided(corners: int, n: int) -> tuple[Array, Array, Index]:
    """Shape functions of places and of values at a lattice on the reference element, and the triangles between them."""
    if corners == 3:
        rows = [(i, j) for i in range(n + 1) for j in range(n + 1 - i)]
        number = {place: k for k, place in enumerate(rows)}
        up = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i, j in rows if i + j < n]
        down = [(number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]) for i, j in rows if i + j < n - 1]
        b, c = np.array(rows).T / n
        a = 1 - b - c
        quadratic = [a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c, 4 * c * a]
        return np.stack(quadratic, axis=1), np.stack([a, b, c], axis=1), np.array(up + down)
    k = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    low, right, left, high = (part.ravel() for part in (k[:-1, :-1], k[1:, :-1], k[:-1, 1:], k[1:, 1:]))
    x, y = (part.ravel() for part in np.meshgrid(*[np.linspace(0, 1, n + 1)] * 2, indexing="ij"))
    fx, fy = ([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)] for s in (x, y))
    grid = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1))
    linear = np.stack([(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y], axis=1)
    triangles = np.concatenate([np.stack([low, right, high], axis=1), np.stack([low, high, left], axis=1)])
    return np.stack([fx[i] * fy[j] for i, j in grid], axis=1), linear, triangles


def curves(points: Array, edges: Index) -> Path:
    """Parabolas through start, midpoint and end of edges, shape (m, 3), each joined to the next if it begins there."""
    from matplotlib.path import Path

    start, middle, end = (points[edges[:, k]] for k in range(3))
    control = 2 * middle - 0.5 * (start + end)
    begins = np.ones(len(edges), dtype=bool)
    begins[1:] = edges[1:, 0] != edges[:-1, 2]
    vertices, codes = np.stack([start, control, end], axis=1), np.full((len(edges), 3), Path.CURVE3, dtype=np.uint8)
    codes[:, 0] = Path.MOVETO
    keep = np.ones((len(edges), 3), dtype=bool)
    keep[:, 0] = begins
    return Path(vertices[keep], codes[keep])


def outline(section: Section, *, pieces: int = 4) -> list[Array]:
    """The border of the section as closed polygons, each edge in so many pieces."""
    s = np.arange(pieces) / pieces
    polygons = []
    for loop in section.loops():
        start, middle = section.points[loop[:, 0]], section.points[loop[:, 1]]
        end = np.roll(start, -1, axis=0)
        shapes = np.stack([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)], axis=1)
        polygons.append((shapes @ np.stack([start, middle, end], axis=1)).reshape(-1, 2))
    return polygons
