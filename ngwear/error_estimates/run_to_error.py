"""Run a scene to a requested error: on finer and finer levels, until the estimated error is small enough.

A level has two or four times as many elements across the contacts as the one before, with smaller tolerances of stress
and wear (``Accuracy``). In a level the mesh is adapted to contacts and stresses, and the cycle jumps to the error of
the wear steps. Levels serve as the coarser runs of finer levels (``ngwear.error_estimates.coarser_runs``), so that only
the first level needs additional runs; one, if that shows a small enough error. If the time step of rubber with memory
has more than half of the requested error, the next level divides strokes into more parts and needs its own coarser
runs.

The requested error is that of the maximum depth, and optionally of the peak pressure; others are only estimated.
"""

from __future__ import annotations

import json
import math
import shutil
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ngwear.error_estimates.coarser_runs import (
    COARSER,
    COARSEST,
    FILE,
    coarser_run_data,
    coarser_scene,
    largest_ratio,
    read_coarser_run,
    run_with_coarser_runs,
    write_coarser_run,
)
from ngwear.errors import ResultError
from ngwear.files.result_folder import CHECKPOINT, COMPLETED, OutFolder
from ngwear.loop.result import Result
from ngwear.parallel.workers import Worker
from ngwear.results.quantities_of_interest import APART, BY_TIME_STEP, DEPTH, PEAK
from ngwear.results.recorder import fingerprint
from ngwear.scene.accuracy import MOST_ACROSS
from ngwear.scene.scene import Scene

LEVELS, NOTES = "levels", "levels.json"  # in the run's folder: what earlier levels have left, and what is known of them
# Settled on the rod seal, which errs by 0.43 % of its depth on 4, 1.3 % on 2.5 (adaptive_against_fixed.py), and states
# 1.4 % of its peak on 5. What is stated decides; a level too coarse costs another one.
FIRST, AT = 4.0, 0.01  # elements across of the first level when so much error of the depth is asked for
FIRST_PEAK, AT_PEAK = 5.0, 0.1  # when so much of the peak pressure is
COARSEST_FIRST, FINEST_FIRST = 2.5, 32.0  # below, coarser runs hardly differ; above, a first level is dear
MOST_STEPS = 2  # levels at once: a coarse level's word on its error is not worth more
HALVINGS, MOST_PARTS = 2, 16  # of the time step at once; parts of a stroke, each with a solve
ACROSS, PARTS, CPU = "elements across [-]", "parts of a stroke [-]", "CPU time [s]"
Level = tuple[float, int]  # elements across, parts of a stroke
BY_TIME = f"{DEPTH[:-4]} {BY_TIME_STEP}"


def first_across(error: float, peak_error: float | None = None) -> float:
    """Elements across of the first level: 4 for 1 % error of depth, 5 for 10 % of peak pressure; from 2.5 to 32.

    Half of the error needs twice as many.
    """
    across = FIRST * 2.0 ** math.ceil(math.log2(AT / error) - 1e-9)
    if peak_error is not None:
        across = max(across, FIRST_PEAK * 2.0 ** math.ceil(math.log2(AT_PEAK / peak_error) - 1e-9))
    return min(max(across, COARSEST_FIRST), FINEST_FIRST)


def next_across(across: float, estimated: float | None, error: float) -> float | None:
    """Elements across of the next level; None if this level is accurate enough, or there is no finer one.

    First order is assumed. The next level has at most four times as many elements, and twice if the error is not known.
    """
    if estimated is not None and estimated <= error:
        return None
    steps = 1 if estimated is None else min(MOST_STEPS, math.ceil(math.log2(estimated / error) - 1e-9))
    while steps and across * COARSER**steps > MOST_ACROSS:
        steps -= 1
    return across * COARSER**steps if steps else None


def next_parts(parts: int, by_time_step: float, error: float) -> int:
    """Parts of a stroke of the next level, so that the time step has half of the error; first order is assumed."""
    share = 2 * by_time_step / error
    steps = min(HALVINGS, math.ceil(math.log2(share) - 1e-9)) if share > 1 else 0
    return max(parts, min(parts * 2**steps, MOST_PARTS))


def next_level(
    level: Level, estimated: float | None, by_time_step: float, error: float, *, others: float = 0.0
) -> Level | None:
    """Elements across and parts of a stroke of the next level; None if this one is accurate enough or the finest.

    ``others`` is the largest ratio of another estimated error to the requested one [-].
    """
    across, parts = level
    if estimated is not None and estimated <= error and others <= 1:
        return None
    if estimated is None:
        finer = (next_across(across, None, error) or across, parts)
    else:
        left = error - min(by_time_step, 0.5 * error)
        by_mesh = max(estimated - by_time_step, others * left)
        finer = (next_across(across, by_mesh, left) or across, next_parts(parts, by_time_step, error))
    return None if finer == level else finer


def run_to_error(
    scene: Scene,
    *,
    out: Path | str,
    resume: bool = False,
    progress: bool = False,
    throw: bool = True,
    figures: bool = True,
    worker: Worker | None = None,
) -> Result:
    """Run a scene that gives ``accuracy.error``, and maybe ``peak_error``, until its estimated errors are as small.

    Files of earlier levels are in the subfolder ``levels``. If the finest possible level has a larger error than
    requested, its summary has a warning. ``summary["levels"]`` lists error and CPU time of each level.

    Parameters and errors as ``ngwear.loop.run.run``; the coarser runs of the first level use ``worker``, if given.
    """
    folder, asked = OutFolder(Path(out), CHECKPOINT, resume=resume), requested_errors(scene)
    done = _earlier_levels(folder, scene, resume=resume)
    first = (first_across(asked[DEPTH], asked.get(PEAK)), scene.accuracy.parts)
    at = (_next_level(done[-1], asked) if done else None) or first
    while True:
        level = at_level(scene, *at)
        _reuse_levels(folder, level, done)
        level_summary = _LevelSummary(done, at, asked)
        result = run_with_coarser_runs(
            level,
            out=out,
            resume=resume,
            progress=progress,
            throw=throw,
            figures=figures,
            on_summary=level_summary,
            requested=asked,
            worker=worker,
        )
        worker = None
        finer = _next_level(level_summary.mine, asked) if result.status == COMPLETED else None
        if finer is None:
            return result
        done.append(level_summary.mine | {"left": coarser_run_data(result)})
        _write_notes(folder, scene, done)
        _move_files(folder, level_summary.mine)
        at = finer


def _write_notes(folder: OutFolder, scene: Scene, done: list[dict[str, Any]]) -> None:
    notes = json.dumps({"scene": fingerprint(scene), "levels": done}).encode()
    folder.replace(NOTES, lambda file: file.write(notes))


def at_level(scene: Scene, across: float, parts: int = 1) -> Scene:
    """The scene with this number of elements across, the tolerances for it, and this number of parts of a stroke."""
    return replace(scene, accuracy=replace(scene.accuracy.with_across(across), parts=parts))


def first_level(scene: Scene) -> Scene:
    """The scene at the level with which a run to its requested error begins."""
    asked = requested_errors(scene)
    return at_level(scene, first_across(asked[DEPTH], asked.get(PEAK)), scene.accuracy.parts)


def requested_errors(scene: Scene) -> dict[str, float]:
    """Errors that a scene requests, by their names in the summary."""
    accuracy = scene.accuracy
    asked = {DEPTH: accuracy.error, PEAK: accuracy.peak_error}
    return {name: error for name, error in asked.items() if error is not None}


def _next_level(done: Mapping[str, Any], asked: Mapping[str, float]) -> Level | None:
    others = {name: limit for name, limit in asked.items() if name != DEPTH}
    over = largest_ratio({name: done[name] for name in others if done.get(name) is not None}, others)
    return next_level((done[ACROSS], done[PARTS]), done[DEPTH], done[BY_TIME], asked[DEPTH], others=over)


class _LevelSummary:
    """Adds to a level's summary the requested errors and a table of all levels."""

    def __init__(self, done: list[dict[str, Any]], level: Level, asked: Mapping[str, float]) -> None:
        self.done, self.level, self.asked = done, level, asked
        self.mine: dict[str, Any] = {}

    def __call__(self, summary: dict[str, Any]) -> None:
        estimated = summary["error estimates"]
        known = any(name.startswith(f"{DEPTH[:-4]} by mesh") for name in estimated)
        run = {(entry[ACROSS], entry[PARTS]) for entry in self.done}
        across, parts = self.level
        cpu = summary[CPU]
        for power, name in ((1, "companion"), (2, "coarsest companion")):
            if (across / COARSER**power, parts) not in run:
                cpu += summary.get(f"CPU time of the {name} [s]", 0.0)
        by_mesh = {name: _by_mesh_and_steps(estimated, name) for name in (DEPTH, PEAK)}
        self.mine = {ACROSS: across, PARTS: parts, DEPTH: by_mesh[DEPTH] if known else None, CPU: round(cpu, 3)}
        self.mine[BY_TIME] = estimated.get(BY_TIME, 0.0)
        if PEAK in self.asked:
            self.mine[PEAK] = by_mesh[PEAK]
        columns = (ACROSS, PARTS, *self.asked, CPU)
        levels = [{name: entry[name] for name in columns} for entry in (*self.done, self.mine)]
        summary["error asked for [-]"], summary["levels"] = self.asked[DEPTH], levels
        if PEAK in self.asked:
            summary["peak error asked for [-]"] = self.asked[PEAK]
        summary["CPU time of all levels [s]"] = round(sum(entry[CPU] for entry in levels), 3)
        if _next_level(self.mine, self.asked) is not None:
            return
        for name, limit in self.asked.items():
            if known and name in estimated and estimated[name] > limit:
                says = f"has an error of the {name[:-4]} of {estimated[name]:.2g}"
                summary["warnings"].append(f"the finest level {says}; {limit:.2g} was asked for")
        if not known:
            says = f"has no error estimate; {self.asked[DEPTH]:.2g} of the {DEPTH[:-4]} was asked for"
            summary["warnings"].append(f"the finest level {says}")


def _by_mesh_and_steps(estimated: Mapping[str, float], name: str) -> float | None:
    """An estimated error without the parts for which no finer level is chosen."""
    total = estimated.get(name)
    return None if total is None else total - sum(estimated.get(f"{name[:-4]} {part}", 0.0) for part in APART)


def _earlier_levels(folder: OutFolder, scene: Scene, *, resume: bool) -> list[dict[str, Any]]:
    """Data of the levels that an earlier process has completed."""
    file = folder.path / NOTES
    if not resume or not file.exists():
        file.unlink(missing_ok=True)
        shutil.rmtree(folder.path / LEVELS, ignore_errors=True)
        return []
    try:
        notes = json.loads(file.read_text(encoding="utf-8"))
        of, levels = notes["scene"], list(notes["levels"])
        for level in levels:
            _level_folder(folder, level)  # fails unless made of numbers: no text of the file becomes a path
        if not levels:
            raise ValueError("it lists no level")
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ResultError(f"{file} cannot be read ({error}); remove the folder and run again") from error
    if of != fingerprint(scene):
        raise ResultError(f"{folder.path} holds a run of another scene, or the scene was changed: give another folder")
    _move_files(folder, levels[-1])
    return levels


def _level_folder(folder: OutFolder, level: Mapping[str, Any]) -> Path:
    """Folder of a level's files."""
    parts = "" if level[PARTS] == 1 else f" in {level[PARTS]:d} parts"
    return folder.path / LEVELS / f"{level[ACROSS]:g}{parts}"


def _move_files(folder: OutFolder, level: Mapping[str, Any]) -> None:
    """Move a level's files to its own folder, the checkpoint last, so that an interrupted move can be continued."""
    place = _level_folder(folder, level)
    if (place / CHECKPOINT).exists():
        return
    place.mkdir(parents=True, exist_ok=True)
    files = [file for file in folder.path.iterdir() if file.is_file() and file.name != NOTES]
    for file in sorted(files, key=lambda file: file.name == CHECKPOINT):
        file.replace(place / file.name)


def _reuse_levels(folder: OutFolder, level: Scene, done: list[dict[str, Any]]) -> None:
    """Use the data of earlier levels and of their coarser runs as the coarser runs of a level."""
    for power, name in ((1, FILE), (2, COARSEST)):
        coarse = coarser_scene(level, COARSER**power)
        for entry in done:
            if (entry[ACROSS], entry[PARTS]) == (coarse.accuracy.across, coarse.accuracy.parts):
                write_coarser_run(coarse, folder.path / name, entry["left"])
            for file in (FILE, COARSEST):
                earlier = _level_folder(folder, entry) / file
                if read_coarser_run(coarse, earlier) is not None:
                    shutil.copy(earlier, folder.path / name)
