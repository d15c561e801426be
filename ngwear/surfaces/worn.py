"""The worn profile of a counter-surface."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ngwear.surfaces.base import RigidSurface

Array = NDArray[np.float64]


@dataclass(frozen=True)
class WornProfile:
    """Worn depth of a rigid surface, over the coordinate along it in its own frame; 0 where nothing touched it.

    The depth is linear between points at whole multiples of ``spacing``; on an open curve it is 0 at the first and the
    last point. On a closed curve the points go all around from its first turn on (``swept``).

    Parameters
    ----------
    spacing : float
        Distance of the points [mm].
    first : int
        Multiple of the spacing at which the first point lies.
    depth : array, shape (n,)
        Depth along the surface's normal [mm].
    length : float
        Length of a closed curve [mm], a whole multiple of the spacing (see ``of``).
    """

    spacing: float
    first: int = 0
    depth: Array = field(default_factory=lambda: np.zeros(1))
    length: float = math.inf

    @classmethod
    def of(cls, surface: RigidSurface, spacing: float) -> WornProfile:
        """An unworn profile; points ``spacing`` [mm] apart, or a little less: an even number on a closed curve."""
        around = surface.length
        return cls(spacing if math.isinf(around) else around / (2 * math.ceil(around / spacing / 2)), length=around)

    @property
    def along(self) -> Array:
        """Coordinate of each point along the surface [mm], shape (n,)."""
        return self.spacing * (self.first + np.arange(len(self.depth), dtype=float))

    @property
    def area(self) -> float:
        """Worn area of the profile [mm²]."""
        return float(np.trapezoid(self.depth)) * self.spacing

    def at(self, along: Array) -> Array:
        """Depth at places along the surface [mm]."""
        if math.isfinite(self.length):
            along = self._wrapped(along)
        return np.interp(along, self.along, self.depth, left=0.0, right=0.0)

    def worn(self, ends: Array, depth: Array) -> WornProfile:
        """The profile with added wear, which is linear along each given piece.

        Each point takes ``int depth phi ds / spacing`` with its hat function phi, so that the worn area grows by
        exactly the added area.

        Parameters
        ----------
        ends : array, shape (m, 2)
            Coordinates along the surface of both ends of each piece [mm].
        depth : array, shape (m, 2)
            Wear there [mm].
        """
        loaded = np.any(depth != 0, axis=1)
        ends, depth = ends[loaded] / self.spacing, depth[loaded]
        if len(ends) == 0:
            return self
        turned = ends[:, 0] > ends[:, 1]
        ends[turned], depth[turned] = ends[turned][:, ::-1], depth[turned][:, ::-1]
        wider = self._reaching(int(np.floor(ends.min())) - 1, int(np.ceil(ends.max())) + 1)
        points = wider.first + np.arange(len(wider.depth))
        # A hat function is the second difference of max(0, x): integrate the wear against that at every point.
        ramp = sum((_against_ramps(points, *piece) for piece in zip(ends, depth, strict=True)), np.zeros(len(points)))
        share = np.zeros(len(points))
        share[1:-1] = ramp[2:] - 2 * ramp[1:-1] + ramp[:-2]
        return replace(wider, depth=wider.depth + share)

    def swept(self, ends: Array, depth: Array, ways: Array) -> WornProfile:
        """The profile with added wear, when the surface moves along itself under pieces that stand still.

        Each point takes ``int depth dx`` over the places x that it passes. The added area is exact: the integral of
        ``depth`` times the length of the ways.

        Parameters
        ----------
        ends : array, shape (m, 2)
            Coordinates of both ends of each piece along the surface as it stands at the way 0 [mm].
        depth : array, shape (m, 2)
            Wear there per way [-]; linear along each piece.
        ways : array, shape (n, 2)
            How far the surface has moved against its coordinate at the start and the end of each pass [mm].
        """
        under = WornProfile(self.spacing).worn(ends, depth)
        until, whole = np.cumsum(under.depth) * self.spacing, under.area
        first, last = np.sort(ways, axis=1).T
        if math.isinf(self.length):
            low, high = under.along[0] + first.min(), under.along[-1] + last.max()
            wider = self._reaching(math.floor(low / self.spacing) - 1, math.ceil(high / self.spacing) + 1)
            images, added = np.zeros(1), np.zeros(len(wider.depth))
        else:
            half = round(self.length / self.spacing / 2)
            wider = self._reaching(-half, half)
            turns = np.floor((last - first) / self.length)
            rest = last - first - turns * self.length
            first = self._wrapped(first)
            last = first + rest
            images, added = self.length * np.arange(-2, 3, dtype=float), np.full(len(wider.depth), whole * turns.sum())

        def passed(place: Array) -> Array:
            return np.interp(place, under.along + self.spacing / 2, until, left=0.0, right=whole)

        for a, b in zip(first, last, strict=True):
            for image in images:
                added += passed(wider.along + image - a) - passed(wider.along + image - b)
        return replace(wider, depth=wider.depth + added)

    def _wrapped(self, along: Array) -> Array:
        """The same place of a closed curve within half its length of the origin [mm]."""
        return (along + self.length / 2) % self.length - self.length / 2

    def _reaching(self, first: int, last: int) -> WornProfile:
        """The same profile with points from ``first`` to ``last`` at least."""
        before = max(0, self.first - first)
        after = max(0, last - (self.first + len(self.depth) - 1))
        return replace(self, first=self.first - before, depth=np.pad(self.depth, (before, after)))


def _against_ramps(points: NDArray[np.intp], ends: Array, depth: Array) -> Array:
    """``int depth max(0, x_j - x) dx`` over a piece along which the depth is linear, for each point x_j."""
    (a, b), (start, end) = ends, depth
    reach = np.clip(points, a, b) - a
    slope = (end - start) / (b - a) if b > a else 0.0
    beyond = points - a
    return start * (beyond * reach - reach**2 / 2) + slope * (beyond * reach**2 / 2 - reach**3 / 3)
