"""The outline of a section: a closed polygon of named pieces, smoothed by cubic splines between corners."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import GeometryError

Array = NDArray[np.float64]
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9 _-]*")


def polygon_area(points: Array) -> float:
    """Area of a closed polygon, points of shape (n, 2), positive if it runs counter-clockwise [mm²]."""
    # Cross products with the segments add up to the area; with the next points they would cancel, and round.
    x, y = (points - points[0]).T
    dx, dy = (np.roll(points, -1, axis=0) - points).T
    return float(0.5 * (x @ dy - y @ dx))


def polygon_moment(points: Array) -> float:
    """First moment ``int y dA`` of a closed polygon, points of shape (n, 2) [mm³]; 2 pi times it is a ring's volume."""
    x, y = (points - points[0]).T
    dx, dy = (np.roll(points, -1, axis=0) - points).T
    height = points[:, 1] + 0.5 * dy + 0.5 * points[0, 1]  # 3/2 of the middle of each triangle with the first point
    return float(((x * dy - y * dx) * height).sum() / 3)


@dataclass(frozen=True)
class Outline:
    """A closed, counter-clockwise outline; area and worn area are those of its polygon.

    Segment i runs from point i to point i + 1 (the last one closes the outline). A *contour
    parameter* t is a float index: t = 3.5 lies in the middle of segment 3 on the spline.

    Parameters
    ----------
    points : array, shape (n, 2)
        Coordinates [mm]; (axial, radial) in an axisymmetric scene.
    names : tuple of str, length n
        Name of each segment's edge; segments may share one.
    corners : array of bool, shape (n,)
        Points where the tangent may jump; between corners the outline is a C2 spline over the chord length.
    provenance : str
        Where the outline comes from.

    Raises
    ------
    GeometryError
        If it is clockwise, touches or crosses itself, repeats a point, or an edge is unnamed.
    """

    points: Array
    names: tuple[str, ...]
    corners: NDArray[np.bool_]
    provenance: str = ""

    def __post_init__(self) -> None:
        points = np.ascontiguousarray(self.points, dtype=float)
        if points.ndim != 2 or points.shape[1:] != (2,) or len(points) < 3:
            raise GeometryError(f"a contour needs at least 3 points (x, y), found an array of shape {points.shape}")
        if not np.isfinite(points).all():
            bad = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
            raise GeometryError(f"contour point {bad} is {points[bad].tolist()}: coordinates must be finite")
        if len(self.names) != len(points) or len(self.corners) != len(points):
            raise GeometryError("a contour needs one edge name and one corner flag for each point")
        for i, name in enumerate(self.names):
            if not _NAME.fullmatch(name):
                raise GeometryError(
                    f"the edge that starts at contour point {i} {tuple(points[i])} has the name {name!r}: name every "
                    "edge with letters, digits, blanks, - or _"
                )
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "corners", np.asarray(self.corners, dtype=bool))
        lengths = self.lengths
        if (lengths <= 1e-9 * lengths.sum()).any():
            bad = int(np.argmin(lengths))
            raise GeometryError(
                f"contour points {bad} and {(bad + 1) % len(points)} coincide at {points[bad].tolist()}"
            )
        if self.area < 0:
            raise GeometryError("the contour runs clockwise: reverse the order of its points and edges")
        self._require_simple()

    def _require_simple(self) -> None:
        turning = self.turning
        if turning.min() > -1e-9 and abs(turning.sum() - 2 * np.pi) < 1e-6:  # convex but for rounding: cannot cross
            return
        from shapely import Polygon  # takes time to load
        from shapely.validation import explain_validity

        polygon = Polygon(self.points)
        if not polygon.is_valid:
            raise GeometryError(f"the contour crosses or touches itself: {explain_validity(polygon)}")

    def __len__(self) -> int:
        return len(self.points)

    @classmethod
    def read(cls, path: Path | str) -> Outline:
        """Read an outline from a ``.toml``, ``.csv``, ``.step`` or ``.stp`` file.

        Raises
        ------
        GeometryError
            If the file cannot be read or its outline is not simple, closed and counter-clockwise.
        """
        from ngwear.geometry.outline_files import read_drawing  # the libraries of file formats take time to load

        try:
            return cls(*read_drawing(Path(path)))
        except GeometryError as error:
            raise GeometryError(f"{path}: {error}") from None

    def write(self, path: Path | str) -> None:
        """Write the outline to a ``.toml`` file, from which ``read`` gives it back to the last digit.

        Raises
        ------
        GeometryError
            If the file cannot be written.
        """
        from ngwear.geometry.outline_files import Drawing, write_drawing

        write_drawing(Drawing(self.points, self.names, self.corners, self.provenance), Path(path))

    @classmethod
    def rectangle(cls, x: tuple[float, float], y: tuple[float, float]) -> Outline:
        """Rectangle with the edges bottom, right, top and left."""
        corners = np.array([[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]])
        return cls(corners, ("bottom", "right", "top", "left"), np.ones(4, dtype=bool))

    @cached_property
    def lengths(self) -> Array:
        """Chord length of each segment [mm], shape (n,)."""
        return np.linalg.norm(np.roll(self.points, -1, axis=0) - self.points, axis=1)

    @cached_property
    def area(self) -> float:
        """Area of the polygon [mm²]."""
        return polygon_area(self.points)

    @cached_property
    def turning(self) -> Array:
        """Angle by which the polygon turns at each point [rad], positive where convex, shape (n,)."""
        ahead = np.roll(self.points, -1, axis=0) - self.points
        angle = np.arctan2(ahead[:, 1], ahead[:, 0])
        return (angle - np.roll(angle, 1) + np.pi) % (2 * np.pi) - np.pi

    @property
    def edge_names(self) -> tuple[str, ...]:
        """The different edge names in the order in which they appear."""
        return tuple(dict.fromkeys(self.names))

    def widths(self, edges: tuple[str, ...] | None = None) -> Array:
        """Half the sum of both segments' lengths at each point [mm], counting named edges only; 1 outside them."""
        half = 0.5 * self.lengths * (1.0 if edges is None else self.on(edges))
        width = half + np.roll(half, 1)
        return np.where(width > 0, width, 1.0)

    def on(self, edges: Sequence[str]) -> NDArray[np.bool_]:
        """Return which segments belong to the named edges, shape (n,)."""
        return np.array([name in edges for name in self.names])

    def runs(self) -> list[NDArray[np.intp]]:
        """Point indices of the smooth stretches from corner to corner; one closed run if there is no corner."""
        n = len(self)
        corner = np.flatnonzero(self.corners)
        if len(corner) == 0:
            return [np.arange(n + 1) % n]
        ends = np.append(corner[1:], corner[0] + n)
        return [np.arange(a, b + 1) % n for a, b in zip(corner, ends, strict=True)]

    def controls(self, values: Array) -> Array:
        """Cubic Bezier control values of every segment for data given at the points.

        The data are joined by a C2 cubic spline over the chord length of each smooth run (periodic for a
        closed one). The map is linear in the data: a displacement's controls add to the outline's own.

        Parameters
        ----------
        values : array, shape (n, m)

        Returns
        -------
        array, shape (n, 4, m)
        """
        out = np.empty((len(self), 4, values.shape[1]))
        for run in self.runs():
            length = self.lengths[run[:-1]]
            knots = np.concatenate([[0.0], np.cumsum(length)])
            data = values[run]
            straight = data[0] + (knots / knots[-1])[:, None] * (data[-1] - data[0])
            if np.abs(data - straight).max() <= 1e-12 * knots[-1]:
                slope = np.repeat((data[-1:] - data[:1]) / knots[-1], len(run), axis=0)
            else:
                from scipy.interpolate import CubicSpline

                closed = not self.corners.any()
                slope = CubicSpline(knots, data, bc_type="periodic" if closed else "not-a-knot")(knots, 1)
            third = length[:, None] / 3
            out[run[:-1]] = np.stack(
                [data[:-1], data[:-1] + third * slope[:-1], data[1:] - third * slope[1:], data[1:]], axis=1
            )
        return out

    @cached_property
    def bezier(self) -> Array:
        """Control points of the outline's segments, shape (n, 4, 2)."""
        return self.controls(self.points)

    def at(self, t: Any, controls: Array | None = None) -> Array:
        """Evaluate the outline, or data with ``controls``, at contour parameters t; shape (len(t), m)."""
        t = np.atleast_1d(np.asarray(t, dtype=float))
        segment = np.floor(t).astype(int)
        if controls is None and (t == segment).all():
            return self.points[segment % len(self)]  # no spline is needed
        control = self.bezier if controls is None else controls
        s = (t - segment)[:, None]
        b = control[segment % len(self)]
        r = 1 - s
        return r**3 * b[:, 0] + 3 * r * r * s * b[:, 1] + 3 * r * s * s * b[:, 2] + s**3 * b[:, 3]

    def on_polygon(self, t: Array) -> Array:
        """Points of the polygon at contour parameters t; shape (len(t), 2)."""
        low = np.floor(t).astype(int)
        s = (t - low)[:, None]
        return (1 - s) * self.points[low % len(self)] + s * self.points[(low + 1) % len(self)]

    def slopes(self, t: Any) -> Array:
        """Derivative of the outline with respect to t; shape (len(t), 2)."""
        t = np.atleast_1d(np.asarray(t, dtype=float))
        segment = np.floor(t).astype(int)
        s = (t - segment)[:, None]
        d = 3 * np.diff(self.bezier, axis=1)[segment % len(self)]
        return (1 - s) ** 2 * d[:, 0] + 2 * (1 - s) * s * d[:, 1] + s**2 * d[:, 2]

    def arc_lengths(self, start: Array, end: Array) -> Array:
        """Length of the outline between contour parameters less than one segment apart, or chordwise beyond [mm]."""
        nodes, weights = np.polynomial.legendre.leggauss(3)
        middle, half = 0.5 * (start + end), 0.5 * (end - start)
        within = np.floor(start + 1e-9) >= np.ceil(end - 1e-9) - 1
        chord = np.linalg.norm(self.at(end) - self.at(start), axis=1)
        arc = sum(
            w * np.linalg.norm(self.slopes(middle + half * x), axis=1) * half
            for x, w in zip(nodes, weights, strict=True)
        )
        return np.where(within, arc, chord)

    def moved(self, displacement: Array) -> Outline:
        """Return the outline with its points displaced, shape (n, 2); names and corners stay."""
        return replace(self, points=self.points + displacement)

    def inserted(self, t: Array, *, on_chord: bool = False) -> Outline:
        """Return the outline with points added at the (non-integer) parameters t.

        They lie on the spline, or on the polygon (``on_chord``), whose area then stays exactly the same.
        """
        t = np.sort(np.asarray(t, dtype=float) % len(self))  # without np.unique, which loads masked arrays
        t = t[t != np.floor(t)]
        if len(t) == 0:
            return self
        t = t[np.append(True, t[1:] > t[:-1])]
        at = np.floor(t).astype(int) + 1
        segment = at - 1
        return replace(
            self,
            points=np.insert(self.points, at, self.on_polygon(t) if on_chord else self.at(t), axis=0),
            names=tuple(np.insert(np.array(self.names, dtype=object), at, np.array(self.names, dtype=object)[segment])),
            corners=np.insert(self.corners, at, False),
        )

    def without(self, drop: NDArray[np.bool_]) -> Outline:
        """Return the outline without the marked points, shape (n,)."""
        keep = ~drop
        return replace(
            self,
            points=self.points[keep],
            names=tuple(name for name, k in zip(self.names, keep, strict=True) if k),
            corners=self.corners[keep],
        )
