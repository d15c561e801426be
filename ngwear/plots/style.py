"""Colours and panels that the figures share."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ngwear.errors import ResultError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("#1b6ca8", "#d1495b", "#2e933c", "#8d6a9f", "#e0a030", "#3a3a3a")


def new_figure(
    rows: int, heights: tuple[float, ...], *, size: tuple[float, float], share: bool = True
) -> tuple[Figure, list[Axes]]:
    """Figure with panels one above the other, of the given heights."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, 1, sharex=share, height_ratios=heights, squeeze=False)[:, 0]
    return figure, list(axes)


def write(figure: Figure, path: Path, *, dpi: float = 150) -> None:
    """Write a figure as PNG, laid out and drawn once (``Figure.savefig`` draws twice).

    Raises
    ------
    ResultError
        If it cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure.set_dpi(dpi)
    try:
        FigureCanvasAgg(figure).print_png(path)
    except OSError as error:
        raise ResultError(f"{path} cannot be written: {error.strerror}") from error
