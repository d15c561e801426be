"""Figure of a cost study: error against computing time of every run, and the error by each parameter alone."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ngwear.error_estimates.cost_study import TARGETS, Study
from ngwear.error_estimates.cost_table import kind_of
from ngwear.error_estimates.cost_text import name_of
from ngwear.error_estimates.ladder import with_level
from ngwear.error_estimates.settings_search import Choice
from ngwear.plots.style import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MARKERS = ("o", "s", "^", "D", "v", "P")
SIDES = (  # where a ladder's labels stand beside their points [points], so that those of two ladders do not overlap
    ((0, 6), "center", "bottom"),
    ((7, 0), "left", "center"),
    ((-7, 0), "right", "center"),
    ((0, -6), "center", "top"),
)
LEAST = 1e-5  # errors below, or none at all, are drawn here: a hundredth of the smallest target


def draw_cost(scene: str, study: Study, choices: Sequence[Choice]) -> Figure:
    """Total error of each run with the Pareto front (left), and the error by each parameter alone (right).

    Parameters
    ----------
    scene : str
        Name of the scene, for the title.
    study : Study
    choices : sequence of Choice
        The recommended settings are marked.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.ticker import LogLocator

    figure = Figure(figsize=(13, 5.8), layout="constrained")
    FigureCanvasAgg(figure)
    whole, alone = figure.subplots(1, 2, sharex=True)
    _draw_runs(whole, study, choices)
    _draw_ladders(alone, study)
    figure.suptitle(f"{scene}: error of the {name_of(study.main)} against processor time")
    for axis in (whole, alone):
        axis.margins(0.13)
        axis.set_xlabel("processor time of the run [s]")
        axis.grid(alpha=0.25, which="both")
        axis.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.xaxis.set_major_formatter("{x:g}")
        axis.xaxis.set_minor_formatter("")
    return figure


def _draw_runs(axis: Axes, study: Study, choices: Sequence[Choice]) -> None:
    shown = {s: run for s, run in study.runs.items() if run.ok and math.isfinite(study.error(s, study.main))}
    errors = {s: max(study.error(s, study.main), LEAST) for s in shown}
    kinds = [ladder.name for ladder in study.ladders]
    styles = dict(zip([*kinds, "combination", "all"], [*range(len(kinds)), None, None], strict=True))
    for kind, number in styles.items():
        of_kind = [s for s in shown if kind_of(study, s) == kind]
        colour = "0.35" if number is None else COLOURS[number % len(COLOURS)]
        marker = {"combination": "P", "all": "h"}.get(kind, MARKERS[(number or 0) % len(MARKERS)])
        label = {"combination": "several parameters changed", "all": "base setting"}.get(kind, f"{kind} changed")
        if of_kind:
            x, y = [shown[s].cpu for s in of_kind], [errors[s] for s in of_kind]
            axis.loglog(x, y, marker, color=colour, ms=7, alpha=0.85, label=label)
    front = study.front()
    last = max(run.cpu for run in shown.values())  # continues the front to the right end
    x, y = [shown[s].cpu for s in front], [errors[s] for s in front]
    axis.step([*x, 1.1 * last], [*y, y[-1]], "k-", where="post", lw=1.3, label="Pareto front")
    if study.own in shown:
        at = shown[study.own].cpu, errors[study.own]
        axis.plot(*at, "o", ms=15, mfc="none", mec="k", mew=1.2, label="the scene as given")
    _mark_targets(axis, study, choices)
    axis.set_ylabel("relative error, all parameters together [-]")
    axis.set_title("all runs", fontsize=11)
    _legend(axis)


def _mark_targets(axis: Axes, study: Study, choices: Sequence[Choice]) -> None:
    for target in TARGETS:
        axis.axhline(target, color="0.5", lw=0.8, ls="--")
        axis.annotate(
            f"{100 * target:g} %", (1.0, target), xycoords=("axes fraction", "data"), xytext=(-3, 2),
            textcoords="offset points", ha="right", fontsize=8, color="0.35",
        )  # fmt: skip
    goals: dict[tuple[float, float], list[str]] = {}
    for choice in choices:
        if choice.setting is not None and choice.measured:
            at = study.runs[choice.setting].cpu, max(study.error(choice.setting, study.main), LEAST)
            goals.setdefault(at, []).append(f"{100 * choice.target:g} %")
    for k, (at, names) in enumerate(goals.items()):
        axis.annotate(
            f"for {', '.join(names)}", at, xytext=(10, -16 - 14 * k), textcoords="offset points", fontsize=9,
            arrowprops={"arrowstyle": "-", "lw": 0.6},
        )  # fmt: skip


def _draw_ladders(axis: Axes, study: Study) -> None:
    for k, ladder in enumerate(study.ladders):
        levels = study.levels(k)
        if len(levels) < 2:
            continue
        others = [i for i in levels if study.level_error(k, i, study.main)]  # without those equal to the reference
        x = [levels[i].cpu for i in others]
        y = [max(study.level_error(k, i, study.main) or 0.0, LEAST) for i in others]
        order = study.order(k, study.main)
        observed = "" if order is None else f", observed order {order:.1f}"
        colour, marker = COLOURS[k % len(COLOURS)], MARKERS[k % len(MARKERS)]
        reference = f"against {ladder.labels[max(levels)]}{observed}"
        axis.loglog(x, y, marker + "-", color=colour, ms=6, lw=1.0, label=f"{ladder.name}, {reference}")
        offset, across, along = SIDES[k % len(SIDES)]
        for i, place in zip(others, zip(x, y, strict=True), strict=True):
            text = ladder.labels[i].removeprefix("wear_error ").removeprefix("stress_error ")
            own = i == ladder.own and with_level(study.base, k, i) in study.runs
            axis.annotate(
                text, place, xytext=offset, textcoords="offset points", ha=across, va=along, fontsize=7.5, color=colour,
                fontweight="bold" if own else "normal",
            )  # fmt: skip
    axis.set_ylabel("relative difference from the finest run [-]")
    axis.set_title("each parameter alone (bold: value of the scene)", fontsize=11)
    _legend(axis)


def _legend(axis: Axes) -> None:
    """Put the legend below the points, where it hides none."""
    axis.margins(0.13)
    low, high = axis.get_ylim()
    axis.set_ylim(low * (low / high) ** 0.4, high)
    axis.legend(fontsize=8, loc="lower left")
