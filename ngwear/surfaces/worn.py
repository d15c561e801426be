"""The worn profile of a counter-surface."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class WornProfile:
    """Depth worn off a rigid surface, over the coordinate along it in its own frame; 0 where nothing touched it.

    The depth is linear between points at whole multiples of ``spacing``, and 0 at the first and the last of them.

    Parameters
    ----------
    spacing : float
        Distance of the points [mm].
    first : int
        Multiple of the spacing at which the first point lies.
    depth : array, shape (n,)
        Depth along the surface's normal [mm].
    """

    spacing: float
    first: int = 0
    depth: Array = field(default_factory=lambda: np.zeros(1))

    @property
    def along(self) -> Array:
        """Coordinate of each point along the surface [mm], shape (n,)."""
        return self.spacing * (self.first + np.arange(len(self.depth)))

    @property
    def area(self) -> float:
        """Worn area of the profile [mm²]."""
        return float(self.depth.sum()) * self.spacing

    def at(self, along: Array) -> Array:
        """Depth at places along the surface [mm]."""
        return np.interp(along, self.along, self.depth, left=0.0, right=0.0)

    def worn(self, ends: Array, depth: Array) -> WornProfile:
        """Return the profile with wear added that is linear along each of some pieces.

        Each point takes ``int depth phi ds / spacing`` with its hat function phi, so that the area grows by exactly
        what is added.

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
        ramp = sum(_against_ramps(points, *piece) for piece in zip(ends, depth, strict=True))
        share = np.zeros(len(points))
        share[1:-1] = ramp[2:] - 2 * ramp[1:-1] + ramp[:-2]
        return WornProfile(self.spacing, wider.first, wider.depth + share)

    def _reaching(self, first: int, last: int) -> WornProfile:
        """The same profile with points from ``first`` to ``last`` at least."""
        before = max(0, self.first - first)
        after = max(0, last - (self.first + len(self.depth) - 1))
        return WornProfile(self.spacing, self.first - before, np.pad(self.depth, (before, after)))


def _against_ramps(points: Array, ends: Array, depth: Array) -> Array:
    """``int depth max(0, x_j - x) dx`` over a piece along which the depth is linear, for each point x_j."""
    (a, b), (start, end) = ends, depth
    reach = np.clip(points, a, b) - a
    slope = (end - start) / (b - a) if b > a else 0.0
    beyond = points - a
    return start * (beyond * reach - reach**2 / 2) + slope * (beyond * reach**2 / 2 - reach**3 / 3)
