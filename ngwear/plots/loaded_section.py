"""Figure of the loaded section between its rigid surfaces, filled by a field, and of the contact pressures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.plots.contact_pressures import draw_pressure, pressed
from ngwear.plots.filled import curves, fill, outline
from ngwear.plots.rigid_bodies import body, draw_bodies, write_in
from ngwear.plots.sections import Box
from ngwear.results.kept_sections import KeptSections
from ngwear.results.result_file import ResultFile, Snapshot
from ngwear.results.section import VON_MISES, Section, named
from ngwear.surfaces import Cylinder

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
Index = NDArray[np.intp]

SECTION = "section.png"
CLIPPED = 0.99  # share of the values within the colour scale: the stress at a sharp corner is unbounded
COLOUR_MAP = "viridis"
FLUID, WET = "#cfe3f5", "#2a7fd0"
FONT = 10.0  # points
WIDTH = 10.67  # inches, of the figure
TOP, BOTTOM, LEFT, RIGHT = 0.62, 0.52, 0.66, 0.15  # inches around the panels
BAR, BESIDE, LABELS, TICKS = 0.16, 0.1, 0.85, 0.62  # colour bar, left of it, right of it; left of a panel of pressures
NARROWEST, PANEL, GAP = 3.0, 0.6, 0.62  # panels of pressures: least width, least height, between two
FLAT = 0.42  # height over width of a view that is drawn above the pressures
TICK_X, TICK_Y = 0.5, 0.3  # inches for a number on an axis of pressures
STRIP, DISC, BARE = 0.36, 0.75, 0.12  # inches of view beside the section: with a plane, with a disc, with nothing


def section_figure(result: ResultFile) -> Figure:
    """The figure of a result in its plain form."""
    return draw_section(result)


def draw_section(
    result: ResultFile | KeptSections,
    *,
    field: str = VON_MISES,
    stroke: float | None = None,
    kind: str | None = None,
    mesh: bool = False,
) -> Figure:
    """Draw the loaded section filled by a field, every rigid surface in view, and the pressure along each contact.

    The pressures are those of the same kind of stroke at the first kept stroke, too.

    Parameters
    ----------
    result : ResultFile or KeptSections
    field : str
        One of ``ngwear.results.section.FIELDS``, its unit may be left out.
    stroke : float or None
        A kept one; the latest unless given.
    kind : str or None
        Which stroke of the cycle; the one with the highest fluid pressure unless given.
    mesh : bool
        Draw the elements' edges, too.

    Raises
    ------
    ResultError
        If the field is not known or the stroke is not kept, with those that are.
    """
    field = named(field)
    kept = KeptSections.of(result) if isinstance(result, ResultFile) else result
    shown = kept.at(stroke, kind)
    first = kept.at(kept.snapshots[0].stroke, shown.kind)
    picture = _Picture(kept, shown, Section.of(shown.section))
    states = {_when(s): Section.of(s.section) for s in (first, shown)}
    return picture.draw(field, states, mesh=mesh)


def _when(snapshot: Snapshot) -> str:
    return "new" if snapshot.stroke == 0 else f"after {snapshot.stroke:g} strokes"


@dataclass(frozen=True)
class _Layout:
    """Positions of the panels in inches from the figure's lower left corner, and the window of the section."""

    size: tuple[float, float]
    section: tuple[float, float, float, float]
    pressures: list[tuple[float, float, float, float]]
    window: Box
    inch: float  # [mm]


class _Picture:
    """One state of a run, to be drawn with the pressures of some states."""

    def __init__(self, kept: KeptSections, shown: Snapshot, section: Section) -> None:
        self.kept, self.shown, self.section = kept, shown, section

    def draw(self, field: str, states: dict[str, Section], *, mesh: bool) -> Figure:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
        from matplotlib.ticker import MaxNLocator

        names = pressed(list(states.values()), self.kept.surfaces)
        layout = self._layout(len(names))
        figure = Figure(figsize=layout.size)
        FigureCanvasAgg(figure)

        def place(left: float, low: float, width: float, height: float) -> Axes:
            wide, high = layout.size
            return figure.add_axes((left / wide, low / high, width / wide, height / high))

        left, low, width, height = layout.section
        axes = place(*layout.section)
        filled = self._draw_section(axes, layout, field, states, mesh=mesh)
        bar = figure.colorbar(filled, cax=place(left + width + BESIDE, low, BAR, height), extend=filled.extend)
        bar.set_label(field)
        bar.ax.grid(visible=False)
        panels = [place(*box) for box in layout.pressures]
        for panel, name, box in zip(panels, names, layout.pressures, strict=True):
            draw_pressure(panel, name, self.kept.surfaces.get(name), states)
            for axis, inches in ((panel.xaxis, box[2] / TICK_X), (panel.yaxis, box[3] / TICK_Y)):
                axis.set_major_locator(MaxNLocator(nbins=max(2, int(inches)), steps=[1, 2, 5, 10]))
        if panels:
            corner = 1 - RIGHT / layout.size[0], 1 - 0.06 / layout.size[1]
            figure.legend(
                *panels[0].get_legend_handles_labels(), loc="upper right", bbox_to_anchor=corner, ncols=2, frameon=False
            )
            self._name_pressures(figure, layout, panels)
        pressures = " and ".join(f"{p:.3g} MPa" for p in sorted(self.section.wetted, reverse=True) if p > 0)
        stroke = self.shown.kind if len({s.kind for s in self.kept.snapshots}) > 1 else ""
        words = [stroke, pressures, _when(self.shown)]
        title = f"{self.kept.scene}: {', '.join(filter(None, words))}"
        figure.text(left / layout.size[0], 1 - 0.12 / layout.size[1], title, va="top", fontsize=FONT + 2)
        return figure

    def _name_pressures(self, figure: Figure, layout: _Layout, panels: list[Axes]) -> None:
        """Write what the panels show left of the first ones, clear of the numbers there."""
        low = layout.pressures[-1][1]
        first = min(box[0] for box in layout.pressures)
        top = max(box[1] + box[3] for box in layout.pressures)
        wide, high = layout.size
        left = [panel for panel, box in zip(panels, layout.pressures, strict=True) if box[0] == first]
        numbers = [n for p in left for n in p.yaxis.get_major_formatter().format_ticks(list(p.get_yticks()))]
        clear = 0.14 + FONT / 72 * 0.6 * max(map(len, numbers))
        text = "contact pressure [MPa]"
        figure.text((first - clear) / wide, 0.5 * (low + top) / high, text, rotation=90, va="center", ha="right")

    def _draw_section(self, axes: Axes, layout: _Layout, field: str, states: dict[str, Section], *, mesh: bool) -> Any:
        from matplotlib.patheffects import withTickedStroke
        from matplotlib.ticker import MaxNLocator
        from shapely import union_all

        section, window = self.section, layout.window
        (left, low), (right, high) = window
        axes.set_xlim(left, right)
        axes.set_ylim(low, high)
        axes.grid(visible=False)
        axes.set_xlabel("x [mm]")
        axes.set_ylabel("y [mm]")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MaxNLocator(nbins="auto", steps=[1, 2, 5, 10]))
        bodies = self._bodies(window)
        draw_bodies(axes, bodies, window)
        filled = self._fill(axes, field)
        if mesh:
            _line(axes, curves(section.points, section.edges), "w", 0.25, zorder=3.4, alpha=0.6)
        for state in list(states.values())[:-1]:
            _line(axes, _border(state), "0.25", 0.8, zorder=3.6, ls=(0, (3, 2)))
        _line(axes, _border(section), "k", 1.0, zorder=4)
        if len(section.held):
            hatch = withTickedStroke(spacing=6, angle=-135, length=0.6)
            _line(axes, curves(section.points, section.held), "k", 0.8, zorder=3.8, path_effects=[hatch])
        rubber = _region(section)
        taken = [rubber]
        for pressure, edges in section.wetted.items():
            if pressure > 0:
                taken.append(self._draw_fluid(axes, layout, rubber, bodies, pressure=pressure, edges=edges))
        for name, shape in bodies.items():
            others = union_all([*taken, *(b for key, b in bodies.items() if key != name)])
            taken.append(write_in(axes, name, shape.difference(others), inch=layout.inch, fontsize=FONT))
        return filled

    def _fill(self, axes: Axes, field: str) -> Any:
        """The section filled by a field; colours are clipped at a value that few values exceed."""
        from matplotlib.colors import Normalize

        values = self.section.field(field)
        low, high = (float(np.quantile(values, q)) for q in (1 - CLIPPED, CLIPPED))
        low = 0.0 if values.min() >= 0 and "stretch" not in field else low
        if not high > low:
            low, high = low - 0.5, high + 0.5
        filled = fill(axes, self.section, values, cmap=COLOUR_MAP, norm=Normalize(low, high))
        above, below = values.max() > high, values.min() < low
        filled.extend = {(1, 1): "both", (1, 0): "max", (0, 1): "min", (0, 0): "neither"}[int(above), int(below)]
        return filled

    def _bodies(self, window: Box) -> dict[str, Any]:
        found = {}
        for name, contact in self.section.contacts.items():
            if name in self.kept.surfaces:
                found[name] = body(self.kept.surfaces[name], contact, self.shown.profiles.get(name, {}), window)
        return {name: shape for name, shape in found.items() if not shape.is_empty}

    def _draw_fluid(
        self, axes: Axes, layout: _Layout, rubber: Any, bodies: dict[str, Any], *, pressure: float, edges: Index
    ) -> Any:
        """A fluid that presses on edges of the section, its line and its pressure; return the space of the text."""
        from shapely import MultiLineString, box, union_all

        section = self.section
        _line(axes, curves(section.points, edges), WET, 2.2, zorder=4.5)
        thin = 0.01 * layout.inch  # what is narrower than twice this joins no two pools
        (left, low), (right, high) = layout.window
        solid = union_all([rubber, *bodies.values()])
        free = box(left, low, right, high).difference(solid.buffer(thin))
        wet = MultiLineString([section.points[edge].tolist() for edge in edges])
        pools = [p for p in getattr(free, "geoms", [free]) if p.distance(wet) < 3 * thin]
        for pool in pools:
            drawn = pool.buffer(2 * thin)
            for part in getattr(drawn, "geoms", [drawn]):
                axes.fill(*np.array(part.exterior.coords).T, facecolor=FLUID, edgecolor="none", zorder=0.5)
        room = union_all(pools)
        text = f"{pressure:.3g} MPa"
        return write_in(axes, text, room, inch=layout.inch, fontsize=FONT, colour=WET)

    def _layout(self, panels: int) -> _Layout:
        """Arrange the panels: pressures beside the section, or below one that is flat."""
        points = self.section.points
        low, high = points.min(axis=0), points.max(axis=0)
        gaps, rooms = self._around(low, high)
        wide, tall = high - low + gaps.sum(axis=0)
        flat = tall / wide < FLAT
        beside = BESIDE + BAR + LABELS + RIGHT
        room = WIDTH - LEFT - beside - (0.0 if flat or not panels else TICKS + NARROWEST)
        across, up = rooms.sum(axis=0)
        inch = max(wide / (room - across), tall / (4.5 - up))
        width, height = wide / inch + across, tall / inch + up
        window = low - gaps[0] - inch * rooms[0], high + gaps[1] + inch * rooms[1]
        if flat and panels:
            under = 1.45
            total = TOP + height + BOTTOM + 0.32 + under + BOTTOM
            step = (width + GAP) / panels
            boxes = [(LEFT + k * step, BOTTOM, step - GAP, under) for k in range(panels)]
            return _Layout((WIDTH, total), (LEFT, total - TOP - height, width, height), boxes, window, inch)
        column = max(height, panels * (PANEL + GAP) - GAP)
        total = TOP + column + BOTTOM
        start = LEFT + width + BESIDE + BAR + LABELS + TICKS
        each = (column + GAP) / max(panels, 1)
        lows = [BOTTOM + column - (k + 1) * each + GAP for k in range(panels)]
        boxes = [(start, low, WIDTH - RIGHT - start, each - GAP) for low in lows]
        middle = BOTTOM + 0.5 * (column - height)
        return _Layout((WIDTH, total), (LEFT, middle, width, height), boxes, window, inch)

    def _around(self, low: Array, high: Array) -> tuple[Array, Array]:
        """How far bodies beside the section are [mm], and how much of them to show [inches]: low and high, x and y."""
        from shapely import box

        gaps, rooms = np.zeros((2, 2)), np.full((2, 2), BARE)
        reach = 0.25 * float((high - low).max())
        bodies = self._bodies((low - reach, high + reach))
        for side in range(2):
            for axis in range(2):
                a, b = low.copy(), high.copy()
                a[axis], b[axis] = (low[axis] - reach, low[axis]) if side == 0 else (high[axis], high[axis] + reach)
                for name, shape in bodies.items():
                    seen = shape.intersection(box(*a, *b))
                    if seen.is_empty or seen.bounds[3 - axis] - seen.bounds[1 - axis] < 0.3 * (b - a)[1 - axis]:
                        continue
                    gap = low[axis] - seen.bounds[2 + axis] if side == 0 else seen.bounds[axis] - high[axis]
                    gaps[side, axis] = max(gaps[side, axis], gap)
                    kind = DISC if isinstance(self.kept.surfaces[name], Cylinder) else STRIP
                    rooms[side, axis] = max(rooms[side, axis], kind)
        return gaps, rooms


def _border(section: Section) -> Any:
    loops = [np.column_stack([loop, np.roll(loop[:, 0], -1)]) for loop in section.loops()]
    return curves(section.points, np.concatenate(loops))


def _line(axes: Axes, path: Any, colour: str, width: float, *, zorder: float, **style: Any) -> None:
    from matplotlib.patches import PathPatch

    axes.add_artist(PathPatch(path, fill=False, edgecolor=colour, lw=width, zorder=zorder, **style))


def _region(section: Section) -> Any:
    """The section as a Shapely geometry."""
    from shapely import Polygon, union_all

    shapes = [Polygon(points) for points in outline(section)]
    solid = [s.buffer(0) for s in shapes if s.exterior.is_ccw]
    holes = [s.buffer(0) for s in shapes if not s.exterior.is_ccw]
    return union_all(solid).difference(union_all(holes))
