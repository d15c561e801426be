"""The unloaded outline of a worn edge as a profilometer would see it, at every saved stroke of a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from ngwear.errors import ResultError, SceneError
from ngwear.results.result_file import ResultFile, read_result

Array = NDArray[np.float64]
STATIONS = 4001  # along the edge: as many as a profilometer takes
ALIGNED = np.radians(15.0)  # an edge less inclined is looked at along the scene's axis; depths differ by 4 % at most
FAR = 10.0  # of the run's sliding distance: how far the fit may look beyond its end; only to say that it ran too short
HIDDEN = 0.02  # of the edges' length that another part of the outline may hide: rounding at their ends, no more


@dataclass(frozen=True)
class WornEdge:
    """Heights of a worn edge over sliding distance.

    Attributes
    ----------
    scene, axis : str
        The axis is the scene's ``"x"`` or ``"y"``, or ``"along the edge"`` for an inclined one.
    place : array, shape (m,)
        Places along the axis, evenly spaced [mm].
    heights : array, shape (n, m)
        Outermost height over each place, out of the material, unloaded [mm].
    distance, strokes : array, shape (n,)
        Sliding distance [mm], rising from 0, and strokes done.
    wear_rates : dict
        Specific wear rate k of each contact that wears in the run [mm²/N].
    has_memory : bool
        Whether the run's rubber has memory.
    laws_vary : bool
        Whether friction or the wear rate changed with the sliding distance.
    """

    scene: str
    axis: str
    place: Array
    heights: Array
    distance: Array
    strokes: Array
    wear_rates: dict[str, float]
    has_memory: bool
    laws_vary: bool

    @property
    def end(self) -> float:
        """The run's sliding distance [mm]."""
        return float(self.distance[-1])

    @property
    def length(self) -> float:
        """Of the edge along the axis [mm]."""
        return float(self.place[-1] - self.place[0])

    @cached_property
    def _over_distance(self) -> PchipInterpolator:
        far = self.heights[0] + FAR * (self.heights[-1] - self.heights[0])
        return PchipInterpolator(np.append(self.distance, FAR * self.end), np.vstack([self.heights, far]))

    def at(self, distance: float) -> Array:
        """Heights after a sliding distance [mm], shape (m,), by monotone cubics between the kept strokes.

        Beyond the run's end the wear grows in proportion: an extrapolation, used to detect that the run is too short.
        """
        return np.asarray(self._over_distance(distance))

    def strokes_at(self, distance: float) -> float:
        """Strokes after a sliding distance [mm]; beyond the end in proportion."""
        if distance > self.end:
            return float(self.strokes[-1] * distance / self.end)
        return float(np.interp(distance, self.distance, self.strokes))

    def distance_at(self, strokes: float) -> float:
        """Sliding distance [mm] after some strokes; beyond the end in proportion."""
        if strokes > self.strokes[-1]:
            return self.end * strokes / float(self.strokes[-1])
        return float(np.interp(strokes, self.strokes, self.distance))


def read_worn_edge(folder: Path | str, *, edges: Sequence[str] = ()) -> WornEdge:
    """Read a run's worn edge from its folder.

    Parameters
    ----------
    folder : Path or str
    edges : sequence of str
        Which part of the outline was measured, from the first of these edges to the last; by default all that wear.

    Raises
    ------
    ResultError
        If the result cannot be read, or nothing has worn.
    SceneError
        If the outline has no such edge, or the edges are hidden behind others.
    """
    result = read_result(folder)
    if not result.wear_rates or not result.snapshots or result.snapshots[-1].stroke == 0:
        raise ResultError(f"{folder}: nothing has worn in this run, or its wear rates were not saved: run it again")
    on = _on(result, edges or result.worn_edges)
    direction, outward, axis = view(result.outline, on)
    ends = np.concatenate([result.outline[on], np.roll(result.outline, -1, axis=0)[on]]) @ direction
    place = np.linspace(ends.min(), ends.max(), STATIONS)
    kept = {s.stroke: (d, s) for d, s in zip(result.series["sliding distance [mm]"], result.snapshots, strict=True)}
    heights = np.array([seen(s.outline @ direction, s.outline @ outward, place) for _, s in kept.values()])
    own = seen(result.outline @ direction, result.outline @ outward, place, on)
    hidden = seen(result.outline @ direction, result.outline @ outward, place) - own > HIDDEN * np.ptp(ends)
    if hidden.sum() > HIDDEN * np.isfinite(own).sum():
        raise SceneError("edges", list(edges or result.worn_edges), "another part of the outline lies in front of them")
    whole = np.isfinite(heights).all(axis=0)
    return WornEdge(
        scene=result.scene,
        axis=axis,
        place=place[whole],
        heights=heights[:, whole],
        distance=np.array([d for d, _ in kept.values()]),
        strokes=np.array(list(kept), dtype=float),
        wear_rates=result.wear_rates,
        has_memory=result.has_memory,
        laws_vary=result.laws_vary,
    )


def _on(result: ResultFile, edges: Sequence[str]) -> NDArray[np.bool_]:
    for edge in edges:
        if edge not in result.edges:
            raise SceneError("edges", edge, f"the outline has no such edge; it has {list(dict.fromkeys(result.edges))}")
    return np.array([name in edges for name in result.edges])


def view(outline: Array, on: NDArray[np.bool_]) -> tuple[Array, Array, str]:
    """Unit vectors along the edges and out of the material, and the axis' name."""
    x, y = (np.roll(outline, -1, axis=0) - outline)[on].sum(axis=0)
    angle = np.arctan2(-x, y)  # of the outward normal: the outline runs counter-clockwise
    nearest = np.round(angle / (np.pi / 2)) * np.pi / 2
    aligned = abs(angle - nearest) < ALIGNED
    angle = nearest if aligned else angle
    outward = np.round([np.cos(angle), np.sin(angle)], 15)
    direction = np.array([abs(outward[1]), -outward[0] * np.sign(outward[1])]) if outward[1] else np.array([0.0, 1.0])
    axis = ("x" if outward[1] else "y") if aligned else "along the edge"
    return direction, outward, axis


def seen(along: Array, height: Array, place: Array, on: NDArray[np.bool_] | None = None) -> Array:
    """Outermost height of a closed polygon, or of some of its segments, over each place; NaN where there is none."""
    top = np.full(len(place), -np.inf)
    ends, tops = np.roll(along, -1), np.roll(height, -1)
    low = np.searchsorted(place, np.minimum(along, ends) - 1e-12)
    high = np.searchsorted(place, np.maximum(along, ends) + 1e-12)
    for i in np.flatnonzero((high > low) if on is None else (high > low) & on):
        part = slice(low[i], high[i])
        run = ends[i] - along[i]
        if abs(run) > 1e-12:
            here = height[i] + np.clip((place[part] - along[i]) / run, 0, 1) * (tops[i] - height[i])
        else:
            here = max(height[i], tops[i])
        top[part] = np.maximum(top[part], here)
    return np.where(np.isfinite(top), top, np.nan)
