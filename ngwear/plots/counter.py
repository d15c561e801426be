"""Figure of worn counter-surfaces: worn depth over their own coordinate."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ngwear.plots.style import COLOURS, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ngwear.results.result_file import ResultFile, Snapshot

ALONG, DEPTH = "counter-surface coordinate [mm]", "counter-surface depth [mm]"
MARGIN = 0.1  # of the worn length, shown to either side of it


def worn_counters(result: ResultFile) -> list[str]:
    """Names of the contacts whose counter-surface is worn in the end."""
    last = result.snapshots[-1].profiles
    return [name for name, profile in last.items() if DEPTH in profile and profile[DEPTH].max() > 0]


def counter_figure(result: ResultFile) -> Figure:
    """Depth worn off each counter-surface over its own coordinate after a quarter, a half and all of the strokes."""
    names, last = worn_counters(result), result.snapshots[-1]
    figure, axes = new_figure(len(names), (1.0,) * len(names), size=(8, 1 + 3.5 * len(names)), share=False)
    nearest = {s.stroke: s.profiles for s in (_nearest(result, last.stroke // part) for part in (4, 2, 1))}
    for panel, name in zip(axes, names, strict=True):
        for colour, (stroke, profiles) in zip(COLOURS, nearest.items(), strict=False):
            along, depth = profiles[name][ALONG], profiles[name][DEPTH]
            panel.plot(along, 1e3 * depth, color=colour, lw=1.2, label=f"after {stroke} strokes")
        worn = along[depth > 0]
        room = MARGIN * float(np.ptp(worn))
        panel.set_xlim(worn.min() - room, worn.max() + room)
        panel.invert_yaxis()
        panel.set_ylabel("worn depth [µm]")
        panel.set_xlabel(f"along the surface of {name}, in its own frame [mm]")
        panel.legend()
    axes[0].set_title(f"{result.scene}: depth worn off the counter-surface")
    return figure


def _nearest(result: ResultFile, stroke: float) -> Snapshot:
    return min(reversed(result.snapshots), key=lambda s: abs(s.stroke - stroke))
