"""Run a scene of any kind, with estimates of the errors of its results."""

from __future__ import annotations

import tempfile
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any, overload

from ngwear.error_estimates.stated_errors import state_errors, with_parts
from ngwear.errors import SceneError
from ngwear.loop.result import Result
from ngwear.parallel.workers import Worker
from ngwear.results.recorder import Recorder
from ngwear.scene.accuracy import PRESETS, Accuracy
from ngwear.scene.pin_scene import PinScene
from ngwear.scene.scene import Scene
from ngwear.sliding.run_pin import PinResult, run_pin


@overload
def run(
    scene: Scene,
    *,
    out: Path | str | None = ...,
    accuracy: str | float | Accuracy | None = ...,
    alone: bool = ...,
    resume: bool = ...,
    progress: bool = ...,
    throw: bool = ...,
    worker: Worker | None = ...,
) -> Result: ...
@overload
def run(
    scene: Scene | PinScene,
    *,
    out: Path | str | None = ...,
    accuracy: str | float | Accuracy | None = ...,
    alone: bool = ...,
    resume: bool = ...,
    progress: bool = ...,
    throw: bool = ...,
    worker: Worker | None = ...,
) -> Result | PinResult: ...
def run(
    scene: Scene | PinScene,
    *,
    out: Path | str | None = None,
    accuracy: str | float | Accuracy | None = None,
    alone: bool = False,
    resume: bool = False,
    progress: bool = True,
    throw: bool = True,
    worker: Worker | None = None,
) -> Result | PinResult:
    """Run a scene to its last stroke; the result contains estimates of its errors.

    The errors come from coarser runs of the same scene in a second process (``error_estimates.coarser_runs``).

    Parameters
    ----------
    scene : Scene or PinScene
    out : path or None
        Folder for ``series.csv``, ``result.h5``, ``summary.json``, the checkpoint and the figures; without one, only
        the result object remains.
    accuracy : str, float, Accuracy or None
        Replaces the accuracy of the scene: a preset (``"draft"``, ``"engineering"``, ``"reference"``), or the allowed
        relative error of the maximum depth, such as 0.01.
    alone : bool
        Without coarser runs: the error of the mesh is estimated for a part with room to move only
        (``loop.halved_elements``). A scene that requests an error is run at the first
        level only, with a warning.
    resume : bool
        Continue the run in the folder.
    progress : bool
        Show a progress bar.
    throw : bool
        Raise an error when the run gives up; else return a result with the reason. Results so far are saved in both
        cases.
    worker : Worker or None
        The second process, if it has been started already; it ends with the run.

    Returns
    -------
    Result or PinResult

    Raises
    ------
    SceneError
        If the accuracy does not fit the scene.
    ResultError
        If the folder cannot be used.
    ConvergenceError, GeometryError, MeshError
        When the run gives up and ``throw`` is True.
    """
    scene = with_accuracy(scene, accuracy)
    if resume and out is None:
        raise SceneError("run.resume", resume, "needs the folder of the earlier run: give out=...")
    with nullcontext(out) if out is not None else tempfile.TemporaryDirectory(prefix="ngwear ") as folder:
        path, keeps = Path(str(folder)), out is not None
        if isinstance(scene, PinScene):
            if worker is not None:
                worker.end()
            found = run_pin(scene, out=path, resume=resume, progress=progress, throw=throw, figures=keeps)
            return found if keeps else replace(found, folder=None)
        if alone:
            return _run_alone(scene, path if keeps else None, resume=resume, progress=progress, throw=throw)
        if scene.accuracy.error is not None:
            from ngwear.error_estimates.run_to_error import run_to_error

            result = run_to_error(
                scene, out=path, resume=resume, progress=progress, throw=throw, figures=keeps, worker=worker
            )
        else:
            from ngwear.error_estimates.coarser_runs import run_with_coarser_runs

            result = run_with_coarser_runs(
                scene, out=path, resume=resume, progress=progress, throw=throw, figures=keeps, worker=worker
            )
        return result if keeps else replace(result, folder=None)


def _run_alone(scene: Scene, out: Path | None, *, resume: bool, progress: bool, throw: bool) -> Result:
    """Run a scene without coarser runs; one that asks for an error by the level that such runs begin with."""
    from ngwear.loop.run import run as run_scene

    asks = scene.accuracy.error is not None
    if asks:
        from ngwear.error_estimates.run_to_error import first_level

        scene = first_level(scene)

    def state(_: Recorder, summary: dict[str, Any]) -> None:
        errors = summary["error estimates"]
        state_errors(summary, errors | with_parts(errors))
        if asks:
            summary["warnings"].append("run alone: the error that the scene asks for is not checked")

    return run_scene(
        scene, out=out, resume=resume, progress=progress, throw=throw, figures=out is not None, errors=state
    )


def with_accuracy(scene: Scene | PinScene, accuracy: str | float | Accuracy | None) -> Scene | PinScene:
    """The scene with a preset, an allowed error, or another Accuracy; unchanged for None.

    Raises
    ------
    SceneError
        If the accuracy is none of these, or for a pin: its mesh is set in the scene.
    """
    if accuracy is None:
        return scene
    if isinstance(scene, PinScene):
        raise SceneError("accuracy", accuracy, "cannot be given for a pin: set its mesh in [accuracy] of the scene")
    if isinstance(accuracy, Accuracy):
        return replace(scene, accuracy=accuracy)
    try:
        new = Accuracy.preset(accuracy) if accuracy in PRESETS else Accuracy(error=float(accuracy))
    except SceneError:
        raise
    except (ValueError, TypeError):
        raise SceneError("accuracy", accuracy, f"must be one of {list(PRESETS)}, or a number below 1") from None
    return replace(scene, accuracy=scene.accuracy.with_tolerances_of(new))


def read_result(folder: Path | str) -> Result | PinResult:
    """Read the result of a run of any kind from its folder.

    Raises
    ------
    ResultError
        If the folder holds no run, or its files are damaged.
    """
    from ngwear.plots.pin import is_pin_run

    return PinResult.read(folder) if is_pin_run(Path(folder)) else Result.read(folder)
