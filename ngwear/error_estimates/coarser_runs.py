"""What a run says of its own error: the same scene twice more, two and four times coarser in every setting.

A hierarchical estimate of what is read off, mesh and wear steps together: the companions' elements have edges of two
and four times the length, and their jumps may err by two and four times as much. ``ngwear.results.richardson`` tells
from all three in which order they converge, and what that leaves in the finest.

By where a mesh happens to put its nodes, a peak of pressure or the end of a contact errs by another amount at each
stroke. So histories are compared, at the same strokes of the last half of the run, and the error is that of their
mean square.

Elements and jumps may err against each other, and what they make up for in one run does not last in the next. What the
steps tell of the depth themselves is known better; no less than that is stated.

With few elements across, all meshes follow a curved outline rather than what they are asked for. Where there is one
companion, its elements in contact count for as much coarser as they are, not for twice (``coarser_by``).

The estimate cannot see what all three share: the outline's points, the laws and their constants, and steps that the
scene prescribes (``wear.step`` other than ``"jump"``), and the time step. Three of these are known separately; they are
stated by their names and added: arms of the memory that are folded away err by a bounded share of the stress,
prescribed steps by what the embedded estimate says of depth and area, and the time step by what ``time_step`` finds.

What friction tears out is no matter of convergence: elements of half the side tear nearly twice as much
(``ngwear.verify.torn_seal``), and coarser ones as little or nothing. So all that is torn, and comes loose by it, counts
as error of the area lost in all; and of the depth as far as that grows with the area (``growth``). Elements that may be
lost are laid once and not refined to the ends of the contact, where pressures peak over few of them: finer ones only
show more of the peak, and what three runs differ by has not begun to fall. No less is stated there than what the finer
companion differs by.
"""

from __future__ import annotations

import json
import math
import os
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ngwear.errors import NgwearError
from ngwear.loop.result import Result
from ngwear.loop.run import DrawnHere
from ngwear.loop.run import run as run_scene
from ngwear.parallel.workers import Worker, of_modules
from ngwear.results.kept_sections import KeptSections
from ngwear.results.quantities_of_interest import BY_TIME_STEP, DEPTH, LOST, PEAK, WHOLE, element_edge, reading
from ngwear.results.recorder import TORN, Recorder, fingerprint
from ngwear.results.richardson import relative_errors
from ngwear.scene.accuracy import LEAST_ACROSS, Tolerances
from ngwear.scene.scene import Scene

# The ratio of the three runs; and the least that one coarser run counts as, settled on the rod seal with 2.5 and 4
# elements across, whose contact elements are 1.5 and 1.6 times as long (tests/benchmarks/README.md).
COARSER, LEAST_COARSER = 2.0, 1.2
FILE, COARSEST = "companion.json", "companion_coarsest.json"  # in the run's folder: a resumed run finds them there
POLL = 0.05  # s: nobody waits longer for nothing, and it takes no time
COSTS = (("solves", ""), ("elements", ""), ("CPU time", " [s]"))
HERE = DrawnHere()
Histories = Mapping[str, Mapping[str, list[float]]]  # as of ``quantities_of_interest.reading``


def scaled(scene: Scene, factor: float) -> Scene:
    """The scene with elements of so many times the edge, and jumps that may err by as many times as much."""
    accuracy, old = scene.accuracy, scene.accuracy.tolerances
    tolerances = Tolerances(
        stress_error=min(1.0, factor**2 * old.stress_error),
        wear_error=min(0.5, factor * old.wear_error),
        longest_jump=min(1.0, factor * old.longest_jump),
        depth_error=min(1.0, factor * old.depth_error),
    )
    if accuracy.across is not None:
        across = max(accuracy.across / factor, LEAST_ACROSS)
        return replace(scene, accuracy=accuracy.with_across(across, **vars(tolerances)))
    lengths = accuracy.lengths
    patch = factor * lengths.patch
    coarse, mounting = factor * lengths.coarse, max(lengths.mounting, patch)
    changed = replace(accuracy, patch=patch, coarse=coarse, mounting=mounting, **vars(tolerances))
    lost = scene.deactivation
    if lost is not None:
        lost = replace(lost, depth=max(lost.depth, patch))  # at least one layer
    return replace(scene, accuracy=changed, deactivation=lost)


def coarser(scene: Scene, factor: float = COARSER) -> Scene:
    """A scene's companion; it keeps nothing."""
    return replace(scaled(scene, factor), save=replace(scene.save, strokes=(), vtk=False))


def coarser_by(mine: float, other: float) -> float:
    """How many times as long a companion's elements in contact are, of both element edges [mm].

    Twice, unless both follow a curved outline rather than what they are asked for: then they differ by less, and so do
    their errors.
    """
    return float(np.clip(other / mine, LEAST_COARSER, COARSER)) if mine > 0 and other > 0 else COARSER


def stated(
    scene: Scene,
    embedded: Mapping[str, float],
    mine: Histories,
    other: Histories,
    coarsest: Histories | None = None,
    *,
    ratio: float = COARSER,
) -> dict[str, float]:
    """All errors that a run states: each quantity's whole, then by its name what of it is known separately.

    Parameters
    ----------
    scene : Scene
    embedded : mapping
        What the wear steps say of themselves, as in the summary of a run alone.
    mine, other, coarsest : mapping
        Readings of the run and its companions; None if the coarsest gave up, or is not needed.
    ratio : float
        How many times as coarse the first companion is (``coarser_by``), where there is no coarsest: three tell by
        themselves how fast they come nearer.
    """
    levels = relative_errors(mine, other, coarsest, ratio=ratio if coarsest is None else COARSER)
    out = dict(embedded)
    folded = 0.0 if scene.folding is None else scene.folding.bound
    steps = {name: embedded[name] for name in WHOLE if name in embedded}
    prescribed = {} if scene.wear.step == "jump" else steps
    for name, error in levels.items():
        out[name] = error + folded + prescribed.get(name, 0.0) + embedded.get(f"{name[:-4]} {BY_TIME_STEP}", 0.0)
    if DEPTH in levels and scene.wear.step == "jump":
        out[DEPTH] = max(out[DEPTH], steps.get(DEPTH, 0.0))
    torn = embedded.get(TORN, 0.0)
    if LOST in levels:
        out[LOST] += torn
        out[DEPTH] += torn * growth(mine)
    if scene.deactivation is not None and PEAK in levels:
        out[PEAK] = max(out[PEAK], relative_errors(mine, other)[PEAK])
    both = "mesh" if prescribed else "mesh and wear steps"
    out |= {f"{name[:-4]} by {both} [-]": error for name, error in levels.items()}
    out |= {f"{name[:-4]} by the wear steps alone [-]": error for name, error in steps.items()}
    if scene.folding is not None:
        out["stress by arms folded away [-]"] = folded
    return out


def excess(errors: Mapping[str, float], asked: Mapping[str, float]) -> float:
    """The largest of the stated errors over those asked for, by their names [-]; 0 if none of them is stated."""
    return max((errors[name] / limit for name, limit in asked.items() if name in errors), default=0.0)


def growth(mine: Histories) -> float:
    """The power of the area lost in all with which the greatest depth grows along the last half of a run, 0 to 1.

    Contacts that widen as they wear take more area for the same depth: 2/3 of a parabola's, 1/2 of a wedge.
    """
    (depth,), (area,) = mine[DEPTH].values(), mine[LOST].values()
    if not (depth[-1] > depth[0] > 0 and area[-1] > area[0] > 0):
        return 1.0
    return min(1.0, math.log(depth[-1] / depth[0]) / math.log(area[-1] / area[0]))


def run_stated(
    scene: Scene,
    *,
    out: Path | str,
    resume: bool = False,
    progress: bool = False,
    throw: bool = True,
    figures: bool = True,
    told: Callable[[dict[str, Any]], None] | None = None,
    enough: Mapping[str, float] | None = None,
    worker: Worker | None = None,
) -> Result:
    """Run a scene and, beside it in a second process, its companions; ``summary["error estimates"]`` is from all.

    Parameters and errors as ``run``; ``told`` may add to the summary of a run that reached its end. Where the first
    companion, taken as of first order, shows no error above those of ``enough``, by their names, there is no coarsest.
    Companions that give up lose nothing: without the coarsest, errors are taken as of first order; without both, those
    of the mesh are not known. The summary then warns. They run in ``worker``, which ends with this, or in one that
    begins here. It draws half of the figures, too, if it has nothing else to do by then.
    """
    companions = _Companions(scene, Path(out), enough, worker)

    def state(recorder: Recorder, summary: dict[str, Any]) -> None:
        companions.state(recorder, summary)
        if told is not None:
            told(summary)

    with companions:
        return run_scene(
            scene,
            out=out,
            resume=resume,
            progress=progress,
            throw=throw,
            figures=figures,
            errors=state,
            draw=companions,
        )


class _Companions:
    """Runs in a process of their own, the finer first, each of which leaves its readings in a file.

    Those of an earlier process are taken from there. The process draws as well (``ngwear.loop.run.Drawing``).
    """

    def __init__(self, scene: Scene, folder: Path, enough: Mapping[str, float] | None, worker: Worker | None) -> None:
        self.scene, self.enough, self.worker = scene, enough, worker
        self.runs = [(coarser(scene, COARSER**power), folder / name) for power, name in ((1, FILE), (2, COARSEST))]
        self.begun: list[tuple[Scene, Path]] = []

    def __enter__(self) -> _Companions:
        self._begin(self.runs if self.enough is None else self.runs[:1])
        return self

    def __exit__(self, *_: object) -> None:
        if self.worker is not None:
            self.worker.end()

    def _begin(self, runs: list[tuple[Scene, Path]]) -> None:
        """Let those run that have not left anything; with laws of a script's own this process does, once it can."""
        if of_modules(self.scene) and any(left_by(*run) is None for run in runs):
            self.worker = self.worker or Worker(__name__)
            self.worker.do(_leave, runs)
            self.begun += runs

    def first(self, folder: Path, kept: KeptSections) -> None:
        """Have the section drawn by the worker once it has run what it was told to; without one, with the rest."""
        if self.worker is not None:
            self.worker.do(HERE.first, folder, kept)

    def rest(self, folder: Path) -> None:
        """Draw the figures of the run: half of them in the worker, if it is through with the runs."""
        if self.worker is not None and self.worker.alive and all(left_by(*run) is not None for run in self.begun):
            self.worker.do(HERE.rest, folder, (0, 2))
            HERE.rest(folder, (1, 2))
            if self.worker.did():
                return
        HERE.rest(folder)  # or fail as it did

    def state(self, recorder: Recorder, summary: dict[str, Any]) -> None:
        """Wait for them, and put the estimates into the summary of the run."""
        other = self._left(*self.runs[0])
        if "gave up" in other:
            why = f"the coarser companion run gave up: {other['gave up']}"
            summary["warnings"].append(f"{why}; the error of the mesh is not known")
            return
        embedded, mine = summary["error estimates"], reading(recorder.rows)
        ratio = coarser_by(element_edge(recorder.rows), other.get("element edge [mm]", 0.0))
        known = stated(self.scene, embedded, mine, other["reading"], ratio=ratio)
        left = [(other, "companion")]
        if self.enough is None or excess(known, self.enough) > 1:
            self._begin(self.runs[1:])
            coarsest = self._left(*self.runs[1])
            if "gave up" in coarsest:
                why = f"the coarsest companion run gave up: {coarsest['gave up']}"
                summary["warnings"].append(f"{why}; the error of the mesh is taken as of first order")
            known = stated(self.scene, embedded, mine, other["reading"], coarsest.get("reading"), ratio=ratio)
            left.append((coarsest, "coarsest companion"))
        summary["error estimates"] = known
        for found, name in left:
            for cost, unit in COSTS:
                if cost in found:
                    summary[f"{cost} of the {name}{unit}"] = found[cost]

    def _left(self, scene: Scene, file: Path) -> dict[str, Any]:
        """Wait for what one of them leaves."""
        if not of_modules(self.scene):
            _leave([(scene, file)])
        while left_by(scene, file) is None and self.worker is not None and self.worker.alive and not self.worker.idle:
            time.sleep(POLL)
        return left_by(scene, file) or {"gave up": "it ended without a word"}


def left_by(scene: Scene, file: Path) -> dict[str, Any] | None:
    """What a companion has left in its file; None if it has not, or another scene's has."""
    try:
        left = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return left if isinstance(left, dict) and left.get("scene") == fingerprint(scene) else None


def left_of(result: Result) -> dict[str, Any]:
    """What a run that ended leaves as a companion: its readings, its element edge, and what it took."""
    rows = result.records.rows
    read = {"reading": reading(rows), "element edge [mm]": element_edge(rows)}
    return read | {cost: result.summary[cost + unit] for cost, unit in COSTS}


def _leave(runs: list[tuple[Scene, Path]]) -> None:
    """Run scenes, their readings or failures into their files, each written whole, unless they are there."""
    for scene, file in runs:
        if left_by(scene, file) is not None:
            continue
        left: dict[str, Any] = {}
        try:
            left |= left_of(run_scene(scene, figures=False))
        except NgwearError as error:
            left["gave up"] = str(error)
        leave(scene, file, left)


def leave(scene: Scene, file: Path, left: dict[str, Any]) -> None:
    """Write what a companion's run has read off and taken into its file, as a whole."""
    begun = file.with_name(f".{file.name}.{os.getpid()}")
    begun.write_text(json.dumps({"scene": fingerprint(scene)} | left, indent=2))
    begun.replace(file)
