"""A grid along the lines on which reference material flows past a slider: straight or circular tracks."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StreamGrid:
    """Rows along the track and columns across it; the material flows along the rows towards -x.

    In a section a row is a height y; in a solid it is a pair of an offset to the left of the track and a height z. A
    circular track runs through the origin along +x, counter-clockwise about (0, track radius); lengths along it
    are measured at the track's radius, and tensors turn with it.

    Parameters
    ----------
    columns : array, shape (n,)
        Lengths along the track, rising [mm].
    rows : tuple of 1 or 2 arrays
        Heights, or offsets and heights, rising [mm].
    track_radius : float
        [mm]; infinite for a straight track.
    """

    columns: Array
    rows: tuple[Array, ...]
    track_radius: float = math.inf

    @property
    def circular(self) -> bool:
        """Whether the track is a circle."""
        return math.isfinite(self.track_radius)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return math.prod(len(r) for r in self.rows), len(self.columns)

    @cached_property
    def places(self) -> Array:
        """Coordinates of the grid's points, shape (rows * columns, dim); columns run fastest [mm]."""
        across = np.array(list(itertools.product(*self.rows)))
        along = np.tile(self.columns, len(across))
        across = np.repeat(across, len(self.columns), axis=0)
        if not self.circular:
            return np.column_stack([along, across])
        angle, radius = along / self.track_radius, self.track_radius - across[:, 0]
        x, y = radius * np.sin(angle), self.track_radius - radius * np.cos(angle)
        return np.column_stack([x, y, across[:, 1:]])

    @cached_property
    def areas(self) -> Array:
        """Cross-section that belongs to each row, times its radius over the track's; shape (rows,) [mm, or mm²]."""
        widths = [_trapezoidal(r) for r in self.rows]
        if self.circular:
            widths[0] = widths[0] * (1 - self.rows[0] / self.track_radius)
        return np.prod(np.array(list(itertools.product(*widths))), axis=1)

    def tracked(self, places: Array) -> Array:
        """Length along the track and offsets across it of places of shape (..., dim); the same shape [mm]."""
        if not self.circular:
            return places
        up = self.track_radius - places[..., 1]
        along = self.track_radius * np.arctan2(places[..., 0], up)
        offset = self.track_radius - np.hypot(places[..., 0], up)
        return np.concatenate([along[..., None], offset[..., None], places[..., 2:]], axis=-1)

    def between(self, places: Array) -> csr_matrix:
        """Interpolation from half-way between the columns to places of shape (n, dim): linear, constant beyond."""
        tracked = self.tracked(places)
        middle = 0.5 * (self.columns[1:] + self.columns[:-1])
        axes = [*self.rows, middle]
        found = [_between(knots, tracked[:, (k + 1) % len(axes)]) for k, knots in enumerate(axes)]
        count, strides = len(tracked), [math.prod(len(a) for a in axes[k + 1 :]) for k in range(len(axes))]
        index, weight = np.zeros((0, count), dtype=int), np.zeros((0, count))
        for corner in itertools.product((0, 1), repeat=len(axes)):
            at = sum(s * (low + c) for s, c, (low, _) in zip(strides, corner, found, strict=True))
            share = math.prod(f if c else 1 - f for c, (_, f) in zip(corner, found, strict=True))
            index, weight = np.vstack([index, at]), np.vstack([weight, share])
        rows = np.tile(np.arange(count), len(index))
        return csr_matrix((weight.ravel(), (rows, index.ravel())), shape=(count, math.prod(len(a) for a in axes)))

    def turned(self, tensors: Array, places: Array, *, back: bool = False) -> Array:
        """Symmetric tensors, components in the last axis, in the track's axes at places; ``back``: from them.

        Off-diagonal components as they are (not doubled).
        """
        if not self.circular:
            return tensors
        angle = np.arctan2(places[..., 0], self.track_radius - places[..., 1])
        c, s = np.cos(angle), np.sin(angle) * (-1 if back else 1)
        xx, yy, zz, xy, xz, yz = np.moveaxis(tensors, -1, 0)
        both = 2 * c * s * xy
        return np.stack(
            [
                c * c * xx + s * s * yy + both,
                s * s * xx + c * c * yy - both,
                zz,
                c * s * (yy - xx) + (c * c - s * s) * xy,
                c * xz + s * yz,
                c * yz - s * xz,
            ],
            axis=-1,
        )


def _between(knots: Array, values: Array) -> tuple[NDArray[np.intp], Array]:
    """Index of the knot at or below each value, and how far it is on the way to the next."""
    index = np.clip(np.searchsorted(knots, values, side="right") - 1, 0, len(knots) - 2)
    share = (values - knots[index]) / (knots[index + 1] - knots[index])
    return index, np.clip(share, 0.0, 1.0)


def _trapezoidal(knots: Array) -> Array:
    gaps = np.diff(knots)
    return 0.5 * (np.append(gaps, 0.0) + np.insert(gaps, 0, 0.0))
