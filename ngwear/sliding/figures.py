"""Figures of sliding on viscoelastic rubber."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ngwear.materials import PronySeries
from ngwear.sliding.asperity import Slide

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FRICTION, LOSS = "#1b6ca8", "#d1495b"


def draw_friction(slides: Sequence[Slide], series: PronySeries) -> Figure:
    """Internal friction against exciting frequency, over the loss factor of the same arms."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 4.5), layout="constrained")
    left = figure.subplots()
    right = left.twinx()
    ordered = sorted(slides, key=lambda s: s.frequency)
    frequency = [s.frequency for s in ordered]
    fine = np.geomspace(frequency[0], frequency[-1], 400)
    (friction,) = left.semilogx(frequency, [s.friction for s in ordered], "o-", color=FRICTION)
    (loss,) = right.semilogx(fine, series.tan_delta(fine), color=LOSS)
    left.set_xlabel("exciting frequency, speed / (2 contact length) [Hz]")
    left.set_ylabel("friction coefficient [-]", color=FRICTION)
    right.set_ylabel("loss factor tan delta [-]", color=LOSS)
    left.set_ylim(bottom=0)
    right.set_ylim(bottom=0)
    left.grid(alpha=0.3, which="both")
    left.legend([friction, loss], ["internal friction of one asperity", "loss factor of the rubber"])
    return figure


def draw_pressures(slides: Sequence[Slide]) -> Figure:
    """Contact pressure along the track, one curve a speed; the slider moves to the right."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 4.5), layout="constrained")
    axis = figure.subplots()
    reach = 1.3 * max(max(abs(s.start), abs(s.end)) for s in slides)
    for s in slides:
        axis.plot(s.place, s.pressure, ".-", ms=3, label=f"{s.speed:g} mm/s")
    axis.set_xlim(-reach, reach)
    axis.set_xlabel("along the track, from the slider's axis [mm]")
    axis.set_ylabel("contact pressure [MPa]")
    axis.grid(alpha=0.3)
    axis.legend()
    return figure
