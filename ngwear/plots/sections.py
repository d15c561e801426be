"""Shared by the figures of a section of elements: polygons, windows, and titles of saved strokes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ngwear.geometry.cells import Fate

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ngwear.results.result_file import ResultFile, Snapshot

Array = NDArray[np.float64]
Box = tuple[Array, Array]

TIMES = ((3 * 3600.0, 3600.0, "h"), (300.0, 60.0, "min"), (0.0, 1.0, "s"))  # runs from how long on, in which unit
ROD = "0.75"
MARGIN = 0.025  # of the worn face's length, around it


def sections(result: ResultFile) -> list[Snapshot]:
    """The latest snapshot that holds the elements, of each stroke that keeps them."""
    return list({s.stroke: s for s in result.snapshots if s.elements}.values())


def when(result: ResultFile, snapshot: Snapshot) -> str:
    """Title for a kept stroke: by time if all strokes have a speed, else by strokes and sliding distance."""
    if snapshot.stroke == 0:
        return "new"
    end = result.snapshots[-1].time
    if math.isfinite(end):
        _, unit, name = next(row for row in TIMES if end >= row[0])
        return f"after {snapshot.time / unit:.3g} {name}"
    slid = result.series["sliding distance [mm]"][result.series["stroke [-]"] == snapshot.stroke][0]
    return f"after {snapshot.stroke} strokes, {slid / 1e3:.3g} m"


def polygons(points: Array, corners: NDArray[np.intp]) -> list[Array]:
    """Corners of each element, shapes (3, 2) and (4, 2)."""
    return [points[row[row >= 0]] for row in corners]


def living(snapshot: Snapshot, *, deformed: bool = False) -> tuple[list[Array], NDArray[np.intp]]:
    """Polygons of the elements that are still there, and their numbers."""
    elements = snapshot.elements
    points = elements["points [mm]"]
    if deformed:
        points = points + elements["displacement [mm]"]
    numbers = np.flatnonzero(elements["fate"] == Fate.LIVING)
    return polygons(points, elements["corners"][numbers]), numbers


def lost(first: Snapshot, now: Snapshot, fate: Fate) -> list[Array]:
    """Polygons of the elements with a state, each as it was when new: its points may have worn since."""
    return polygons(first.elements["points [mm]"], first.elements["corners"][now.elements["fate"] == fate])


def box(points: Array, margin: float | Array) -> Box:
    """Lower left and upper right corner around points; the margin [mm] is the same, or one for x and one for y."""
    return points.min(axis=0) - margin, points.max(axis=0) + margin


def overlapping(shapes: list[Array], window: Box) -> NDArray[np.bool_]:
    """Which polygons reach into a window."""
    low, high = window
    return np.array([bool((s.max(axis=0) > low).all() and (s.min(axis=0) < high).all()) for s in shapes], dtype=bool)


def worn_face(result: ResultFile) -> Box:
    """Window on the edges that wear and on all that is lost behind them, unloaded."""
    on = np.isin(result.edges, result.worn_edges)
    face = result.outline[on | np.roll(on, 1)]
    kept = sections(result)
    if kept:
        gone = kept[-1].elements["fate"] != Fate.LIVING
        face = np.vstack([face, *polygons(kept[0].elements["points [mm]"], kept[0].elements["corners"][gone])])
    return box(face, MARGIN * float(np.ptp(face, axis=0).max()))


def show(axes: Axes, window: Box, *, frame: bool = True) -> None:
    """Let a panel show a window at equal scale, without a grid."""
    (left, low), (right, high) = window
    axes.set_xlim(left, right)
    axes.set_ylim(low, high)
    axes.set_aspect("equal", adjustable="box")
    axes.grid(visible=False)
    axes.set_frame_on(frame)


def draw_planes(axes: Axes, snapshot: Snapshot, thickness: float) -> None:
    """Counter-surfaces that are level planes, as grey bars of a thickness [mm]; others are left out."""
    for profile in snapshot.profiles.values():
        height, gap = profile["place [mm]"][:, 1], profile["gap [mm]"]
        for side in (-1.0, 1.0):  # below the rubber or above it
            levels = height + side * gap
            level = float(levels[np.argmin(gap)])
            if np.ptp(levels) < 1e-9 * max(abs(level), 1.0):
                axes.axhspan(*sorted((level, level + side * thickness)), color=ROD, lw=0)
                break
