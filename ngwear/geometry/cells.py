"""A section as a list of elements with straight edges, which can be lost one by one."""

from __future__ import annotations

import enum
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import GeometryError
from ngwear.geometry.outline import Array, Outline

Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

HOLE, EXPOSED = "hole", "exposed"
CUT = 0.05  # of the section: how much may come loose at once before it counts as cut in two; crumbs are some elements


class Fate(enum.IntEnum):
    """State of an element."""

    LIVING = 0
    TORN = 1
    DISTORTED = 2
    LOOSE = 3
    WORN = 4  # away, its points merged with those beneath


@dataclass(frozen=True)
class Cells:
    """Quadrilaterals and triangles with straight edges; those with the state LIVING make up the section.

    Parameters
    ----------
    points : array, shape (n, 2)
        Unloaded coordinates [mm].
    corners : array of int, shape (m, 4)
        Points of each element, counter-clockwise; -1 comes last in a triangle.
    fate : array of int, shape (m,)
        See ``Fate``.
    rim : array of int, shape (k,)
        Points of the outline, counter-clockwise; segment i runs from rim[i] to the next.
    names : tuple of str, length k
        Name of each segment's edge.
    below : array of int, shape (n,)
        Next point inwards on each point's column; -1 for none.
    made : array, shape (m,)
        Least corner Jacobian of each element when it was made, see ``least_jacobians`` [mm²].
    layers : array of bool, shape (m,)
        Which elements were made as quadrilaterals of the layers, which may be lost.
    provenance : str
        Where the outline comes from.
    """

    points: Array
    corners: Index
    fate: NDArray[np.int8]
    rim: Index
    names: tuple[str, ...]
    below: Index
    made: Array
    layers: Mask
    provenance: str = ""

    @property
    def living(self) -> Mask:
        """Which elements are still there, shape (m,)."""
        return self.fate == Fate.LIVING

    @property
    def quads(self) -> Mask:
        """Which elements have four corners, shape (m,)."""
        return self.corners[:, 3] >= 0

    def areas(self) -> Array:
        """Signed area of each element [mm²], shape (m,); a triangle's last corner is its first again."""
        x, y = np.moveaxis(self.points[self._closed()], -1, 0)
        x, y = x - x[:, :1], y - y[:, :1]
        return 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)

    def least_jacobians(self) -> Array:
        """Least corner Jacobian of each element: the parallelogram of both sides there [mm²], shape (m,)."""
        ahead, behind = self._corner_sides()
        return np.nanmin(ahead[..., 0] * behind[..., 1] - ahead[..., 1] * behind[..., 0], axis=1)

    def corner_cosines(self) -> Array:
        """Largest cosine of the angle at a corner of each element [-], shape (m,); 1 for one that is inside out.

        The measure of the source work (10.5772/50498, case C5).
        """
        ahead, behind = self._corner_sides()
        lengths = np.linalg.norm(ahead, axis=2) * np.linalg.norm(behind, axis=2)
        cosine = np.nanmax((ahead * behind).sum(axis=2) / np.maximum(lengths, 1e-300), axis=1)
        return np.where(self.least_jacobians() > 0, cosine, 1.0)

    def _corner_sides(self) -> tuple[Array, Array]:
        """Sides that leave each corner, forwards and backwards, shape (m, 4, 2); nan at a triangle's fourth."""
        missing = self.corners < 0
        place = self.points[self.corners]
        place[missing] = np.nan
        after, before = np.roll(place, -1, axis=1), np.roll(place, 1, axis=1)
        after[missing[:, 3], 2] = place[missing[:, 3], 0]
        before[missing[:, 3], 0] = place[missing[:, 3], 2]
        return after - place, before - place

    def centres(self) -> Array:
        """Means of the elements' corners [mm], shape (m, 2)."""
        real = (self.corners >= 0)[..., None]
        return (self.points[self.corners] * real).sum(axis=1) / real.sum(axis=1)

    @property
    def area(self) -> float:
        """Area of the living elements [mm²]."""
        return float(self.areas()[self.living].sum())

    @property
    def contour(self) -> Outline:
        """The outline, straight between its points."""
        return Outline(self.points[self.rim], self.names, np.ones(len(self.rim), dtype=bool), self.provenance)

    def moved(self, points: Array) -> Cells:
        """The same cells with the outline's points moved to ``points``, shape (k, 2); inner points stay."""
        everywhere = self.points.copy()
        everywhere[self.rim] = points
        return replace(self, points=everywhere)

    def inward(self) -> Array:
        """Unit vector from each point of the outline to the next one on its column, shape (k, 2); zero for none."""
        beneath = self.below[self.rim]
        way = np.where((beneath >= 0)[:, None], self.points[beneath] - self.points[self.rim], 0.0)
        length = np.linalg.norm(way, axis=1)[:, None]
        return np.divide(way, length, out=np.zeros_like(way), where=length > 0)

    def merged(self, surface: Index) -> Cells:
        """The same cells, each given outline point merged with the next point of its column, at the place of the
        former.

        Quadrilaterals beside become triangles, triangles vanish.
        """
        beneath = self.below[surface]
        into = np.arange(len(self.points))
        into[beneath] = surface
        below = self.below.copy()
        below[surface] = self.below[beneath]
        corners, fate = self.corners.copy(), self.fate.copy()
        for k in np.flatnonzero(np.isin(corners, beneath).any(axis=1)):
            left = list(dict.fromkeys(int(into[p]) for p in corners[k] if p >= 0))
            if len(left) < 3:
                fate[k] = Fate.WORN if fate[k] == Fate.LIVING else fate[k]
            else:
                corners[k] = [*left, -1][:4]
        kept = ~np.isin(self.rim, beneath)
        names = tuple(name for name, stays in zip(self.names, kept, strict=True) if stays)
        return replace(self, corners=corners, fate=fate, rim=self.rim[kept], names=names, below=below)

    def _closed(self) -> Index:
        return np.where(self.corners < 0, self.corners[:, :1], self.corners)

    def sides(self, which: Mask) -> tuple[Index, Index]:
        """Directed sides of some elements, shape (s, 2), and the element of each, shape (s,)."""
        closed = self._closed()[which]
        sides = np.stack([closed, np.roll(closed, -1, axis=1)], axis=-1).reshape(-1, 2)
        owner = np.repeat(np.flatnonzero(which), 4)
        real = sides[:, 0] != sides[:, 1]
        return sides[real], owner[real]

    def without(self, dead: Mask, fate: Fate, bonded: tuple[str, ...] = ()) -> Cells:
        """The section without the elements ``dead`` and without those that then are disconnected or hang on one point.

        An exposed side takes the name of the nearest one of the outline before; one that faces away counts as farther.
        The names of ``bonded`` edges are not passed on: a support does not hold the rubber behind it.

        Raises
        ------
        GeometryError
            If nothing is left, or the section is cut in two.
        """
        fates = self.fate.copy()
        fates[dead & self.living] = fate
        new = replace(self, fate=fates)
        while True:
            loose = new._apart()
            if not loose.any():
                loose = new._hanging()
            if not loose.any():
                return new._with_rim(self, bonded)
            fates = new.fate.copy()
            fates[loose] = Fate.LOOSE
            new = replace(new, fate=fates)

    def _apart(self) -> Mask:
        """Living elements that no chain of common sides joins to the largest piece."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        living = self.living
        if not living.any():
            raise GeometryError("every element is deactivated: nothing of the section is left")
        first, second = self._neighbours(living)
        size = len(living)
        joined = coo_array((np.ones(len(first)), (first, second)), shape=(size, size))
        _, piece = connected_components(joined, directed=False)
        areas = np.where(living, self.areas(), 0.0)
        whole = np.bincount(piece, areas)
        loose = living & (piece != whole.argmax())
        if areas[loose].sum() > CUT * areas.sum():
            place = self.points[self._closed()[loose]].mean(axis=(0, 1)).round(3).tolist()
            raise GeometryError(
                f"the section is cut in two: {areas[loose].sum():.3g} of {areas.sum():.3g} mm² around {place} are "
                "disconnected; a higher critical stress, less load, or shallower layers keep it whole"
            )
        return loose

    def _neighbours(self, living: Mask) -> tuple[Index, Index]:
        """Pairs of living elements with a common side."""
        sides, owner = self.sides(living)
        low, high = np.sort(sides, axis=1).T
        order = np.lexsort((high, low))
        same = (np.diff(low[order]) == 0) & (np.diff(high[order]) == 0)
        return owner[order][:-1][same], owner[order][1:][same]

    def _hanging(self) -> Mask:
        """Living elements of all but the largest fan at a point that the boundary passes more than once."""
        living, hanging = self.living, np.zeros(len(self.fate), dtype=bool)
        open_sides = self._open_sides(living)
        times = np.bincount(open_sides[:, 0], minlength=len(self.points))
        if times.max(initial=0) < 2:
            return hanging
        closed, areas = self._closed(), self.areas()
        for point in np.flatnonzero(times > 1).tolist():
            around = np.flatnonzero(living & (closed == point).any(axis=1))
            fans = _fans(closed[around], point)
            for fan in sorted(fans, key=lambda fan: areas[around[fan]].sum())[:-1]:
                hanging[around[fan]] = True
        return hanging

    def _open_sides(self, living: Mask) -> Index:
        """Directed sides without a neighbour: the section's boundary, holes included."""
        sides, _ = self.sides(living)
        size = len(self.points)
        return sides[~np.isin(sides[:, 0] * size + sides[:, 1], sides[:, 1] * size + sides[:, 0])]

    def _with_rim(self, before: Cells, bonded: tuple[str, ...]) -> Cells:
        rim = _around(self._loops()[0], before.rim)
        pairs = list(zip(rim, np.roll(rim, -1), strict=True))
        old = {(a, b): name for a, b, name in zip(before.rim, np.roll(before.rim, -1), before.names, strict=True)}
        places, ahead = _middles(before.points, before.rim)
        mine, along = _middles(self.points, rim)
        # Of sides as near, one that faces the same way: else a new corner of a layer would be named after its flank.
        off = np.linalg.norm(mine[:, None] - places, axis=2) * (2.0 - along @ ahead.T)
        off[:, np.isin(before.names, bonded)] = np.inf
        nearest = [
            before.names[k] if np.isfinite(row[k]) else EXPOSED for row, k in zip(off, off.argmin(1), strict=True)
        ]
        return replace(self, rim=rim, names=tuple(map(old.get, pairs, nearest)))

    def _loops(self) -> list[Index]:
        """Closed chains of boundary points, the outline first, then holes."""
        after = dict(self._open_sides(self.living).tolist())
        loops = []
        while after:
            start, point = next(iter(after.items()))
            loop = [start]
            del after[start]
            while point != start:
                loop.append(point)
                point = after.pop(point)
            loops.append(np.array(loop))

        def area(loop: Index) -> float:
            x, y = self.points[loop].T
            return float(x @ np.roll(y, -1) - y @ np.roll(x, -1))

        return sorted(loops, key=area, reverse=True)

    def holes(self) -> Index:
        """Sides around what has been lost inside, shape (h, 2)."""
        loops = self._loops()[1:]
        return np.vstack([np.stack([loop, np.roll(loop, -1)], axis=1) for loop in loops] or [np.zeros((0, 2), int)])


def outlined(
    points: Array, corners: Index, names: dict[tuple[int, int], str], below: Index, provenance: str = ""
) -> Cells:
    """Cells whose outline has the given name for each of its sides."""
    nothing, fate = np.zeros(0, np.intp), np.zeros(len(corners), np.int8)
    layers = corners[:, 3] >= 0
    bare = Cells(points, corners, fate, nothing, (), below, np.zeros(len(corners)), layers, provenance)
    rim = bare._loops()[0]
    named = tuple(names[pair] for pair in zip(rim, np.roll(rim, -1), strict=True))
    return replace(bare, rim=rim, names=named, made=bare.least_jacobians())


def _middles(points: Array, rim: Index) -> tuple[Array, Array]:
    """Middle and direction of each segment of an outline, shapes (k, 2)."""
    start, end = points[rim], points[np.roll(rim, -1)]
    ahead = end - start
    return 0.5 * (start + end), ahead / np.linalg.norm(ahead, axis=1)[:, None]


def _around(loop: Index, before: Index) -> Index:
    """A loop that begins at the first point of the one before that it still has."""
    kept = before[np.isin(before, loop)]
    return np.roll(loop, -int(np.flatnonzero(loop == kept[0])[0])) if len(kept) else loop


def _fans(corners: Index, point: int) -> list[Index]:
    """Groups of elements around a point that common sides join."""
    ends = []
    for row in corners.tolist():
        ring = list(dict.fromkeys(row))
        at = ring.index(point)
        ends.append({ring[at - 1], ring[(at + 1) % len(ring)]})
    left, fans = set(range(len(corners))), []
    while left:
        fan, grown = [left.pop()], True
        while grown:
            more = [k for k in left if any(ends[k] & ends[j] for j in fan)]
            left -= set(more)
            fan += more
            grown = bool(more)
        fans.append(np.array(fan))
    return fans
