"""Two runs of the same outline side by side: worn depth and contact pressure."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import ResultError
from ngwear.plots.contact_pressures import line_over_x
from ngwear.plots.style import COLOURS, write
from ngwear.results.result_file import ResultFile, Snapshot, read_result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]


def compare(folder: Path | str, other: Path | str) -> Path:
    """Draw a run against another into ``comparison.png`` in its folder; return the path.

    Raises
    ------
    ResultError
        If a result cannot be read, the runs are of different outlines, or the picture cannot be written.
    """
    import matplotlib

    first, second = read_result(folder), read_result(other)
    if first.outline.shape != second.outline.shape or not np.allclose(first.outline, second.outline):
        raise ResultError(f"{folder} and {other} are runs of different outlines: their depths cannot be compared")
    path = Path(folder) / "comparison.png"
    with matplotlib.rc_context({"font.size": 10, "axes.grid": True, "grid.alpha": 0.3}):
        figure = comparison_figure(first, second)
        write(figure, path)
    return path


def comparison_figure(first: ResultFile, second: ResultFile) -> Figure:
    """Final depth of both along the outline, its difference, and the last pressures of each kind of stroke."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    kinds = first.kinds
    figure = Figure(figsize=(10, 3 * (2 + len(kinds))), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(2 + len(kinds), 1)
    worn = [_depth(result.outline, result.snapshots[-1].outline) for result in (first, second)]
    touched = np.flatnonzero(np.maximum(*worn) > 0.02 * np.max(worn))
    x = first.outline[touched, 0]
    order = np.argsort(x)
    for depth, colour, result in zip(worn, COLOURS, (first, second), strict=False):
        axes[0].plot(x[order], 1e3 * depth[touched][order], ".", color=colour, ms=3, label=result.scene)
    axes[0].set_ylabel("worn depth [µm]")
    axes[0].set_title(f"{first.scene} against {second.scene}: after {first.snapshots[-1].stroke} strokes")
    axes[1].plot(x[order], 1e3 * (worn[0] - worn[1])[touched][order], ".", color="k", ms=3)
    axes[1].set_ylabel("difference [µm]")
    axes[1].set_xlabel("x on the unloaded outline [mm]")
    for panel, kind in zip(axes[2:], kinds, strict=True):
        for result, colour in zip((first, second), COLOURS, strict=False):
            mine = [s for s in result.snapshots if s.kind == kind]
            for snapshot, style in ((_first_worn(mine), "--"), (mine[-1], "-")):
                for profile in snapshot.profiles.values():
                    place, p = line_over_x(profile["place [mm]"], profile["pressure [MPa]"])
                    label = f"{result.scene}, {'first' if style == '--' else 'last'}"
                    panel.plot(place, p, style, color=colour, lw=0.9, label=label)
        panel.set_ylabel(f"{kind}: pressure [MPa]")
        panel.set_ylim(bottom=0)
    axes[-1].set_xlabel("x [mm]")
    axes[0].legend()
    axes[2].legend()
    return figure


def _first_worn(snapshots: list[Snapshot]) -> Snapshot:
    """The first stroke that wears; the states before it are solved without the history of sliding."""
    return next((s for s in snapshots if s.stroke > 0), snapshots[0])


def _depth(before: Array, after: Array) -> Array:
    """Distance of each point of an outline from the worn one [mm]."""
    from shapely import LinearRing, distance, points

    return np.asarray(distance(points(before), LinearRing(after)))
