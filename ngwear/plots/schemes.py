"""Runs of one scene side by side: ways of integrating the wear in columns, meshes as lines."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ngwear.plots.style import COLOURS, write
from ngwear.plots.wear import worn_edge
from ngwear.results.result_file import read_result


def draw_schemes(runs: Mapping[str, Mapping[str, Path]], strokes: int, file: Path) -> None:
    """Draw pressure and worn outline at the end of each run, also if it stopped early.

    Parameters
    ----------
    runs : mapping of str to mapping of str to Path
        Folders of runs by mesh (a line), by scheme (a column).
    strokes : int
        Of the whole program; a run with fewer strokes is labelled.
    file : Path
        The picture, PNG.

    Raises
    ------
    ResultError
        If a run cannot be read or the picture cannot be written.
    """
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with matplotlib.rc_context({"font.size": 10, "axes.grid": True, "grid.alpha": 0.3}):
        figure = Figure(figsize=(11, 7.5), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots(2, len(runs), sharex=True, sharey="row", squeeze=False)
        for column, (scheme, meshes) in zip(axes.T, runs.items(), strict=True):
            column[0].set_title(scheme)
            for colour, (mesh, folder) in zip(COLOURS, meshes.items(), strict=False):
                last = read_result(folder).snapshots[-1]
                label = mesh if last.stroke == strokes else f"{mesh}: gave up after {last.stroke} of {strokes} steps"
                style = {"color": colour, "lw": 1.0, "marker": ".", "ms": 3}
                for profile in last.profiles.values():
                    on = profile["pressure [MPa]"] > 0
                    place = profile["place [mm]"][on, 0]
                    order = place.argsort()
                    column[0].plot(place[order], profile["pressure [MPa]"][on][order], **style)
                edge = worn_edge(last)
                worn = abs(edge[:, 1] - edge[0, 1]) > 0
                column[1].plot(edge[worn, 0], edge[worn, 1], label=label, **style)
            column[0].set_ylim(bottom=0)
            column[1].set_xlabel("x [mm]")
            column[1].legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2, title="elements of")
        axes[0, 0].set_ylabel("last contact pressure [MPa]")
        axes[1, 0].set_ylabel("outline, unloaded: y [mm]")
        write(figure, file)
