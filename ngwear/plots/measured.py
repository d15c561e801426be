"""Figure of a measured profile beside a run's outline."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ngwear.errors import ResultError
from ngwear.plots.wear import COLOURS
from ngwear.profiles.comparison import Comparison

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_measured(comparison: Comparison, folder: Path | str) -> Path:
    """Draw a comparison into ``measured.png`` in a folder; return the path.

    Raises
    ------
    ResultError
        If the picture cannot be written.
    """
    import matplotlib

    path = Path(folder) / "measured.png"
    with matplotlib.rc_context({"font.size": 10, "axes.grid": True, "grid.alpha": 0.3}):
        figure = measured_figure(comparison)
        try:
            figure.savefig(path, dpi=150)
        except OSError as error:
            raise ResultError(f"{path} cannot be written: {error.strerror}") from error
    return path


def measured_figure(comparison: Comparison) -> Figure:
    """Heights, worn depths with their areas, and deviations, over the place along the edge."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    edge, found = comparison.edge, comparison.alignment
    best = min(found.distance, edge.end)
    place, axis = found.place, edge.axis if edge.axis not in "xy" else f"{edge.axis} on the unloaded outline"
    blue, red, green = COLOURS[:3]
    figure = Figure(figsize=(10, 10), layout="constrained")
    FigureCanvasAgg(figure)
    outline, depth, deviation = figure.subplots(3, 1, sharex=True, height_ratios=(1, 1.2, 1))
    near = (edge.place >= place[0]) & (edge.place <= place[-1])
    outline.plot(edge.place[near], edge.heights[0, near], "--", color="0.5", lw=1.2, label="unworn")
    outline.plot(place, found.height, ".", color=red, ms=2.5, label="measured, aligned")
    outline.plot(edge.place[near], edge.at(comparison.compared)[near], color=blue, lw=1.2, label="simulated")
    outline.set_ylabel("height out of the material [mm]")
    outline.set_title(
        f"{edge.scene}: measured profile and outline after {edge.strokes_at(comparison.compared):.4g} strokes"
    )
    outline.legend()

    measured = comparison.measured_depth
    simulated, fitted = comparison.depth(comparison.compared), comparison.depth(best)

    def area(values: np.ndarray) -> str:
        return f"{comparison.area(values):.4g} mm²"

    depth.plot(place, 1e3 * measured, ".", color=red, ms=2.5, label=f"measured: {area(measured)}")
    depth.plot(place, 1e3 * simulated, color=blue, lw=1.4, label=f"simulated: {area(simulated)}")
    strokes = edge.strokes_at(best)
    label = "run's end" if comparison.beyond else "best fit"
    depth.plot(place, 1e3 * fitted, "--", color=green, lw=1.4, label=f"{label}, {strokes:.4g} strokes: {area(fitted)}")
    depth.fill_between(place, 0, 1e3 * simulated, color=blue, alpha=0.12, lw=0)
    depth.invert_yaxis()
    depth.set_ylabel("worn depth [µm]")
    depth.legend(title="worn area")

    for values, colour, name in ((simulated, blue, "simulated"), (fitted, green, label)):
        off = 1e3 * (values - measured)
        rms, worst = np.sqrt(np.mean(off**2)), np.abs(off).max()
        deviation.plot(place, off, ".", color=colour, ms=2.5, label=f"{name}: RMS {rms:.3g} µm, largest {worst:.3g} µm")
    deviation.axhline(0, color="k", lw=0.8)
    deviation.set_ylabel("height, measured less simulated [µm]")
    deviation.set_xlabel(f"{axis} [mm]")
    deviation.margins(y=0.3)
    deviation.legend(loc="upper center", ncols=2)
    return figure
