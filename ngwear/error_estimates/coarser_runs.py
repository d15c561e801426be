"""Error of a run by comparison with two coarser runs of the same scene.

Element edges and error tolerances of the coarser runs are two and four times as large, so that the estimate covers mesh
and wear steps together. ``ngwear.results.richardson`` computes the order of convergence from the three runs, and the
error of the finest one.

Peak pressures and contact ends scatter from stroke to stroke, because they depend on the positions of the nodes. So the
histories over the last half of the run are compared at the same strokes, by their mean square.

The steps of the coarser runs may err much more than those of the run, and errors of mesh and steps may cancel in one
run and not in the next. The embedded estimate of a depth's error has a sign. So it is taken off the depths before they
are compared, and that of the run is added to the error by the mesh.

For parts with room to move, an error is at least that by elements of half the edges (``ngwear.loop.halved_elements``).
They have one coarser run only, whose difference counts with a factor of safety (``ngwear.results.richardson``). It is
waited for as long as the run itself took: on very coarse elements such a part may be hard to mount.

With few elements across, the elements on a curved outline are finer than the setting asks for. With a single coarser
run, its real ratio of element edges in contact is used, instead of two (``edge_ratio``).

The comparison does not see errors that all runs share: points of the outline, laws and constants, prescribed wear steps
(``wear.step`` other than ``"jump"``), and the time step. Three of them are estimated separately and added: relaxation
times left out of the memory (a bound of the stress), prescribed steps (embedded estimate of depth and area), and the
time step (``ngwear.loop.time_step_error``).

Tearing does not converge with the mesh: elements of half the side tear nearly twice as much
(``ngwear.verify.torn_seal``). So the torn area, and what comes loose by it, is an error of the total lost area, and of
the depth as far as it grows with that area (``depth_exponent``). Elements that may be lost are not refined at the ends
of the contact, where pressures peak: the differences of the three runs do not yet decrease there. The error of the peak
pressure is then at least that by the first coarser run alone.
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

from ngwear.error_estimates.stated_errors import state_errors, with_parts
from ngwear.errors import NgwearError
from ngwear.loop.result import Result
from ngwear.loop.run import LocalDrawing
from ngwear.loop.run import run as run_scene
from ngwear.parallel.workers import Worker, of_modules
from ngwear.results.kept_sections import KeptSections
from ngwear.results.quantities_of_interest import (
    BY_HALVED,
    BY_TIME_STEP,
    DEPTH,
    DEPTH_BY_MESH,
    LOST,
    PEAK,
    RUN_COLUMNS,
    compared,
    element_edge,
)
from ngwear.results.recorder import TORN, Recorder, fingerprint
from ngwear.results.richardson import HIGHEST, SAFETY, relative_errors
from ngwear.scene.accuracy import LEAST_ACROSS, Tolerances
from ngwear.scene.holding import free_directions
from ngwear.scene.scene import Scene

# The ratio of the three runs; and the least that one coarser run counts as, settled on the rod seal with 2.5 and 4
# elements across, whose contact elements are 1.5 and 1.6 times as long (tests/benchmarks/README.md).
COARSER, LEAST_COARSER = 2.0, 1.2
FILE, COARSEST = "companion.json", "companion_coarsest.json"  # in the run's folder: a resumed run finds them there
POLL = 0.05  # s: nobody waits longer for nothing, and it takes no time
COSTS = (("solves", ""), ("elements", ""), ("CPU time", " [s]"))
LOCAL = LocalDrawing()
Histories = Mapping[str, Mapping[str, list[float]]]  # as of ``quantities_of_interest.quantities``


def scaled(scene: Scene, factor: float) -> Scene:
    """The scene with element edges and error tolerances multiplied by a factor; stress_error by its square."""
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


def coarser_scene(scene: Scene, factor: float = COARSER) -> Scene:
    """The scene of a coarser run; it saves nothing."""
    return replace(scaled(scene, factor), save=replace(scene.save, strokes=(), vtk=False))


def edge_ratio(mine: float, other: float) -> float:
    """Ratio of the element edges in contact of a coarser run and the run, from both edges [mm].

    At most 2. It is less if both meshes follow a curved outline: then their errors differ less, too.
    """
    return float(np.clip(other / mine, LEAST_COARSER, COARSER)) if mine > 0 and other > 0 else COARSER


def combined_errors(
    scene: Scene,
    embedded: Mapping[str, float],
    mine: Histories,
    other: Histories,
    coarsest: Histories | None = None,
    *,
    ratio: float = COARSER,
) -> dict[str, float]:
    """Relative errors of a run: the total of each quantity, then its known parts by name.

    Parameters
    ----------
    scene : Scene
    embedded : mapping
        Embedded estimates of the wear steps, as in the summary of a run without coarser runs.
    mine, other, coarsest : mapping
        Quantities of interest of the run and of the coarser runs; None if the coarsest gave up or is not needed.
    ratio : float
        Ratio of element edges of the first coarser run (``edge_ratio``); used without the coarsest only.

    Returns
    -------
    dict of str to float
        As ``summary["error estimates"]`` [-].
    """
    two = coarsest is None and bool(free_directions(scene))  # of a part with room to move there is no third
    orders = dict.fromkeys(mine, HIGHEST) if two else None
    levels = relative_errors(mine, other, coarsest, ratio=ratio if coarsest is None else COARSER, orders=orders)
    if two:
        levels = {name: SAFETY * error for name, error in levels.items()}
    out = dict(embedded)
    folded = 0.0 if scene.folding is None else scene.folding.bound
    steps = {name: embedded[name] for name in RUN_COLUMNS if name in embedded}
    prescribed = {} if scene.wear.step == "jump" else steps
    if DEPTH in levels and DEPTH_BY_MESH in levels and not prescribed:
        levels[DEPTH] = levels[DEPTH_BY_MESH] + steps.get(DEPTH, 0.0)
    by_mesh = {DEPTH_BY_MESH: levels.pop(DEPTH_BY_MESH)} if DEPTH_BY_MESH in levels else {}
    for name, error in levels.items():
        out[name] = error + folded + prescribed.get(name, 0.0) + embedded.get(f"{name[:-4]} {BY_TIME_STEP}", 0.0)
    out |= with_parts(out)
    torn = embedded.get(TORN, 0.0)
    if LOST in levels:
        out[LOST] += torn
        out[DEPTH] += torn * depth_exponent(mine)
    if scene.deactivation is not None and PEAK in levels:
        out[PEAK] = max(out[PEAK], relative_errors(mine, other)[PEAK])
    both = "mesh" if prescribed else "mesh and wear steps"
    out |= by_mesh | {f"{name[:-4]} by {both} [-]": error for name, error in levels.items()}
    out |= {f"{name[:-4]} by the wear steps alone [-]": error for name, error in steps.items()}
    if scene.folding is not None:
        out["stress by arms folded away [-]"] = folded
    return out


def largest_ratio(errors: Mapping[str, float], asked: Mapping[str, float]) -> float:
    """Largest ratio of an estimated error to the requested one, by name [-]; 0 if none of them is estimated."""
    return max((errors[name] / limit for name, limit in asked.items() if name in errors), default=0.0)


def depth_exponent(mine: Histories) -> float:
    """Exponent p of ``maximum depth ~ total lost area^p`` over the last half of a run, 0 to 1.

    It is below 1 for contacts that widen as they wear: 2/3 for a parabola, 1/2 for a wedge.
    """
    (depth,), (area,) = mine[DEPTH].values(), mine[LOST].values()
    if not (depth[-1] > depth[0] > 0 and area[-1] > area[0] > 0):
        return 1.0
    return min(1.0, math.log(depth[-1] / depth[0]) / math.log(area[-1] / area[0]))


def run_with_coarser_runs(
    scene: Scene,
    *,
    out: Path | str,
    resume: bool = False,
    progress: bool = False,
    throw: bool = True,
    figures: bool = True,
    on_summary: Callable[[dict[str, Any]], None] | None = None,
    requested: Mapping[str, float] | None = None,
    worker: Worker | None = None,
) -> Result:
    """Run a scene and, in a second process, its coarser runs; ``summary["error estimates"]`` uses all of them.

    Parameters and errors as ``ngwear.loop.run.run``, and:

    Parameters
    ----------
    on_summary : callable or None
        Called with the summary of a completed run; it may add to it.
    enough : mapping or None
        Requested errors by name. The coarsest run is left out if the first one, with first order, shows no larger
        error.
    worker : Worker or None
        The second process, if it has been started already; it ends with the run.

    A part with room to move has one coarser run. If the coarsest run gives up, first order is assumed; if the first one
    gives up, or takes too long for such a part, the error of the mesh is not known, or from halved elements alone. The
    summary then has a warning. The second process also draws half of the figures if it is free.
    """
    companions = _CoarserRuns(scene, Path(out), requested, worker)

    def state(recorder: Recorder, summary: dict[str, Any]) -> None:
        companions.state(recorder, summary)
        if on_summary is not None:
            on_summary(summary)

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


class _CoarserRuns:
    """The coarser runs, in a second process, the finer first; each writes its quantities of interest to a file.

    Files of an earlier process are used. The second process also draws figures (``ngwear.loop.run.Drawing``).
    """

    def __init__(
        self, scene: Scene, folder: Path, requested: Mapping[str, float] | None, worker: Worker | None
    ) -> None:
        self.scene, self.requested, self.worker = scene, requested, worker
        self.floats = bool(free_directions(scene))
        levels = ((1, FILE),) if self.floats else ((1, FILE), (2, COARSEST))
        self.runs = [(coarser_scene(scene, COARSER**power), folder / name) for power, name in levels]
        self.begun: list[tuple[Scene, Path]] = []
        self.start = time.perf_counter()

    def __enter__(self) -> _CoarserRuns:
        # Of the peak pressure the first run alone seldom shows little enough; begun later, the coarsest is waited for.
        both = self.requested is None or PEAK in self.requested
        self._begin(self.runs if both else self.runs[:1])
        return self

    def __exit__(self, *_: object) -> None:
        if self.worker is not None:
            self.worker.end()

    def _begin(self, runs: list[tuple[Scene, Path]]) -> None:
        """Start the runs without a file; with laws defined in a script they run later, in this process."""
        if of_modules(self.scene) and any(read_coarser_run(*run) is None for run in runs):
            self.worker = self.worker or Worker(__name__)
            self.worker.do(_run_coarser, runs)
            self.begun += runs

    def draw_section(self, folder: Path, kept: KeptSections) -> None:
        """Let the worker draw the section after its runs; without a worker it is drawn with the other figures."""
        if self.worker is not None:
            self.worker.do(LOCAL.draw_section, folder, kept)

    def draw_all(self, folder: Path) -> None:
        """Draw the figures of the run, half of them in the worker if its runs are finished."""
        done = all(read_coarser_run(*run) is not None for run in self.begun)
        if self.worker is not None and self.worker.alive and done:
            self.worker.do(LOCAL.draw_all, folder, (0, 2))
            LOCAL.draw_all(folder, (1, 2))
            if self.worker.did():
                return
        LOCAL.draw_all(folder)  # raises the error that the worker had

    def state(self, recorder: Recorder, summary: dict[str, Any]) -> None:
        """Wait for the coarser runs, and write the error estimates into the summary."""
        other = self._wait_for(*self.runs[0])
        if "gave up" in other:
            parts = summary["error estimates"]
            by_halved = any(name.endswith(BY_HALVED) for name in parts)
            says = "known from elements of half the edges alone" if by_halved else "not known"
            summary["warnings"].append(f"the coarser run gave up: {other['gave up']}; the error of the mesh is {says}")
            state_errors(summary, parts | with_parts(parts))
            return
        embedded, mine = summary["error estimates"], compared(recorder.rows)
        ratio = edge_ratio(element_edge(recorder.rows), other.get("element edge [mm]", 0.0))
        known = combined_errors(self.scene, embedded, mine, other["reading"], ratio=ratio)
        left = [(other, "companion")]
        if self.runs[1:] and (self.requested is None or largest_ratio(known, self.requested) > 1):
            self._begin(self.runs[1:])
            coarsest = self._wait_for(*self.runs[1])
            if "gave up" in coarsest:
                why = f"the coarsest run gave up: {coarsest['gave up']}"
                summary["warnings"].append(f"{why}; first order is assumed for the error of the mesh")
            known = combined_errors(self.scene, embedded, mine, other["reading"], coarsest.get("reading"), ratio=ratio)
            left.append((coarsest, "coarsest companion"))
        state_errors(summary, known)
        for found, name in left:
            for cost, unit in COSTS:
                if cost in found:
                    summary[f"{cost} of the {name}{unit}"] = found[cost]

    def _wait_for(self, scene: Scene, file: Path) -> dict[str, Any]:
        """Wait for the file of one of the runs; return its contents."""
        now = time.perf_counter()
        last = 2 * now - self.start if self.floats else math.inf
        if not of_modules(self.scene):
            _run_coarser([(scene, file)])
        while read_coarser_run(scene, file) is None:
            if self.worker is None or not self.worker.alive or self.worker.idle:
                break
            if time.perf_counter() > last:
                return {"gave up": "it took more than twice the time of the run"}
            time.sleep(POLL)
        return read_coarser_run(scene, file) or {"gave up": "its process ended without a result"}


def read_coarser_run(scene: Scene, file: Path) -> dict[str, Any] | None:
    """Contents of a coarser run's file; None if there is none, or it is of another scene or an earlier version."""
    try:
        left = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    if not isinstance(left, dict) or left.get("scene") != fingerprint(scene):
        return None
    return left if "gave up" in left or DEPTH_BY_MESH in left.get("reading", {}) else None


def coarser_run_data(result: Result) -> dict[str, Any]:
    """Data of a completed run for its use as a coarser run: quantities of interest, element edge, and cost."""
    rows = result.records.rows
    read = {"reading": compared(rows), "element edge [mm]": element_edge(rows)}
    return read | {cost: result.summary[cost + unit] for cost, unit in COSTS}


def _run_coarser(runs: list[tuple[Scene, Path]]) -> None:
    """Run the scenes without a file; write the data, or the reason of the failure, to their files."""
    for scene, file in runs:
        if read_coarser_run(scene, file) is not None:
            continue
        left: dict[str, Any] = {}
        try:
            left |= coarser_run_data(run_scene(scene, figures=False))
        except NgwearError as error:
            left["gave up"] = str(error)
        write_coarser_run(scene, file, left)


def write_coarser_run(scene: Scene, file: Path, left: dict[str, Any]) -> None:
    """Write the data of a coarser run to its file, which is replaced as a whole."""
    begun = file.with_name(f".{file.name}.{os.getpid()}")
    begun.write_text(json.dumps({"scene": fingerprint(scene)} | left, indent=2))
    begun.replace(file)
