"""Animation of a run: worn outline and contact pressure."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import ResultError
from ngwear.plots.contact_pressures import line_over_x
from ngwear.plots.sections import Box, box, when
from ngwear.plots.stress import directions
from ngwear.plots.style import COLOURS, new_figure
from ngwear.plots.torn import RUBBER
from ngwear.results.result_file import ResultFile, Snapshot, read_result

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

FILE = "evolution.gif"
FRAMES = 120  # at most: some MB
LENGTH, HELD = 10.0, 1.5  # seconds: of the whole, as far as the rates allow, and of the last picture
SLOWEST, FASTEST = 3, 12  # frames a second
DOTS = 110  # per inch
DEEP = 0.02  # of the largest depth: from there on a place counts as worn, and is shown


def animate(folder: Path | str, *, progress: bool = False) -> Path:
    """Draw a wear run into ``evolution.gif`` in its folder; return the path.

    Parameters
    ----------
    folder : Path or str
    progress : bool
        Show a progress bar.

    Raises
    ------
    ResultError
        If the result cannot be read, holds no stroke, or the picture cannot be written.
    """
    import matplotlib
    from matplotlib.animation import PillowWriter
    from tqdm import tqdm

    result = read_result(folder)
    if not result.snapshots:
        raise ResultError(f"{folder}: no stroke has been solved in this run: there is nothing to animate")
    path = Path(folder) / FILE
    shown = frames(result)
    rate = int(np.clip(len(shown) / LENGTH, SLOWEST, FASTEST))
    writer = PillowWriter(fps=rate)
    with matplotlib.rc_context({"font.size": 10, "axes.grid": True, "grid.alpha": 0.3}):
        stage = _Stage(result, shown)
        try:
            with writer.saving(stage.figure, path, DOTS):
                for snapshot in tqdm(shown, disable=not progress, dynamic_ncols=True, desc="drawing", unit="frame"):
                    stage.draw(snapshot)
                    writer.grab_frame()
                for _ in range(round(HELD * rate)):
                    writer.grab_frame()
        except OSError as error:
            raise ResultError(f"{path} cannot be written: {error.strerror or error}") from error
    return path


def frames(result: ResultFile, most: int = FRAMES) -> list[Snapshot]:
    """Solved strokes as evenly over the run as there are, from the first to the last, one for each outline."""
    solved = list({s.stroke: s for s in result.snapshots}.values())
    at = np.array([s.stroke for s in solved])
    nearest = {int(np.abs(at - wanted).argmin()) for wanted in np.linspace(at[0], at[-1], most)}
    return [solved[k] for k in sorted(nearest)]


def worn_window(result: ResultFile) -> Box:
    """Window on what is worn in the end and was there before, unloaded; the whole part if nothing is."""
    from shapely import LinearRing, distance, points

    new, worn = result.snapshots[0].outline, result.snapshots[-1].outline
    depths = [distance(points(a), LinearRing(b)) for a, b in ((new, worn), (worn, new))]
    largest = max(depth.max() for depth in depths)
    gone = [a[depth > DEEP * largest] for a, depth in zip((new, worn), depths, strict=True)] if largest > 0 else [new]
    place = np.vstack(gone)
    return box(place, 0.15 * np.maximum(np.ptp(place, axis=0), 1e-3))


class _Stage:
    """A figure whose lines move from stroke to stroke."""

    def __init__(self, result: ResultFile, shown: list[Snapshot]) -> None:
        self.result, self.kinds = result, directions(result)
        self.figure, (self.face, self.load) = new_figure(2, (1.4, 1.0), size=(9, 6))
        (left, low), (right, high) = worn_window(result)
        new = result.snapshots[0].outline
        (self.rubber,) = self.face.fill(*new.T, facecolor=RUBBER, edgecolor=COLOURS[0], lw=1.2)
        self.face.plot(*np.vstack([new, new[:1]]).T, color="0.35", lw=0.8, ls=":", label="new")
        self.face.set_xlim(left, right)
        self.face.set_ylim(low, high)
        self.face.set_ylabel("outline, unloaded: y [mm]")
        self.face.legend(loc="upper right")
        self.lines = {kind: _line(self.load, kind, colour) for kind, colour in zip(self.kinds, COLOURS, strict=False)}
        peak = max(np.nanmax(_curve(self._at(s, k))[1], initial=1e-6) for s in shown for k in self.kinds)
        self.load.set_ylim(0, 1.08 * peak)
        self.load.set_ylabel("contact pressure [MPa]")
        self.load.set_xlabel("x [mm]; pressure: of the loaded part")
        self.load.legend(loc="upper right")
        self.draw(shown[-1])
        self.figure.canvas.draw()
        self.figure.set_layout_engine("none")  # else the panels would move with the length of the labels

    def draw(self, snapshot: Snapshot) -> None:
        """Show one stroke, and the latest pressures of the other directions."""
        self.rubber.set_xy(snapshot.outline)
        self.face.set_title(f"{self.result.scene}: {when(self.result, snapshot)}")
        for kind, line in self.lines.items():
            line.set_data(*_curve(self._at(snapshot, kind)))

    def _at(self, snapshot: Snapshot, kind: str) -> Snapshot:
        return self.result.at(snapshot.stroke, kind)


def _line(axes: Axes, kind: str, colour: str) -> Any:
    return axes.plot([], [], color=colour, lw=1.2, label=kind)[0]


def _curve(snapshot: Snapshot) -> tuple[Array, Array]:
    """Places and pressures of all contacts, with a gap between one zone and the next."""
    x, p, gap = [np.zeros(0)], [np.zeros(0)], np.array([np.nan])
    for profile in snapshot.profiles.values():
        places, pressures = line_over_x(profile["place [mm]"], profile["pressure [MPa]"])
        x, p = [*x, places, gap], [*p, pressures, gap]
    return np.concatenate(x), np.concatenate(p)
