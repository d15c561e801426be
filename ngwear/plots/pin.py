"""Figures of a pin on a plate, from the file of a run."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import ResultError
from ngwear.files.hdf5 import get_series, require_layout, stored_name
from ngwear.plots.style import write
from ngwear.scene.pin_scene import KIND

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure
    from mpl_toolkits.mplot3d import Axes3D

Array = NDArray[np.float64]
WHOLE, SURFACE, INTERNAL = "#222222", "#1b6ca8", "#d1495b"


@dataclass(frozen=True)
class SheetPicture:
    """The sheet's top at one speed: contact's edge from above, deformed faces [mm] and their pressures [MPa]."""

    speed: float
    edge: Array
    corners: Array
    pressure: Array

    @property
    def loaded(self) -> NDArray[np.bool_]:
        """Faces that carry more than a hundredth of the peak."""
        return self.pressure > 0.01 * self.pressure.max()


@dataclass(frozen=True)
class PinFile:
    """Contents of a run's file: columns as in ``series.csv`` by speed, the sheet at each speed, stated errors."""

    thickness: float
    series: dict[str, Array]
    sheets: list[SheetPicture]
    errors: dict[str, float]


def is_pin_run(folder: Path | str) -> bool:
    """Whether the folder's result is that of a pin on a plate."""
    import h5py

    try:
        with h5py.File(Path(folder) / "result.h5", "r") as h5:
            return h5.attrs.get("kind") == KIND
    except OSError:
        return False


def read_pin(folder: Path | str) -> PinFile:
    """Read a run's ``result.h5``.

    Raises
    ------
    ResultError
        If the file is missing, damaged, or of another layout.
    """
    import h5py

    file = Path(folder) / "result.h5"
    try:
        with h5py.File(file, "r") as h5:
            require_layout(h5, file)
            series = get_series(h5)
            order = np.argsort(series["speed [mm/s]"])
            groups = [h5[f"speeds/{k:03d}"] for k in order]
            sheets = [
                SheetPicture(
                    float(g.attrs[stored_name("speed [mm/s]")]),
                    g["edge of the contact [mm]"][()],
                    g["faces/corners, deformed [mm]"][()],
                    g["faces/pressure [MPa]"][()],
                )
                for g in groups
            ]
            errors = json.loads(h5.attrs.get("summary", "{}")).get("error estimates", {})
            return PinFile(float(h5.attrs["thickness [mm]"]), {k: v[order] for k, v in series.items()}, sheets, errors)
    except (OSError, KeyError, ValueError, AttributeError, TypeError, RuntimeError) as error:
        raise ResultError(f"{file} cannot be read as a result of ngwear: {error}") from error


def plot_pin(folder: Path | str) -> list[Path]:
    """Draw friction, contact, and the sheet at the slowest and the fastest speed; return the files.

    Raises
    ------
    ResultError
        If the result cannot be read or the pictures cannot be written.
    """
    result = read_pin(folder)
    drawn = {
        "friction": friction_figure(result),
        "contact": contact_figure(result),
        "sheet_slowest": sheet_figure(result, 0),
        "sheet_fastest": sheet_figure(result, -1),
    }
    for name, figure in drawn.items():
        write(figure, Path(folder) / f"{name}.png", dpi=130)
    return [Path(folder) / f"{name}.png" for name in drawn]


def friction_figure(result: PinFile) -> Figure:
    """Friction coefficient against speed, in the band of its stated error, and its parts, by force and by energy."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 4.5), layout="constrained")
    axis = figure.subplots()
    for column, style, colour, label in (
        ("friction coefficient [-]", "o-", WHOLE, "whole"),
        ("from surface friction [-]", "s-", SURFACE, "from surface friction"),
        ("from the pressure [-]", "s-", INTERNAL, "from the pressure"),
        ("heat of the slip over load and track [-]", "--", SURFACE, "heat of the slip"),
        ("heat in the rubber over load and track [-]", "--", INTERNAL, "heat in the rubber"),
    ):
        axis.semilogx(result.series["speed [mm/s]"], result.series[column], style, color=colour, label=label)
    _band(axis, result, "friction coefficient [-]", "friction coefficient [-]", WHOLE)
    axis.set_ylim(bottom=0)
    axis.set_xlabel("sliding speed [mm/s]")
    axis.set_ylabel("friction coefficient [-]")
    axis.grid(alpha=0.3, which="both")
    axis.legend(ncols=2)
    return figure


def _band(axis: Axes, result: PinFile, column: str, error: str, colour: str) -> None:
    """Band of a relative error about a column, if the run has stated it."""
    values, off = result.series[column], result.errors.get(error, 0.0)
    speeds = result.series["speed [mm/s]"]
    axis.fill_between(speeds, (1 - off) * values, (1 + off) * values, color=colour, alpha=0.2, lw=0)


def contact_figure(result: PinFile) -> Figure:
    """Penetration and contact area against speed, in the bands of their stated errors."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 4.5), layout="constrained")
    left = figure.subplots()
    right = left.twinx()
    speed, series = result.series["speed [mm/s]"], result.series
    (depth,) = left.semilogx(speed, series["penetration [mm]"], "o-", color=SURFACE)
    (area,) = right.semilogx(speed, series["contact area [mm²]"], "s-", color=INTERNAL)
    _band(left, result, "penetration [mm]", "maximum depth [-]", SURFACE)
    _band(right, result, "contact area [mm²]", "contact area [-]", INTERNAL)
    left.set_xlabel("sliding speed [mm/s]")
    left.set_ylabel("penetration [mm]", color=SURFACE)
    right.set_ylabel("contact area [mm²]", color=INTERNAL)
    left.set_ylim(0, 1.25 * series["penetration [mm]"].max())
    right.set_ylim(0, 1.6 * series["contact area [mm²]"].max())
    left.grid(alpha=0.3, which="both")
    left.legend([depth, area], ["penetration", "contact area"], loc="lower left")
    return figure


def sheet_figure(result: PinFile, number: int) -> Figure:
    """The deformed sheet with its pressure: in perspective, and the contact from above."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

    sheet, depth = result.sheets[number], result.series["penetration [mm]"][number]
    figure = Figure(figsize=(13, 5.2), layout="constrained")
    grid = figure.add_gridspec(1, 2, width_ratios=(1.3, 1))
    space = figure.add_subplot(grid[0], projection="3d")
    above = figure.add_subplot(grid[1])
    colours = ScalarMappable(Normalize(0.0, sheet.pressure.max()), "viridis")
    _draw_surface(space, sheet, result.thickness, colours)
    _draw_patch(above, sheet, colours)
    figure.colorbar(colours, ax=above, label="contact pressure [MPa]")
    figure.suptitle(f"{sheet.speed:g} mm/s, the pin moves towards +x; penetration {depth:.3f} mm")
    return figure


def _draw_surface(axis: Axes3D, sheet: SheetPicture, thickness: float, colours: ScalarMappable) -> None:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    reach = np.ptp(sheet.edge[:, 0])
    shown = np.abs(sheet.corners[..., :2]).max(axis=(1, 2)) < 1.2 * reach
    faces = Poly3DCollection(sheet.corners[shown], edgecolors="0.3", linewidths=0.15)
    colour = colours.to_rgba(sheet.pressure[shown])
    colour[~sheet.loaded[shown]] = (0.88, 0.88, 0.88, 1.0)
    faces.set_facecolor(colour)
    axis.add_collection3d(faces)
    axis.set_xlim(-reach, reach)
    axis.set_ylim(-reach, reach)
    axis.set_zlim(0, 1.1 * thickness)
    axis.set_box_aspect((2 * reach, 2 * reach, 1.1 * thickness), zoom=1.25)
    axis.view_init(elev=32, azim=-62)
    axis.set_xlabel("x [mm]")
    axis.set_ylabel("y [mm]")
    axis.set_zlabel("z [mm]")


def _draw_patch(axis: Axes, sheet: SheetPicture, colours: ScalarMappable) -> None:
    from matplotlib.collections import PolyCollection

    patch = PolyCollection(list(sheet.corners[sheet.loaded][..., :2]), edgecolors="face", linewidths=0.2)
    patch.set_facecolor(list(colours.to_rgba(sheet.pressure[sheet.loaded])))
    axis.add_collection(patch)
    edge = np.vstack([sheet.edge, sheet.edge[:1]])
    axis.plot(*edge.T, color="#d1495b", lw=1.5, label="contact's edge")
    axis.plot(0, 0, "w+")
    axis.set_aspect("equal")
    axis.set_xlabel("along the track, x [mm]")
    axis.set_ylabel("towards the track's centre, y [mm]")
    axis.legend(loc="upper right")
