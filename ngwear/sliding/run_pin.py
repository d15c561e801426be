"""Run a pin on a plate at all its speeds, with files, pictures, progress and resumption."""

from __future__ import annotations

import csv
import functools
import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact_patch import Faces
from ngwear.equilibrium.stepping import Work
from ngwear.errors import ConvergenceError, ResultError
from ngwear.files.hdf5 import mark, put, put_series, stored_name, write
from ngwear.files.result_folder import COMPLETED, FIELDS, GAVE_UP, SERIES, SUMMARY, OutFolder
from ngwear.files.subnormal import without_subnormals
from ngwear.parallel.sweep import Outcome, sweep
from ngwear.results.closing_table import closing_table
from ngwear.results.richardson import relative_errors
from ngwear.scene.pin_scene import KIND, PinScene
from ngwear.sliding.patch import Patch
from ngwear.sliding.pin import COARSER, PinSlide, slide_pin
from ngwear.units import UNITS

POINTS = "points"
Pair = tuple[PinSlide, PinSlide]
READINGS: dict[str, Callable[[PinSlide], float]] = {
    "friction coefficient [-]": lambda slide: slide.friction,
    "maximum depth [-]": lambda slide: slide.depth,
    "contact area [-]": lambda slide: slide.patch.area,
    "peak pressure [-]": lambda slide: slide.peak,
}
ORDERS = dict.fromkeys(READINGS, 2.0)  # of convergence; settled on the pin (``verify error_estimates``)


@dataclass(frozen=True)
class PinResult:
    """Result of a run of a pin; ``print`` shows a table with the stated errors.

    Attributes
    ----------
    status : str
        ``"completed"`` or ``"gave up"``.
    message : str
        Why it stopped.
    summary : dict
        As in ``summary.json``.
    series : dict of array
        Columns as in ``series.csv``, one value a speed; ``pandas.DataFrame`` takes them.
    folder : Path or None
        Where its files are.
    """

    status: str
    message: str
    summary: dict[str, Any]
    series: dict[str, NDArray[Any]]
    folder: Path | None = None

    @classmethod
    def read(cls, folder: Path | str) -> PinResult:
        """Read what a run has left in its folder.

        Raises
        ------
        ResultError
            If it is missing or damaged.
        """
        path = Path(folder)
        try:
            summary = json.loads((path / SUMMARY).read_text(encoding="utf-8"))
            with (path / SERIES).open(newline="", encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            series = {name: np.array([float(row[name]) for row in rows]) for name in (rows[0] if rows else ())}
            return cls(summary["status"], summary["message"], summary, series, path)
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise ResultError(f"{path} cannot be read as a run of a pin: {error}") from error

    def __str__(self) -> str:
        return closing_table(self.summary)

    def plot(self) -> list[Path]:
        """Draw the figures into the folder; return their files.

        Raises
        ------
        ResultError
            If the run kept nothing, or its file is damaged.
        """
        if self.folder is None:
            raise ResultError("the run kept nothing: give it a folder by out=...")
        from ngwear.plots.pin import plot_pin

        return list(plot_pin(self.folder))


def run_pin(
    scene: PinScene,
    *,
    out: Path | str,
    resume: bool = False,
    progress: bool = False,
    workers: int | None = None,
    figures: bool = True,
    throw: bool = False,
) -> PinResult:
    """Slide at every speed of the scene, two at a time, and write series, fields, summary and figures.

    A speed that fails does not lose the others: the summary's status is then ``"gave up"`` and its message names it.

    Parameters
    ----------
    scene : PinScene
    out : path
        Folder; what each speed found is kept there as soon as it is known.
    resume : bool
        Go on with the speeds that are missing.
    progress : bool
        Show a progress bar.
    workers : int or None
        Processes; by default as many as cores.
    figures : bool
        Draw the figures.
    throw : bool
        Raise if a speed failed, once the others are saved.

    Raises
    ------
    ResultError
        If the folder cannot be used.
    ConvergenceError
        If a speed failed and ``throw`` is True.
    """
    wall = time.perf_counter()
    folder = OutFolder(Path(out), POINTS, resume=resume)
    slide = functools.partial(slide_pin, scene.pin, mesh=scene.mesh, vtk=folder.path if scene.vtk else None)
    outcomes = sweep(
        slide,
        scene.speeds,
        folder=folder.path / POINTS,
        resume=resume,
        workers=workers,
        progress=progress,
        classes=(PinSlide, Patch, Faces, Work),
    )
    pairs = [o.result for o in outcomes if o.ok]
    summary = _summary(scene, outcomes, pairs, time.perf_counter() - wall)
    folder.clear()
    rows = [row(*pair) for pair in pairs]
    folder.write_series(rows)
    folder.replace(FIELDS, lambda file: write(file, lambda h5: _fill(h5, scene, pairs, summary)))
    folder.write_json(SUMMARY, summary)
    if figures and pairs:
        from ngwear.plots.pin import plot_pin

        plot_pin(folder.path)
    if throw and summary["status"] == GAVE_UP:
        raise ConvergenceError(summary["message"])
    series = {name: np.array([row[name] for row in rows]) for name in (rows[0] if rows else ())}
    return PinResult(summary["status"], summary["message"], summary, series, folder.path)


def row(coarse: PinSlide, fine: PinSlide) -> dict[str, float]:
    """One line of ``series.csv``."""
    return {
        "speed [mm/s]": fine.speed,
        "friction coefficient [-]": fine.friction,
        "from surface friction [-]": fine.surface_friction,
        "from the pressure [-]": fine.internal_friction,
        "heat of the slip over load and track [-]": fine.slip_work,
        "heat in the rubber over load and track [-]": fine.dissipation,
        "penetration [mm]": fine.depth,
        "contact area [mm²]": fine.patch.area,
        "peak pressure [MPa]": fine.peak,
        "friction on the coarse mesh [-]": coarse.friction,
        "penetration on the coarse mesh [mm]": coarse.depth,
        "elements [-]": fine.elements,
        "elements in contact [-]": int((fine.faces.pressure > 0).sum()),
        "solves [-]": coarse.work.solves + fine.work.solves,
        "CPU time [s]": fine.cpu_seconds,
    }


def readings(slides: list[PinSlide]) -> dict[str, dict[str, list[float]]]:
    """Results at all speeds, by the name of their error."""
    return {error: {error: [read(slide) for slide in slides]} for error, read in READINGS.items()}


def estimates(scene: PinScene, pairs: list[Pair]) -> dict[str, float]:
    """Relative errors of the results, as root mean square over the speeds: each total, then its parts by name.

    Of elements and columns (the time steps) from the two meshes of each speed; of the relaxation times left out (fast:
    relaxed at once; slow: part of the elastic stiffness) their bound, at the worst speed. Integrals over the contact
    converge with the square of the error of the strains, and time steps are of second order.
    """
    folded = max(scene.mesh.folding(scene.pin.arms, fine.speed).bound for _, fine in pairs)
    coarse, fine = (readings([pair[k] for pair in pairs]) for k in (0, 1))
    levels = relative_errors(fine, coarse, ratio=COARSER, orders=ORDERS)
    return (
        {name: error + folded for name, error in levels.items()}
        | {f"{name[:-4]} by mesh and time steps [-]": error for name, error in levels.items()}
        | {"stress by arms folded away [-]": folded}
    )


def _summary(scene: PinScene, outcomes: list[Outcome], pairs: list[Pair], wall: float) -> dict[str, Any]:
    failed = [f"{o.point:g} mm/s: {o.failure.message}" for o in outcomes if o.failure is not None]
    summary: dict[str, Any] = {
        "status": GAVE_UP if failed else COMPLETED,
        "message": "; ".join(failed) or "all speeds done",
        "scene": scene.name,
        "speeds done [-]": len(pairs),
    }
    fine = [pair[1] for pair in pairs]
    if pairs:
        works = [slide.work for pair in pairs for slide in pair]
        energy = max(abs((s.dissipation + s.slip_work) / s.friction - 1) for s in fine)
        summary |= {
            "maximum depth [mm]": max(s.depth for s in fine),
            "penetration, largest less smallest [mm]": max(s.depth for s in fine) - min(s.depth for s in fine),
            "peak pressure [MPa]": max(s.peak for s in fine),
            "highest friction coefficient [-]": max(s.friction for s in fine),
            "lowest friction coefficient [-]": min(s.friction for s in fine),
            "worn volume [mm³]": 0.0,
            "solves": sum(w.solves for w in works),
            "retries": sum(w.retries for w in works),
            "error estimates": estimates(scene, pairs)
            | {
                "friction, between two meshes [-]": max(abs(b.friction / a.friction - 1) for a, b in pairs),
                "penetration, between two meshes [-]": max(abs(b.depth / a.depth - 1) for a, b in pairs),
                "friction, energy against force [-]": energy,
            },
        }
    cpu = sum(s.cpu_seconds for s in fine)
    return summary | {"wall time [s]": round(wall, 3), "CPU time [s]": round(cpu, 3)}


def _fill(h5: Any, scene: PinScene, pairs: list[Pair], summary: dict[str, Any]) -> None:
    mark(h5, scene.name)
    h5.attrs["kind"] = KIND
    h5.attrs["thickness [mm]"] = scene.pin.thickness
    h5.attrs["units"], h5.attrs["summary"] = json.dumps(UNITS), json.dumps(without_subnormals(summary))
    put_series(h5, [row(*pair) for pair in pairs])
    for number, (_, slide) in enumerate(pairs):
        group = h5.create_group(f"speeds/{number:03d}")
        group.attrs[stored_name("speed [mm/s]")] = slide.speed
        put(group, "edge of the contact [mm]", slide.patch.edge)
        faces = group.create_group("faces")
        put(faces, "corners, deformed [mm]", slide.faces.corners)
        put(faces, "centres, undeformed [mm]", slide.faces.reference)
        put(faces, "pressure [MPa]", slide.faces.pressure)
