"""What a run says of its own error: the same scene once more, coarser in every setting, and how far both are apart.

A hierarchical estimate of what is read off, mesh and wear step together. With elements of twice the edge, and jumps
that may err by twice as much, an error of first order doubles: what both runs differ by is the error of the finer one.
An error of second order would be a third of that, one of order 1/2 two and a half times as large. It cannot see what
both runs share: the outline's points, the laws and their constants, and errors that happen to cancel.
"""

from __future__ import annotations

import json
import os
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from ngwear.errors import NgwearError
from ngwear.results import Recorder, fingerprint
from ngwear.run import Result
from ngwear.run import run as run_scene
from ngwear.scene import Scene
from ngwear.sweep import end_with_parent, one_thread

COARSER = 2.0
FILE = "companion.json"  # in the run's folder: a resumed run finds it there
WHOLE = {"maximum depth [mm]": "maximum depth [-]", "worn area [mm^2]": "worn area [-]"}
COSTS = (("solves", ""), ("elements", ""), ("CPU time", " [s]"))
STROKE = {name: f"{name} [-]" for name in ("peak pressure", "contact width", "friction force")}


def scaled(scene: Scene, factor: float) -> Scene:
    """The scene with elements of so many times the edge, and jumps that may err by as many times as much."""
    accuracy = scene.accuracy
    patch = factor * accuracy.patch
    changed = replace(
        accuracy,
        patch=patch,
        coarse=factor * accuracy.coarse,
        mounting=max(accuracy.mounting, patch),
        stress_error=min(1.0, factor**2 * accuracy.stress_error),
        wear_error=min(0.5, factor * accuracy.wear_error),
    )
    return replace(scene, accuracy=changed)


def coarser(scene: Scene) -> Scene:
    """A scene's companion; it keeps nothing."""
    return replace(scaled(scene, COARSER), save=replace(scene.save, strokes=(), vtk=False))


def reading(summary: dict[str, Any], rows: list[dict[str, Any]]) -> dict[str, dict[str, float]]:
    """What is read off at the end, by the name of its error: depth, area, and what acts in each kind of stroke."""
    out = {error: {name: float(summary[name])} for name, error in WHOLE.items()}
    latest = {row["kind [-]"]: row for row in rows}
    for kind, row in latest.items():
        for words, error in STROKE.items():
            found = {f"{kind}: {c}": float(v) for c, v in row.items() if f" {words} " in c and not c.endswith("[-]")}
            out.setdefault(error, {}).update(found)
    return out


def estimates(mine: dict[str, dict[str, float]], other: dict[str, dict[str, float]]) -> dict[str, float]:
    """Relative error of each quantity from a run's and its companion's readings, of the worst stroke's largest value.

    Errors of forces and pressures are taken relative to the largest of their kind: a component that vanishes has none.
    """
    out = {}
    for error, values in mine.items():
        scale = max((abs(v) for v in values.values()), default=0.0)
        off = max((abs(v - other[error].get(name, 0.0)) for name, v in values.items()), default=0.0)
        out[error] = off / scale if scale > 0 else 0.0
    return out


def run_stated(
    scene: Scene, *, out: Path | str, resume: bool = False, progress: bool = False, throw: bool = True
) -> Result:
    """Run a scene and its companion, side by side in two processes; ``summary["error estimates"]`` is from both.

    Parameters and errors as ``run``. A companion that gives up loses nothing: the summary then warns that the error of
    the mesh is not known.
    """
    companion = _Companion(coarser(scene), Path(out) / FILE)
    with companion:
        return run_scene(
            scene,
            out=out,
            resume=resume,
            progress=progress,
            throw=throw,
            on_step=companion.begin,
            errors=companion.state,
        )


class _Companion:
    """A run in a process of its own, which leaves its readings in a file; an earlier one's are taken from there."""

    def __init__(self, scene: Scene, file: Path) -> None:
        self.scene, self.file, self.process = scene, file, None
        self.begun = False

    def __enter__(self) -> _Companion:
        return self

    def __exit__(self, *_: object) -> None:
        if self.process is not None and self.process.is_alive():
            self.process.terminate()
            self.process.join()

    def begin(self, _: Any = None) -> None:
        """Start it, once, unless its readings are there."""
        if self.begun:
            return
        self.begun = True
        if self._left() is None:
            with one_thread():
                self.process = get_context("spawn").Process(target=_leave, args=(self.scene, self.file), daemon=True)
                self.process.start()

    def state(self, recorder: Recorder, summary: dict[str, Any]) -> None:
        """Wait for it, and put the estimates into the summary of the run."""
        self.begin()
        if self.process is not None:
            self.process.join()
        left = self._left()
        if left is None or "gave up" in left:
            why = "ended without a word" if left is None else f"gave up: {left['gave up']}"
            summary["warnings"].append(f"the coarser companion run {why}; the error of the mesh is not known")
            return
        stepping = summary["error estimates"]
        embedded = {f"{name[:-4]} by the wear steps alone [-]": stepping[name] for name in WHOLE.values()}
        found = estimates(reading(summary, recorder.rows), left["reading"])
        summary["error estimates"] = stepping | embedded | found
        summary |= left["cost"]

    def _left(self) -> dict[str, Any] | None:
        try:
            left = json.loads(self.file.read_text())
        except (OSError, ValueError):
            return None
        return left if left.get("scene") == fingerprint(self.scene) else None


def _leave(scene: Scene, file: Path) -> None:
    """Run a scene, its readings or its failure into a file, written whole."""
    end_with_parent()
    left: dict[str, Any] = {"scene": fingerprint(scene)}
    try:
        result = run_scene(scene, figures=False)
        left["reading"] = reading(result.summary, result.recorder.rows)
        left["cost"] = {f"{name} of the companion{unit}": result.summary[name + unit] for name, unit in COSTS}
    except NgwearError as error:
        left["gave up"] = str(error)
    begun = file.with_name(f".{file.name}.{os.getpid()}")
    begun.write_text(json.dumps(left, indent=2))
    begun.replace(file)
