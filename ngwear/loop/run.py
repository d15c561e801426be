"""Run a scene to its last stroke, with files, figures, progress bar and resumption."""

from __future__ import annotations

import logging
import re
import sys
import time
from collections.abc import Callable
from copy import copy
from pathlib import Path
from typing import Any, Protocol

from ngwear.errors import ConvergenceError, GeometryError, MeshError, ResultError
from ngwear.files.result_folder import COMPLETED, GAVE_UP
from ngwear.loop.checkpoint import load, save
from ngwear.loop.friction_left_out import friction_errors
from ngwear.loop.halved_elements import add_mesh_errors, faded
from ngwear.loop.result import Result
from ngwear.loop.state import State
from ngwear.loop.stepper import Stepper
from ngwear.results.kept_sections import KeptSections
from ngwear.results.recorder import Folder, Recorder
from ngwear.scene.scene import Scene

log = logging.getLogger(__name__)

NO_NAME = re.compile(r'[<>:"/\\|?*\x00-\x1f]')  # what file names cannot hold on one platform or another


class Drawing(Protocol):
    """Interface of an object that draws the figures of a run."""

    def draw_section(self, folder: Path, kept: KeptSections) -> None:
        """Draw the loaded section of the unworn part, here or in another process."""

    def draw_all(self, folder: Path) -> None:
        """Draw all figures; the files exist when this returns."""


class LocalDrawing:
    """Draws the figures of a run in this process."""

    def draw_section(self, folder: Path, kept: KeptSections) -> None:
        """Draw the loaded section."""
        from ngwear.plots.wear import plot_section

        plot_section(folder, kept)

    def draw_all(self, folder: Path, share: tuple[int, int] = (0, 1)) -> None:
        """Draw all figures, or a share of them (``ngwear.plots.wear.plot``)."""
        from ngwear.plots.wear import plot

        plot(folder, share=share)


def run(
    scene: Scene,
    *,
    out: Path | str | None = None,
    resume: bool = False,
    progress: bool = False,
    throw: bool = True,
    figures: bool = True,
    on_step: Callable[[State], None] | None = None,
    errors: Callable[[Recorder, dict[str, Any]], None] | None = None,
    draw: Drawing | None = None,
) -> Result:
    """Run a scene to its last stroke, without coarser runs: the error of the mesh is not estimated.

    Parameters
    ----------
    scene : Scene
    out : path or None
        Folder for ``series.csv``, ``result.h5``, ``summary.json``, the checkpoint and the figures.
    resume : bool
        Continue from the checkpoint in the folder.
    progress : bool
        Show a progress bar with depth, cycles in a solve and remaining time.
    throw : bool
        Raise an error when the run gives up; else return a result with the reason. Results so far are saved in both
        cases.
    figures : bool
        Draw figures into the folder: the loaded section after mounting, all figures at the end.
    on_step : callable or None
        Called with the state after mounting and after each accepted step.
    errors : callable or None
        Called with records and summary of a completed run after all data are written; it may add errors to the
        summary. Errors by the mesh (``halved_elements``) are computed with it only.
    draw : Drawing or None
        Draws the figures; default: this process.

    Raises
    ------
    ResultError
        If the folder cannot be used.
    ConvergenceError, GeometryError, MeshError
        When the run gives up and ``throw`` is True.
    """
    on_step, draw = on_step or (lambda state: None), draw or LocalDrawing()
    folder = None if out is None else Folder(Path(out), scene, resume=resume)
    saved = load(folder, scene) if folder is not None and resume else None
    wall, cpu = time.perf_counter(), time.process_time()
    state, recorder = saved if saved is not None else (None, Recorder(scene))
    wall, cpu = wall - recorder.wall, cpu - recorder.cpu
    error: Exception | None = None
    with _Bar(scene, shown=progress) as bar:
        stepper = Stepper(scene, on_mount=bar.mounting)
        try:
            if state is None:
                state = stepper.start()
                if errors is not None:
                    add_mesh_errors(state)
                _keep(folder, state, recorder, wall, cpu)
                if folder is not None and figures and recorder.snapshots:
                    draw.draw_section(folder.path, recorder.sections)
                on_step(state)
            bar.begin(state, recorder)
            while not stepper.finished(state):
                state = stepper.advance(state)
                _keep(folder, state, recorder, wall, cpu)
                on_step(state)
                bar.update(state, recorder)
        except (ConvergenceError, GeometryError, MeshError) as failure:
            error = failure
    if error is not None and state is not None:
        _keep_last(stepper, state, recorder)
    by_time_step, warnings = _by_time_step(state) if state is not None and error is None else ({}, [])
    apart: dict[str, float] = {}
    if state is not None and error is None and errors is not None:
        warnings += add_mesh_errors(state)
        apart, says = _that_stand_apart(state)
        warnings += says
    recorder.wall, recorder.cpu = time.perf_counter() - wall, time.process_time() - cpu
    status = COMPLETED if error is None else GAVE_UP
    message, blown = "all strokes done", None if state is None else stepper.blown(state)
    if state is not None and blown is not None:
        message = (
            f"ended by blow-by after stroke {scene.program.counted(state.strokes)}: the "
            f"{blown.pressure:.3g} MPa of '{blown.inlet}' opens the contact "
            f"at '{blown.edge}', which carries {blown.holds:.3g} MPa at most"
        )
    if error is not None:
        done = None if state is None else scene.program.counted(state.strokes)
        message = f"{'the part cannot be mounted' if done is None else f'after stroke {done}'}: {error}"
    times = {"wall time [s]": round(recorder.wall, 3), "CPU time [s]": round(recorder.cpu, 3)}
    summary: dict[str, Any] = {"status": status, "message": message, "scene": scene.name, "strokes": 0, **times}
    if state is not None:
        summary = recorder.summary(state, status, message)
        summary["error estimates"] |= by_time_step
        if error is None and errors is not None:
            summary["error estimates"] |= faded(state) | apart
        summary["warnings"] += warnings
    if folder is not None:
        folder.finish(recorder, summary)
        if scene.save.vtk and state is not None:
            _write_vtk(folder.path, state)
    try:
        if errors is not None and state is not None and error is None:
            errors(recorder, summary)
            summary["wall time [s]"] = round(time.perf_counter() - wall, 3)
            if folder is not None:
                folder.finish(recorder, summary)
    finally:  # an interruption while waiting for the coarser runs loses no figure
        if folder is not None and figures and recorder.rows:
            draw.draw_all(folder.path)
    if error is not None and throw:
        raise error
    return Result(status, message, summary, recorder, state, error, None if folder is None else folder.path)


def _keep(folder: Folder | None, state: State, recorder: Recorder, wall: float, cpu: float) -> None:
    recorder.wall, recorder.cpu = time.perf_counter() - wall, time.process_time() - cpu
    recorder.add(state, wall=recorder.wall)
    if folder is not None:
        save(folder, state, recorder)


def _keep_last(stepper: Stepper, state: State, recorder: Recorder) -> None:
    """Save the loaded section at which a run gave up: it often shows the reason."""
    phases, memory = state.phases, state.memory
    state.phases, state.memory = list(phases), copy(memory)
    try:
        recorder.add_sections(stepper.solve_next_cycle(state))
    except (ConvergenceError, GeometryError, MeshError) as error:
        log.info("the last section is not saved: %s", error)
    finally:
        state.phases, state.memory = phases, memory
        stepper.restore_last_stroke(state)


def _by_time_step(state: State) -> tuple[dict[str, float], list[str]]:
    """Errors by the time step of rubber with memory; a warning if the estimate fails."""
    if state.memory is None:
        return {}, []
    from ngwear.loop.time_step_error import time_step_errors

    try:
        return time_step_errors(state), []
    except ConvergenceError as error:
        return {}, [f"the error of the time step is not known: a cycle with half the time step gave up ({error})"]


def _that_stand_apart(state: State) -> tuple[dict[str, float], list[str]]:
    """Errors by friction that the part does not bear, and by fluid that a contact just holds; warnings if one fails."""
    errors: dict[str, float] = {}
    warnings: list[str] = []
    try:
        errors |= friction_errors(state)
    except ConvergenceError as error:
        warnings.append(f"the error by the friction left out is not known: a cycle with less of it gave up ({error})")
    if state.stage.fluids:
        from ngwear.loop.fluid_let_in import fluid_errors

        try:
            errors |= fluid_errors(state)
        except ConvergenceError as error:
            why = f"the cycle with it gave up ({error})"
            warnings.append(f"the error by the fluid that may come in is not known: {why}")
    return errors, warnings


def _write_vtk(path: Path, state: State) -> None:
    """Write the last state of each stroke of the cycle as VTK files for ParaView."""
    import ngsolve as ng

    from ngwear.effects.base import DISPLACEMENT, VOLUMETRIC_STRESS

    stage = state.stage
    for stroke, phase in zip(stage.scene.program.cycle, state.phases, strict=True):
        stage.problem.state.vec.FV().NumPy()[:] = phase.vector
        fields = stage.problem.fields
        writer = ng.VTKOutput(
            stage.body.mesh,
            coefs=[fields[DISPLACEMENT], fields[VOLUMETRIC_STRESS]],
            names=[DISPLACEMENT, VOLUMETRIC_STRESS.replace(" ", "_")],
            filename=str(path / f"stroke_{state.strokes}_{NO_NAME.sub('_', stroke.name)}"),
            subdivision=1,
        )
        try:
            writer.Do()
        except Exception as error:
            raise ResultError(f"{path}: the VTK file cannot be written: {error}") from error


class _Bar:
    """Progress bar: mounting in per cent, then strokes with depth and cycles in a solve; warnings as they come."""

    def __init__(self, scene: Scene, *, shown: bool) -> None:
        from tqdm import tqdm

        self._make = lambda **kwargs: tqdm(disable=not shown, dynamic_ncols=True, **kwargs)
        self._scene, self._warns, self._said = scene, shown, set[str]()
        self._bar: Any = None

    def __enter__(self) -> _Bar:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def mounting(self, fraction: float) -> None:
        if self._bar is None:
            self._bar = self._make(total=100, desc="mounting", unit="%")
        self._bar.update(round(100 * fraction) - self._bar.n)

    def begin(self, state: State, recorder: Recorder) -> None:
        if self._bar is not None:
            self._bar.close()
        total, done = self._done(self._scene.program.strokes), self._done(state.strokes)
        self._bar = self._make(total=total, initial=done, desc="wear", unit="stroke")
        self._warn(recorder)

    def _warn(self, recorder: Recorder) -> None:
        """Say once what a solve shows, when it does so first: the summary has the worst case of each."""
        for key, (_, stroke, sentence) in recorder.findings.items():
            if self._warns and key not in self._said:
                self._bar.write(f"warning: {sentence} (stroke {stroke})", file=sys.stderr)
            self._said.add(key)

    def _done(self, strokes: int) -> float:
        return self._scene.program.counted(strokes)

    def update(self, state: State, recorder: Recorder) -> None:
        row = recorder.rows[-1]
        self._bar.update(self._done(state.strokes) - self._bar.n)
        self._bar.set_postfix_str(
            f"depth {1e3 * row['maximum depth [mm]']:.1f} µm, {row['strokes in one solve [-]']} a solve"
        )
        self._warn(recorder)
