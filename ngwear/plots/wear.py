"""Figures of a run, drawn from its result file alone."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import ResultError
from ngwear.plots.area_balance import book_figure, has_book
from ngwear.plots.contact_pressures import line_over_x
from ngwear.plots.counter import counter_figure, worn_counters
from ngwear.plots.laws import has_laws, law_figure
from ngwear.plots.loaded_section import SECTION, draw_section, section_figure
from ngwear.plots.sections import sections
from ngwear.plots.stress import stress_figure
from ngwear.plots.style import COLOURS, new_figure, write
from ngwear.plots.torn import face_figure, ridge_figure
from ngwear.profiles.worn_edge import STATIONS, seen, view
from ngwear.results.kept_sections import KeptSections
from ngwear.results.result_file import ResultFile, Snapshot, read_result
from ngwear.results.section import VON_MISES, named

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

HISTORIES = ("peak pressure [MPa]", "contact width [mm]", "leak pressure [MPa]")  # columns that end so
BY_COARSER_RUNS = {"peak pressure [-]", "contact width [-]"}  # errors that only a run beside coarser ones states


def plot(folder: Path | str, *, share: tuple[int, int] = (0, 1)) -> list[Path]:
    """Draw the figures of a run into its folder; return their paths.

    Parameters
    ----------
    folder : path
    share : (k, n)
        Draw only the share of the k-th of n processes that draw at the same time; the section is drawn by process 0.

    Raises
    ------
    ResultError
        If the result cannot be read or the pictures cannot be written.
    """
    result = read_result(folder)
    if not result.snapshots:
        return []
    figures = {"section": section_figure} if KeptSections.of(result) else {}
    figures |= {"profiles": profile_figure, "peak_pressure": peak_figure, "history": history_figure}
    if has_laws(result):
        figures["laws"] = law_figure
    if worn_counters(result):
        figures["counter_surface"] = counter_figure
    if result.snapshots[-1].profiles and is_mirrored(result.outline):
        figures["asymmetry"] = asymmetry_figure
    if sections(result):
        figures |= {"torn_profiles": face_figure, "ridge_evolution": ridge_figure}
        figures["stress_field"] = stress_figure
    if has_book(result):
        figures["material_book"] = book_figure
    mine, of = share
    chosen = dict(list(figures.items())[mine::of])
    written = []
    with _style():
        for name, draw in chosen.items():
            try:
                figure = draw(result)
            except KeyError as error:
                raise ResultError(f"{Path(folder) / 'result.h5'} lacks {error}: the file is damaged") from error
            path = Path(folder) / f"{name}.png"
            write(figure, path)
            written.append(path)
    return written


def plot_section(folder: Path | str, kept: KeptSections | None = None, *, field: str = VON_MISES) -> Path:
    """Draw the loaded section alone; return the path: ``section.png``, of another field with its name.

    Parameters
    ----------
    folder : path
    kept : KeptSections or None
        Of a run that is under way; read from the folder unless given.
    field : str
        See ``ngwear.results.section.FIELDS``.

    Raises
    ------
    ResultError
        If the field is not known, the result cannot be read, holds no section, or the picture cannot be written.
    """
    field = named(field)
    kept = KeptSections.of(read_result(folder)) if kept is None else kept
    path = Path(folder) / SECTION
    if field != VON_MISES:
        path = path.with_stem(f"{path.stem}_{field.rsplit(' [', 1)[0].replace(' ', '_')}")
    with _style():
        write(draw_section(kept, field=field), path)
    return path


def _style() -> AbstractContextManager[None]:
    import matplotlib

    return matplotlib.rc_context({"font.size": 10, "axes.grid": True, "grid.alpha": 0.3})


def _pressure(axes: Axes, snapshot: Snapshot, **style: Any) -> None:
    label = style.pop("label", None)
    for profile in snapshot.profiles.values():
        x, p = line_over_x(profile["place [mm]"], profile["pressure [MPa]"])
        axes.plot(x, p, label=label, **style)
        label = None


def _window(result: ResultFile, margin: float = 0.15) -> tuple[float, float]:
    """Range of x, deformed, in which any kept state is in contact."""
    low, high = [], []
    for snapshot in result.snapshots:
        for profile in snapshot.profiles.values():
            on = profile["pressure [MPa]"] > 0
            if on.any():
                low.append(profile["place [mm]"][on, 0].min())
                high.append(profile["place [mm]"][on, 0].max())
    if not low:
        return float(result.outline[:, 0].min()), float(result.outline[:, 0].max())
    return min(low) - margin * (max(high) - min(low)), max(high) + margin * (max(high) - min(low))


def profile_figure(result: ResultFile) -> Figure:
    """Worn outlines at the start, middle and end, over the pressure of each stroke of the cycle."""
    last = result.snapshots[-1].stroke
    strokes = sorted({0, last // 2, last})
    kinds = result.kinds
    figure, axes = new_figure(1 + len(kinds), (1.2, *[1.0] * len(kinds)), size=(10, 3.2 * (1 + len(kinds))))
    window = _window(result)
    heights = []
    for colour, stroke in zip(COLOURS, strokes, strict=False):
        shown = result.at(stroke, kinds[-1])
        closed = np.vstack([shown.outline, shown.outline[:1]])
        axes[0].plot(closed[:, 0], closed[:, 1], color=colour, lw=1.0, label=f"after {shown.stroke} strokes")
        for profile in shown.profiles.values():
            touched = profile["reference [mm]"][profile["pressure [MPa]"] > 0]
            apart = np.linalg.norm(touched[:, None] - shown.outline, axis=-1)
            heights.append(shown.outline[apart.argmin(axis=1), 1])
        for panel, kind in zip(axes[1:], kinds, strict=True):
            snapshot = result.at(stroke, kind)
            _pressure(panel, snapshot, color=colour, lw=1.0, label=f"after {snapshot.stroke} strokes")
    height = np.concatenate(heights) if heights else np.zeros(0)
    if len(height):
        room = max(np.ptp(height), 1e-3)
        axes[0].set_ylim(height.min() - 0.3 * room, height.max() + 0.3 * room)
    axes[0].set_xlim(*window)
    axes[0].set_ylabel("outline, unloaded: y [mm]")
    axes[0].set_title(f"{result.scene}: worn outline and contact pressure")
    for panel, kind in zip(axes[1:], kinds, strict=True):
        panel.set_ylabel(f"{kind}: pressure [MPa]")
        panel.set_ylim(bottom=0)
    axes[-1].set_xlabel("x [mm]")
    axes[0].legend()
    return figure


def peak_figure(result: ResultFile) -> Figure:
    """Pressure around the highest peak after 0, a quarter and a half of the strokes, for the first stroke kind."""
    kind = result.kinds[0]
    last = result.snapshots[-1].stroke
    figure, (axes,) = new_figure(1, (1,), size=(7, 4.5))
    centre, width = _highest(result.at(0, kind))
    for colour, stroke in zip(COLOURS, sorted({0, last // 4, last // 2, last}), strict=False):
        snapshot = result.at(stroke, kind)
        _pressure(axes, snapshot, color=colour, lw=1.0, marker=".", ms=4, label=f"after {snapshot.stroke} strokes")
        width = max(width, _highest(snapshot)[1])
    axes.set_xlim(centre - 1.5 * width, centre + 1.5 * width)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("contact pressure [MPa]")
    axes.set_title(f"{result.scene}: {kind} stroke, where the pressure is highest")
    axes.legend()
    return figure


def _highest(snapshot: Snapshot) -> tuple[float, float]:
    """Place of the highest pressure and the width of the contact around it [mm]."""
    centre, width, best = 0.0, 0.1, -1.0
    for profile in snapshot.profiles.values():
        place, p = profile["place [mm]"], profile["pressure [MPa]"]
        i = int(np.argmax(p))
        if p[i] <= best:
            continue
        a = b = i
        while a > 0 and p[a - 1] > 0:
            a -= 1
        while b < len(p) - 1 and p[b + 1] > 0:
            b += 1
        centre, width, best = float(place[i, 0]), float(abs(place[b, 0] - place[a, 0])), float(p[i])
    return centre, max(width, 1e-6)


def history_figure(result: ResultFile) -> Figure:
    """Depth, peak pressure, contact width and leak pressure over strokes, in bands of the errors that the run states.

    A run with coarser runs states relative errors for its end; they are drawn for all strokes.
    """
    series, kinds = result.series, result.kinds
    stroke = series["stroke [-]"]
    # Further strokes that were looked at where the outline was kept did not wear: their contact is another.
    worn = (series["strokes in one solve [-]"] > 0) | (stroke == 0)
    endings = [e for e in HISTORIES if any(c.endswith(e) for c in series)]
    figure, axes = new_figure(1 + len(endings), (1.3, *[1] * len(endings)), size=(8, 3.5 + 2.75 * len(endings)))
    depth, error = series["maximum depth [mm]"] * 1e3, series["error estimate of maximum depth [mm]"] * 1e3
    stated = result.errors if BY_COARSER_RUNS & result.errors.keys() else {}
    if stated:
        error = stated["maximum depth [-]"] * depth
    axes[0].plot(stroke, depth, color="k", lw=1.2, label="maximum")
    axes[0].fill_between(stroke, depth - error, depth + error, color="0.8", label="error estimate")
    for colour, name in zip(COLOURS, [c for c in series if c.startswith("depth at ")], strict=False):
        if series[name].max() > 0.02 * max(depth.max() / 1e3, 1e-12):
            axes[0].plot(stroke, series[name] * 1e3, color=colour, lw=1.0, label=name[9:-5])
    axes[0].set_ylabel("worn depth [µm]")
    axes[0].legend()
    for panel, ending in zip(axes[1:], endings, strict=True):
        for column in [c for c in series if c.endswith(ending)]:
            for colour, kind in zip(COLOURS, kinds, strict=False):
                mine = worn & (series["kind [-]"] == kind)
                off = stated.get(ending[: ending.index("[")] + "[-]", 0.0) * series[column][mine]
                low, high = series[column][mine] - off, series[column][mine] + off
                panel.fill_between(stroke[mine], low, high, color=colour, alpha=0.2, lw=0)
                panel.plot(
                    stroke[mine],
                    series[column][mine],
                    ".-",
                    color=colour,
                    lw=1.0,
                    ms=4,
                    label=f"{column[: -len(ending) - 1]}, {kind}".lstrip(", "),
                )
        panel.set_ylabel(ending)
        panel.set_ylim(bottom=0)
        panel.legend()
    axes[0].set_title(result.scene)
    axes[-1].set_xlabel("strokes")
    return figure


def is_mirrored(outline: Array) -> bool:
    """Whether an outline, not yet worn, is its own mirror image left to right."""
    from shapely import Polygon

    middle = 0.5 * (outline[:, 0].min() + outline[:, 0].max())
    shape, mirrored = Polygon(outline), Polygon(outline * (-1, 1) + (2 * middle, 0))
    return shape.symmetric_difference(mirrored).area < 1e-6 * shape.area


def worn_edge(snapshot: Snapshot) -> Array:
    """Points of the outline along the first contact's edges, sorted by x [mm], shape (k, 2)."""
    touching = next(iter(snapshot.profiles.values()))["reference [mm]"]
    order = np.argsort(touching[:, 0])
    first, middle, last = (
        int(np.linalg.norm(snapshot.outline - touching[i], axis=1).argmin())
        for i in (order[0], order[len(order) // 2], order[-1])
    )
    n = len(snapshot.outline)
    if (middle - first) % n > (last - first) % n:
        first, last = last, first
    edge = snapshot.outline[np.arange(first, first + (last - first) % n + 1) % n]
    return edge[np.argsort(edge[:, 0])]


def _from_outside(result: ResultFile, snapshot: Snapshot) -> Array:
    """The worn edge; as it shows from outside, if elements that it has lost may have left overhangs."""
    edge = worn_edge(snapshot)
    if not sections(result):
        return edge
    direction, outward, _ = view(result.outline, np.isin(result.edges, result.worn_edges))
    x = np.linspace(edge[0, 0], edge[-1, 0], STATIONS)
    return np.column_stack([x, outward[1] * seen(snapshot.outline @ direction, snapshot.outline @ outward, x)])


def asymmetry_figure(result: ResultFile) -> Figure:
    """The worn edge at the end, its mirror image, and how far they are apart."""
    worn, unworn = (_from_outside(result, result.snapshots[k]) for k in (-1, 0))
    middle = 0.5 * (result.outline[:, 0].min() + result.outline[:, 0].max())
    x = np.linspace(worn[0, 0], worn[-1, 0], 4001)
    height, before = np.interp(x, *worn.T), np.interp(x, *unworn.T)
    mirrored = np.interp(2 * middle - x, *worn.T)
    figure, (upper, lower) = new_figure(2, (2, 1), size=(8, 6.5))
    upper.plot(x, before, color="0.5", lw=1.0, label="unworn")
    upper.plot(x, height, color=COLOURS[0], lw=1.4, label=f"worn, after {result.snapshots[-1].stroke} strokes")
    upper.plot(x, mirrored, color=COLOURS[1], lw=1.0, ls="--", label="its mirror image")
    deepest = int(np.argmax(np.abs(before - height)))
    upper.plot(x[deepest], height[deepest], "o", color=COLOURS[0], ms=4, label=f"deepest, at x = {x[deepest]:.2f} mm")
    lower.plot(x, 1e3 * (height - mirrored), color=COLOURS[1], lw=1.2)
    for axes in (upper, lower):
        axes.axvline(middle, color="k", lw=0.8, ls="-.")
    reach = np.abs(x - middle)[np.abs(before - height) > 1e-3 * np.abs(before - height).max()]
    half = 1.15 * reach.max(initial=1e-3)
    upper.set_xlim(middle - half, middle + half)
    upper.set_ylabel("outline, unloaded: y [mm]")
    upper.set_title(f"{result.scene}: worn edge against its mirror image")
    upper.legend(loc="center")
    lower.set_ylabel("worn less mirrored [µm]")
    lower.set_xlabel("x [mm]; dash-dotted: middle of the unworn part")
    return figure
