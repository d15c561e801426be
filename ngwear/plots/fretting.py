"""Figures of two bodies that wear each other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ngwear.plots.style import COLOURS, new_figure
from ngwear.wear.fretting import Scar

if TYPE_CHECKING:
    from matplotlib.figure import Figure

UNWORN = "0.6"
MICROMETRES = 1e3


def draw_scars(scars: Sequence[Scar]) -> Figure:
    """Worn depth of part and counter-surface, each over its own coordinate, and the pressure, one colour a time."""
    figure, (part, counter, pressure) = new_figure(3, (1.0, 1.0, 1.0), size=(8, 8))
    colours = iter(COLOURS)
    for scar in scars:
        worn = bool(scar.depth.max() > 0)
        style: dict[str, Any] = {
            "color": next(colours) if worn else UNWORN,
            "ms": 3,
            "label": f"{scar.cycles:,} cycles",
        }
        if worn:
            order = np.argsort(scar.place[:, 0])
            part.plot(scar.place[order, 0], MICROMETRES * scar.depth[order], ".-", **style)
            counter.plot(scar.counter.along, MICROMETRES * scar.counter.depth, ".-", **style)
        order = np.argsort(scar.touched[:, 0])
        pressure.plot(scar.touched[order, 0], scar.pressure[order], ".-", **style)
    reach = 1.2 * max(np.abs(scar.place[scar.depth > 0, 0]).max(initial=0.0) for scar in scars)
    part.set_ylabel("depth of the part [µm]")
    counter.set_ylabel("depth of the counter-surface [µm]")
    for axis in (part, counter):
        axis.invert_yaxis()
    pressure.set_ylabel("contact pressure [MPa]")
    pressure.set_title("pressure with the surface near the end of its way back", fontsize=10)
    pressure.set_xlabel("along the surface, each in its own frame [mm]")
    pressure.set_ylim(bottom=0)
    if reach > 0:
        pressure.set_xlim(-reach, reach)
    for axis in (part, counter, pressure):
        axis.grid(alpha=0.3)
    pressure.legend()
    return figure
