"""Move a worn outline inwards so that its polygon loses exactly the worn area; repair it if it crosses itself."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import GeometryError
from ngwear.geometry.outline import Array, Outline
from ngwear.geometry.sizing import SizeField

# A fifth of the rod seal's element edge, on which it was settled; parts measured in µm or m would want another.
OPENING = 2e-3  # mm; slivers and necks thinner than twice this are removed when an outline is healed
# 73 degrees: beyond, a point runs more than three times as far as the depth; settled on the torn seal.
STEEPEST = 0.3  # cosine between a column and the outline's normal, up to which points follow the column
SHAPE = 0.05  # of the greatest worn depth: how far the outline may move where two of its points are merged
SHARPEST = np.radians(30)  # inner angle of a tongue: the mesher needs 12 degrees, and a step of wear halves it
MAX_SUBSTEP = 0.2  # of the shorter neighbouring segment: normals then turn little in a part; costs next to nothing


def recede(contour: Outline, area: Array, worn_edges: tuple[str, ...]) -> Outline:
    """Take ``area`` [mm²], given at each contour point, off the outline.

    Points move along their normals, ends of the worn edges along the unworn neighbour. With directions m
    and depths d the polygon loses

        sum d_i g_i - 1/2 sum d_i d_(i+1) m_i x m_(i+1),   g_i = -1/2 m_i x (x_(i+1) - x_(i-1)),

    and the depths are chosen so that each point's share, the products split evenly, is ``area[i]``: the
    loss is exact in the second order too. Large steps are split.

    Parameters
    ----------
    contour : Outline
    area : array, shape (n,)
        Area to remove at each point, >= 0.
    worn_edges : tuple of str
        Edges that wear; area must vanish elsewhere.

    Returns
    -------
    Outline
        With the same points displaced, or with other points if it had to be repaired.

    Raises
    ------
    GeometryError
        If the section is worn through.
    """
    points = receded(contour, area, worn_edges)
    if points is contour.points:
        return contour
    try:
        return replace(contour, points=points)
    except GeometryError:
        return healed(contour, points)


def receded(contour: Outline, area: Array, worn_edges: tuple[str, ...], columns: Array | None = None) -> Array:
    """The outline's points after ``recede``, without repair, shape (n, 2) [mm].

    ``columns`` are unit vectors along which points shall move instead of their normals, shape (n, 2); zero for none.
    """
    points, rest = contour.points, np.asarray(area, dtype=float)
    worn = np.flatnonzero(rest > 0)
    if len(worn) == 0:
        return points
    shorter = np.minimum(contour.lengths, np.roll(contour.lengths, 1))
    typical = rest / contour.widths()
    parts = int(np.ceil(np.max(typical[worn] / (MAX_SUBSTEP * shorter[worn]))))
    for _ in range(max(parts, 1)):
        points = points + _displacement(points, rest / max(parts, 1), contour, worn_edges, columns)
    return points


def _displacement(
    points: Array, area: Array, contour: Outline, worn_edges: tuple[str, ...], columns: Array | None
) -> Array:
    chord = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    inward = np.stack([-chord[:, 1], chord[:, 0]], axis=1) / np.linalg.norm(chord, axis=1)[:, None]
    wears = contour.on(worn_edges)
    sharp = contour.corners & (np.abs(contour.turning) > 0.2)  # rad: at a corner that is nearly straight, go inwards
    starts = sharp & wears & ~np.roll(wears, 1)  # the segment before is another, unworn edge
    ends = sharp & ~wears & np.roll(wears, 1)
    for where, neighbour in ((starts, 1), (ends, -1)):  # slide along the unworn edge
        along = np.roll(points, neighbour, axis=0)[where] - points[where]
        inward[where] = along / np.linalg.norm(along, axis=1)[:, None]
    if columns is not None:
        inward = np.where(((inward * columns).sum(axis=1) > STEEPEST)[:, None], columns, inward)
    g = -0.5 * _cross(inward, chord)
    product = _cross(inward, np.roll(inward, -1, axis=0))
    worn = area > 0
    depth = np.divide(area, g, out=np.zeros_like(area), where=worn)
    for _ in range(50):  # converges fast: depths are below a fifth of a segment
        ahead = np.roll(depth, -1) * product
        behind = np.roll(depth, 1) * np.roll(product, 1)
        new = np.divide(area, g - 0.25 * (ahead + behind), out=np.zeros_like(area), where=worn)
        done = np.max(np.abs(new - depth)) < 1e-15
        depth = new
        if done:
            break
    return depth[:, None] * inward


def _cross(a: Array, b: Array) -> Array:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def healed(before: Outline, after: Array) -> Outline:
    """Repair an outline that crosses itself: largest piece of the section without the swept area, opened by
    ``OPENING``.

    Points take edge names and corners from the nearest point of the receded outline.

    Raises
    ------
    GeometryError
        If an edge is worn away completely or the section is cut in two.
    """
    from shapely import MultiPoint, Polygon, union_all
    from shapely.geometry import MultiPolygon

    moved = np.linalg.norm(after - before.points, axis=1) > 0
    n = len(before)
    swept = []
    for i in range(n):
        j = (i + 1) % n
        if moved[i] or moved[j]:
            hull = MultiPoint([before.points[i], before.points[j], after[j], after[i]]).convex_hull
            if isinstance(hull, Polygon):  # a segment that moves along itself sweeps nothing
                swept.append(hull)
    whole = Polygon(before.points)
    left: Any = whole.difference(union_all(swept, grid_size=1e-7), grid_size=1e-7)
    left = left.buffer(-OPENING, join_style="mitre").buffer(OPENING, join_style="mitre")
    pieces = list(left.geoms) if isinstance(left, MultiPolygon) else [left]
    pieces = sorted((p for p in pieces if not p.is_empty), key=lambda p: p.area)
    if not pieces or pieces[-1].area < 0.9 * sum(p.area for p in pieces):
        place = before.points[moved].mean(axis=0).round(4).tolist()
        raise GeometryError(f"the section is worn through near {place}")
    ring = pieces[-1].exterior
    return _renamed(before, after, _with_points(np.array(ring.coords)[:-1], after))


def without_tongues(contour: Outline, worn_edges: tuple[str, ...]) -> Outline:
    """The outline without the tips of tongues: points between two worn segments with an inner angle below ``SHARPEST``.

    Wear leaves them where a surface folds. The same outline if it has none.
    """
    while True:
        worn = contour.on(worn_edges)
        sharp = (contour.turning > np.pi - SHARPEST) & worn & np.roll(worn, 1)
        drop = sharp & ~np.roll(sharp, 1)
        if not drop.any():
            return contour
        contour = contour.without(drop)


def refuse_worn_through(contour: Outline) -> None:
    """Raise GeometryError if a section is nowhere thicker than ``2 OPENING``, or is cut in two by the opening."""
    from shapely import Polygon

    left = Polygon(contour.points).buffer(-OPENING)
    pieces = getattr(left, "geoms", [left])
    if left.is_empty or max(p.area for p in pieces) < 0.9 * left.area:
        place = contour.points.mean(axis=0).round(4).tolist()
        raise GeometryError(f"the section is worn through near {place}: less than {2 * OPENING} mm of it is left")


def _with_points(ring: Array, points: Array) -> Array:
    """Put the outline's own points back on a ring's straight segments: shapely merges what lies in line."""
    ahead = np.roll(ring, -1, axis=0) - ring
    length = np.linalg.norm(ahead, axis=1)
    out = []
    for start, step, size in zip(ring, ahead, length, strict=True):
        out.append(start[None])
        along = (points - start) @ step / size
        off = np.abs(_cross(points - start, np.broadcast_to(step, points.shape))) / size
        mine = (off < 1e-9) & (along > 1e-6) & (along < size - 1e-6)
        out.append(points[mine][np.argsort(along[mine])])
    return np.vstack(out)


def _renamed(before: Outline, after: Array, points: Array) -> Outline:
    from scipy.spatial import cKDTree

    x, y = points.T
    if x @ np.roll(y, -1) - y @ np.roll(x, -1) < 0:
        points = points[::-1]
    _, nearest = cKDTree(after).query(points)
    middle = 0.5 * (points + np.roll(points, -1, axis=0))
    _, segment = cKDTree(0.5 * (after + np.roll(after, -1, axis=0))).query(middle)
    names = tuple(before.names[i] for i in segment)
    lost = set(before.names) - set(names)
    if lost:
        raise GeometryError(f"the edges {sorted(lost)} are worn away")
    ahead = np.roll(points, -1, axis=0) - points
    angle = np.arctan2(ahead[:, 1], ahead[:, 0])
    sharp = np.abs((angle - np.roll(angle, 1) + np.pi) % (2 * np.pi) - np.pi) > np.radians(30)
    on_point = np.linalg.norm(after[nearest] - points, axis=1) < 1e-6
    corners = np.where(on_point, before.corners[nearest], False) | sharp
    return Outline(points, names, corners, before.provenance)


def tidied(contour: Outline, field: SizeField, worn: float) -> Outline:
    """Merge worn segments shorter than 0.4 h into one point each, keeping the polygon's area exactly.

    Two points become one where that moves the outline by less than ``SHAPE`` of the greatest worn depth: roundings that
    were drawn with short segments keep their shape.

    Parameters
    ----------
    contour : Outline
    field : SizeField
        Wanted element edges h.
    worn : float
        Greatest worn depth [mm].
    """
    kept: NDArray[np.bool_] = np.zeros(len(contour), dtype=bool)  # at the start of a segment that stays
    while True:
        h = np.minimum(field(contour.points), field(np.roll(contour.points, -1, axis=0)))
        fixed = contour.corners | np.array([contour.names[i] != contour.names[i - 1] for i in range(len(contour))])
        short = (contour.lengths < 0.4 * np.minimum(h, np.median(contour.lengths))) & ~fixed & ~np.roll(fixed, -1)
        pick = _apart(np.flatnonzero(short & ~kept), len(contour))
        if len(pick) == 0:
            spare = _beside_fixed(contour, fixed, h)
            if not spare.any():
                return contour
            contour, kept = contour.without(spare), kept[~spare]
            continue
        points, n = contour.points.copy(), len(contour)
        drop: NDArray[np.bool_] = np.zeros(n, dtype=bool)
        for i in pick:
            before = contour.points[(i + np.arange(-1, 3)) % n]
            merged = _merged(before)
            if _off(before, merged) > SHAPE * worn:
                kept[i] = True
                continue
            points[i] = merged
            drop[(i + 1) % n] = True
        if drop.any():
            contour = replace(contour, points=points).without(drop)
        kept = kept[~drop]


def _merged(points: Array) -> Array:
    """The point that replaces the middle two of four so that the area beside them stays, shape (2,)."""
    a, b, c, d = points
    middle, chord = 0.5 * (b + c), d - a
    outward = np.array([chord[1], -chord[0]]) / np.linalg.norm(chord)
    lost = _area(points) - _area(np.array([a, middle, d]))
    return np.asarray(middle + outward * (2 * lost / np.linalg.norm(chord)))


def _off(points: Array, merged: Array) -> float:
    """How far the middle two of four points lie off the line from the first over ``merged`` to the last [mm]."""
    from shapely import LineString
    from shapely import points as as_points

    return float(LineString([points[0], merged, points[3]]).distance(as_points(points[1:3])).max())


def _beside_fixed(contour: Outline, fixed: NDArray[np.bool_], h: Array) -> NDArray[np.bool_]:
    """Points on a straight piece so close to a fixed point (a sliding worn corner) that they are dropped."""
    short = contour.lengths < 0.4 * np.minimum(h, np.median(contour.lengths))
    chord = np.roll(contour.points, -1, axis=0) - np.roll(contour.points, 1, axis=0)
    off = np.abs(_cross(contour.points - np.roll(contour.points, 1, axis=0), chord))  # twice the area that goes
    straight = off < 1e-9 * (chord**2).sum(axis=1)
    near = (short & np.roll(fixed, -1)) | (np.roll(short, 1) & np.roll(fixed, 1))
    spare = near & ~fixed & straight
    return spare & ~np.roll(spare, 1)


def _apart(index: NDArray[np.intp], n: int) -> list[int]:
    """Members of ``index`` at least four points apart."""
    chosen: list[int] = []
    for i in index:
        if (not chosen or i - chosen[-1] >= 4) and (not chosen or i - chosen[0] <= n - 4):
            chosen.append(int(i))
    return chosen


def _area(points: Array) -> float:
    x, y = (points - points[0]).T
    return float(0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1)))
