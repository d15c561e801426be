"""Figures of the laws of friction and wear: values used in a run, and a fit with its data."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from ngwear.plots.style import COLOURS, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ngwear.laws.fit import LubricationFit
    from ngwear.results.result_file import ResultFile

QUANTITIES = ("friction coefficient [-]", "specific wear rate [mm^2/N]")


def has_laws(result: ResultFile) -> bool:
    """Whether friction or wear of a run follows a law that is not constant."""
    return any(column.endswith(QUANTITIES) for column in result.series)


def law_figure(result: ResultFile) -> Figure:
    """Friction coefficient and wear rate over the sliding distance, each over the strokes that a solve represents."""
    series = result.series
    shown = [q for q in QUANTITIES if any(column.endswith(q) for column in series)]
    figure, axes = new_figure(len(shown), (1.0,) * len(shown), size=(8, 1 + 3 * len(shown)))
    solved = (series["strokes in one solve [-]"] > 0) | (series["stroke [-]"] == 0)
    for panel, quantity in zip(axes, shown, strict=True):
        names = [column[: -len(quantity) - 1] for column in series if column.endswith(quantity)]
        lines = [(name, kind) for name in names for kind in result.kinds]
        for number, (name, kind) in enumerate(lines):
            mine = solved & (series["kind [-]"] == kind)
            metres, values = series["sliding distance [mm]"][mine] / 1e3, series[f"{name} {quantity}"][mine]
            colour = COLOURS[number % len(COLOURS)]
            panel.step(metres, values, where="pre", color=colour, lw=1.2, label=f"{name}, {kind}")
        panel.set_ylabel(quantity.replace("mm^2", "mm²"))
        panel.set_ylim(bottom=0)
        panel.legend(loc="upper left")
    axes[0].set_title(f"{result.scene}: laws as the solves used them")
    axes[-1].set_xlabel("sliding distance [m]")
    return figure


def draw_lubrication(fit: LubricationFit) -> Figure:
    """Measured coefficient of friction with the four phases, and their difference."""
    figure, (top, bottom) = new_figure(2, (2.0, 1.0), size=(7, 7))
    s, mu = np.array(fit.data.distance), np.array(fit.data.coefficient)
    law = np.array([fit.law.mu(x) for x in s])
    top.plot(s / 1e3, mu, "o", ms=4, mfc="none", color=COLOURS[0], label="measured")
    corners = np.clip(np.array([*fit.law.distance, s[-1]]), s[0], None)
    top.plot(corners / 1e3, [fit.law.mu(x) for x in corners], color=COLOURS[1], label="four phases")
    ends = [s[0], *fit.law.distance[1:], s[-1]]
    for name, (a, b) in zip(("film", "mixed", "boundary", "dry"), pairwise(ends), strict=True):
        top.axvline(b / 1e3, color="0.7", lw=0.8)
        top.text(0.5 * (a + b) / 1e3, 1.03 * mu.max(), name, ha="center", color="0.4")
    bottom.plot(s / 1e3, law - mu, ".-", color=COLOURS[0])
    top.set_ylim(0, 1.12 * mu.max())
    top.set_ylabel("friction coefficient [-]")
    top.set_title(f"root mean square error {fit.misfit:.3f}, largest {fit.largest:.3f}")
    top.legend(loc="center left")
    bottom.set_ylabel("fit - data [-]")
    bottom.set_xlabel("sliding distance [m]")
    for panel in (top, bottom):
        panel.grid(alpha=0.3)
    return figure
