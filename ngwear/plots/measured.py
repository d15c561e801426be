"""Figure of a measured profile beside a run's outline."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ngwear.plots.style import COLOURS, write
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
        write(figure, path)
    return path


def measured_figure(comparison: Comparison) -> Figure:
    """Heights, worn depths with their areas, and deviations, over the place along the edge."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    edge, found = comparison.edge, comparison.alignment
    place, axis = found.place, edge.axis if edge.axis not in "xy" else f"{edge.axis} on the unloaded outline"
    measured, now = comparison.measured_depth, edge.strokes_at(comparison.compared)
    curves = [("simulated", comparison.depth(comparison.compared), COLOURS[0], "-")]
    if not comparison.beyond:
        name = f"best fit, {edge.strokes_at(found.distance):.4g} strokes"
        curves.append((name, comparison.depth(found.distance), COLOURS[2], "--"))
    figure = Figure(figsize=(10, 10), layout="constrained")
    FigureCanvasAgg(figure)
    outline, depth, deviation = figure.subplots(3, 1, sharex=True, height_ratios=(1, 1.2, 1))

    near = (edge.place >= place[0]) & (edge.place <= place[-1])
    outline.plot(edge.place[near], edge.heights[0, near], "--", color="0.5", lw=1.2, label="unworn")
    outline.plot(place, found.height, ".", color=COLOURS[1], ms=2.5, label="measured, aligned")
    outline.plot(edge.place[near], edge.at(comparison.compared)[near], color=COLOURS[0], lw=1.2, label="simulated")
    outline.set_ylabel("height out of the material [mm]")
    outline.set_title(f"{edge.scene}: measured profile and outline after {now:.4g} strokes")
    outline.legend()

    area = comparison.area(measured)
    depth.plot(place, 1e3 * measured, ".", color=COLOURS[1], ms=2.5, label=f"measured: {area:.4g} mm²")
    for name, values, colour, style in curves:
        label = f"{name}: {comparison.area(values):.4g} mm²"
        depth.plot(place, 1e3 * values, style, color=colour, lw=1.4, label=label)
        off = 1e3 * (values - measured)
        label = f"{name}: RMS {np.sqrt(np.mean(off**2)):.3g} µm, largest {np.abs(off).max():.3g} µm"
        deviation.plot(place, off, ".", color=colour, ms=2.5, label=label)
    depth.fill_between(place, 0, 1e3 * curves[0][1], color=COLOURS[0], alpha=0.12, lw=0)
    depth.invert_yaxis()
    depth.set_ylabel("worn depth [µm]")
    depth.legend(title="worn area")

    deviation.axhline(0, color="k", lw=0.8)
    deviation.set_ylabel("height, measured less simulated [µm]")
    deviation.set_xlabel(f"{axis} [mm]")
    deviation.margins(y=0.3)
    deviation.legend(loc="upper center", ncols=2)
    return figure
