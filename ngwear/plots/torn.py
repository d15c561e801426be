"""Figures of a section that loses elements: its worn face, and one ridge of it, at the kept strokes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.geometry.cells import Fate
from ngwear.plots.sections import Box, living, lost, overlapping, polygons, sections, show, when, worn_face
from ngwear.plots.style import COLOURS, new_figure
from ngwear.profiles.worn_edge import seen, view

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ngwear.results.result_file import ResultFile, Snapshot

Array = NDArray[np.float64]

RUBBER, WORN_AWAY = "#b9cfe0", "0.87"
# In the order in which they are drawn: what is still there covers what it has moved over.
LOST = (
    (Fate.TORN, "torn", "#222222"),
    (Fate.DISTORTED, "too distorted", "#d98324"),
    (Fate.LOOSE, "come loose", "#7f5fa8"),
)
STATIONS = 2001  # along the face: more than pixels
RIDGE = 16  # elements' sides: how wide the window on a ridge is; single elements are seen
WIDEST, LEAST = 9.6, 0.6  # inches: of the panels of a figure, and the least height of one


def face_figure(result: ResultFile) -> Figure:
    """The section's face at each kept stroke without what it has lost, and the depth that a profilometer would see."""
    kept, window = sections(result), worn_face(result)
    wide, high = window[1] - window[0]
    height = min(max(WIDEST * high / wide, LEAST), 4.0)
    place, depths, axis = _depths(result, kept)
    shallow = _shallow(depths[-1])
    heights = (*[height] * len(kept), *[2.8 if shallow is None else 2.2] * (1 if shallow is None else 2))
    figure, axes = new_figure(len(heights), heights, size=(10, sum(heights) + 0.3 * len(heights) + 1.2))
    from matplotlib.collections import PolyCollection

    unworn = np.vstack([kept[0].outline, kept[0].outline[:1]])
    for panel, snapshot in zip(axes, kept, strict=False):
        shapes, _ = living(snapshot)
        panel.add_collection(PolyCollection(shapes, facecolor=RUBBER, edgecolor="face", lw=0.6, label="rubber"))
        closed = np.vstack([snapshot.outline, snapshot.outline[:1]])
        panel.plot(*closed.T, color=COLOURS[0], lw=1.0)
        panel.plot(*unworn.T, color="0.4", lw=0.7, ls=":")
        show(panel, window)
        panel.set_title(when(result, snapshot), loc="left", fontsize=10)
        panel.set_ylabel("y [mm]")
    for panel in axes[len(kept) :]:
        for colour, snapshot, depth in zip(_shades(len(kept)), kept, depths, strict=True):
            if snapshot.stroke > 0:
                panel.plot(place, 1e3 * depth, color=colour, lw=1.2, label=when(result, snapshot))
        panel.set_ylim(bottom=0)
        panel.invert_yaxis()
        panel.set_ylabel("worn depth [µm]")
    if shallow is not None:
        axes[-2].set_ylim(1e3 * shallow, 0)
        axes[-2].set_title("worn depth, cut off where elements are lost", loc="left", fontsize=10)
        axes[-1].set_title("the whole depth", loc="left", fontsize=10)
    if axis == "x":
        axes[-1].set_xlim(window[0][0], window[1][0])
    axes[-1].set_xlabel(f"{axis} [mm]")
    if len(kept) > 1:
        axes[-1].legend(ncols=min(len(kept) - 1, 5), loc="upper center", bbox_to_anchor=(0.5, -0.2), frameon=False)
    figure.suptitle(f"{result.scene}: worn face, unloaded (dotted: new)", fontsize=12)
    return figure


def _depths(result: ResultFile, kept: list[Snapshot]) -> tuple[Array, list[Array], str]:
    """Places along the face, how far what shows from outside lies below the new face there, and the axis' name."""
    on = np.isin(result.edges, result.worn_edges)
    direction, outward, axis = view(result.outline, on)
    along = result.outline[on | np.roll(on, 1)] @ direction
    place = np.linspace(along.min(), along.max(), STATIONS)
    heights = [seen(s.outline @ direction, s.outline @ outward, place) for s in kept]
    return place, [heights[0] - height for height in heights], axis


def _shallow(depth: Array) -> float | None:
    """Up to where to show the wear beside narrow gaps that are far deeper [mm]; None where there are none."""
    worn = depth[depth > 1e-3 * np.nanmax(depth, initial=0.0)]
    if not len(worn):
        return None
    most = 1.6 * float(np.percentile(worn, 90))
    return most if worn.max() > 2 * most else None


def _shades(n: int) -> list[tuple[float, float, float, float]]:
    """From light to dark, one for each kept stroke."""
    from matplotlib import colormaps

    return [colormaps["viridis_r"](x) for x in np.linspace(0.12, 1.0, n)]


def ridge_figure(result: ResultFile) -> Figure:
    """One ridge at each saved stroke: remaining elements, and the others by cause of loss."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    kept = sections(result)
    window = ridge_window(result)
    columns = min(len(kept), 6)
    rows = -(-len(kept) // columns)
    side = min(2.9, 14.0 / columns)
    figure = Figure(figsize=(side * columns + 0.8, (side + 0.45) * rows + 1.1), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    legend: dict[str, Any] = {}
    for panel, snapshot in zip(axes.flat, kept, strict=False):
        draw_elements(panel, kept[0], snapshot, window)
        legend |= {c.get_label(): c for c in panel.collections if len(c.get_paths())}
        show(panel, window)
        panel.set_title(when(result, snapshot), fontsize=10)
    for panel in axes.flat[len(kept) :]:
        panel.set_visible(False)
    for panel in axes[-1]:
        panel.set_xlabel("x [mm]")
        panel.locator_params(nbins=4)
    for panel in axes[:, 0]:
        panel.set_ylabel("y [mm]")
    names = [name for name in ("rubber", *(row[1] for row in LOST), "worn away") if name in legend]
    figure.legend([legend[name] for name in names], names, loc="outside lower center", ncols=len(names), frameon=False)
    figure.suptitle(f"{result.scene}: elements where most are lost, unloaded", fontsize=12)
    return figure


def draw_elements(axes: Axes, first: Snapshot, now: Snapshot, window: Box) -> None:
    """Elements that reach into a window: the lost ones where they were when new, the living ones where they are."""
    from matplotlib.collections import PolyCollection

    def add(shapes: list[Array], label: str, colour: str, edge: str, width: float) -> None:
        shapes = [s for s, inside in zip(shapes, overlapping(shapes, window), strict=True) if inside]
        axes.add_collection(PolyCollection(shapes, facecolor=colour, edgecolor=edge, lw=width, label=label))

    gone = [fate for fate, *_ in LOST]
    others = ~np.isin(now.elements["fate"], gone)
    new = polygons(first.elements["points [mm]"], first.elements["corners"][others])
    add(new, "worn away", WORN_AWAY, "face", 0.3)
    for fate, label, colour in LOST:
        add(lost(first, now, fate), label, colour, "0.55", 0.4)
    add(living(now)[0], "rubber", "white", "0.35", 0.4)


def ridge_window(result: ResultFile) -> Box:
    """Square window where most elements have been torn in the end, else lost otherwise, else where it is worn most."""
    kept = sections(result)
    first, last = kept[0], kept[-1]
    points, corners, fate = (first.elements["points [mm]"], first.elements["corners"], last.elements["fate"])
    quads = [s for s in polygons(points, corners) if len(s) == 4]
    side = float(np.median([np.linalg.norm(s - np.roll(s, 1, axis=0), axis=1).mean() for s in quads]))
    causes = (fate == Fate.TORN, np.isin(fate, (Fate.DISTORTED, Fate.LOOSE)))
    lost_most = next((gone for gone in causes if gone.any()), None)
    if lost_most is not None:
        middles = np.array([s.mean(axis=0) for s in polygons(points, corners[lost_most])])
        near = np.linalg.norm(middles[:, None] - middles, axis=-1) < 0.5 * RIDGE * side
        group = middles[near[near.sum(axis=1).argmax()]]
        centre, extent = 0.5 * (group.min(axis=0) + group.max(axis=0)), float(np.ptp(group, axis=0).max())
    else:
        from shapely import LinearRing, distance
        from shapely import points as dots

        depth = distance(dots(first.outline), LinearRing(last.outline))
        centre, extent = first.outline[depth.argmax()], float(depth.max())
    on = np.isin(result.edges, result.worn_edges)
    _, outward, _ = view(result.outline, on)
    half = 0.5 * max(RIDGE * side, 1.6 * extent)
    # What is left of the ridge lies behind what it has lost: the window begins just before the new face.
    across = np.array([-outward[1], outward[0]])
    near = np.abs((first.outline - centre) @ across) < half
    near &= np.linalg.norm(first.outline - centre, axis=1) < 3 * half
    ahead = max(((first.outline[near] - centre) @ outward).max(initial=0.0), 0.0) + 1.5 * side
    centre = centre + (ahead - half) * outward
    return centre - half, centre + half
