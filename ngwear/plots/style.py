"""Colours and panels that the figures share."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("#1b6ca8", "#d1495b", "#2e933c", "#8d6a9f", "#e0a030")


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
