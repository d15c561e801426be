"""Figure of the material balance: lost area and elements by cause over the sliding distance."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ngwear.plots.style import new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ngwear.results.result_file import ResultFile

IN_ALL = "area lost in all [mm^2]"
CAUSES = {"wear": "#9db7cc", "tearing": "#222222", "distortion": "#d98324", "coming loose": "#7f5fa8"}
AREAS = CAUSES | {"merging": "#5e8c61"}  # merged nodes at the walls of pits: small, of either sign

ELEMENTS = [0, 2, 5, *(digit * 10**power for power in range(1, 7) for digit in (1, 2, 5))]  # marked on the axis


def has_book(result: ResultFile) -> bool:
    """Whether a run has recorded its lost area by cause."""
    return IN_ALL in result.series


def book_figure(result: ResultFile) -> Figure:
    """Lost area by cause, stacked; the same without wear; and the number of lost elements."""
    from matplotlib.ticker import FixedLocator

    series = result.series
    metres = series["sliding distance [mm]"] / 1e3
    figure, (area, small, count) = new_figure(3, (1.5, 1.0, 1.0), size=(8, 9))
    lost = {cause: series[f"area lost by {cause} [mm^2]"] for cause in AREAS}
    area.stackplot(metres, *lost.values(), colors=AREAS.values(), labels=[f"by {cause}" for cause in AREAS])
    area.plot(metres, series[IN_ALL], color="k", lw=0.8, ls="--", label="in all")
    area.set_ylabel("area lost from the section [mm²]")
    area.set_ylim(bottom=min(0.0, area.dataLim.ymin))
    area.set_xlim(metres.min(), max(metres.max(), 1e-9))
    handles, labels = area.get_legend_handles_labels()
    area.legend(handles[::-1], labels[::-1], loc="upper left")  # in the order in which they lie
    area.set_title(f"{result.scene}: material lost, by cause")
    for cause, colour in list(AREAS.items())[1:]:
        small.step(metres, lost[cause], where="post", color=colour, lw=1.5, label=f"by {cause}")
    small.set_ylabel("the same without wear [mm²]")
    small.legend(loc="center right")
    for cause, colour in CAUSES.items():
        column = "elements worn away [-]" if cause == "wear" else f"elements lost by {cause} [-]"
        count.step(metres, series[column], where="post", color=colour, lw=1.5, label=f"by {cause}")
    count.set_ylabel("elements lost [-]")
    count.set_yscale("symlog", linthresh=10.0)
    count.yaxis.set_major_locator(FixedLocator(ELEMENTS))
    count.yaxis.set_major_formatter("{x:.0f}")
    count.set_ylim(bottom=0)
    count.set_xlabel("sliding distance [m]")
    count.legend()
    return figure
