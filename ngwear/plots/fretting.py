"""Pictures of two bodies that wear each other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ngwear.wear.fretting import Scar

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = ("#9aa5b1", "#1b6ca8", "#edae49", "#d1495b")
MICROMETRES = 1e3


def draw_scars(scars: Sequence[Scar]) -> Figure:
    """Worn depth of part and counter-surface, each over its own coordinate, and the pressure, one colour a time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 8), layout="constrained")
    part, counter, pressure = figure.subplots(3, sharex=True)
    for k, scar in enumerate(scars):
        style = {"color": COLOURS[k % len(COLOURS)], "label": f"{scar.cycles:,} cycles"}
        order = np.argsort(scar.place[:, 0])
        part.plot(scar.place[order, 0], MICROMETRES * scar.depth[order], ".-", ms=3, **style)
        counter.plot(scar.counter.along, MICROMETRES * scar.counter.depth, ".-", ms=3, **style)
        order = np.argsort(scar.touched[:, 0])
        pressure.plot(scar.touched[order, 0], scar.pressure[order], ".-", ms=3, **style)
    reach = 1.2 * max(np.abs(scar.place[scar.depth > 0, 0]).max(initial=0.0) for scar in scars)
    part.set_ylabel("depth of the part [µm]")
    counter.set_ylabel("depth of the counter-surface [µm]")
    for axis in (part, counter):
        axis.invert_yaxis()
    pressure.set_ylabel("contact pressure [MPa]")
    pressure.set_xlabel("along the surface, each in its own frame [mm]")
    if reach > 0:
        pressure.set_xlim(-reach, reach)
    for axis in (part, counter, pressure):
        axis.grid(alpha=0.3)
    part.legend()
    return figure
