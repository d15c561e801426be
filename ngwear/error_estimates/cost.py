"""Cost study: error and computing time of settings of a scene, and the fastest setting for a given error."""

from __future__ import annotations

import itertools
import math
import tempfile
import time
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ngwear.error_estimates.cost_runs import DEPTH, PEAK, Limited, Point, measure
from ngwear.error_estimates.cost_study import Study
from ngwear.error_estimates.cost_table import as_dict, table
from ngwear.error_estimates.cost_text import paragraph
from ngwear.error_estimates.ladder import STOPPED, Measurement, Setting, labels_of
from ngwear.error_estimates.settings import Parameter, changes, parameters, with_setting
from ngwear.error_estimates.settings_search import Choice, confirm, run_ladders
from ngwear.errors import SceneError
from ngwear.files.result_folder import GAVE_UP, OutFolder
from ngwear.files.version import VERSION
from ngwear.parallel.sweep import sweep
from ngwear.parallel.workers import one_thread_pool
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.pin_scene import PinScene
from ngwear.scene.scene import Scene
from ngwear.units import UNITS

RUNS = "runs"
CSV, JSON, PNG = "cost.csv", "cost.json", "cost.png"


@dataclass(frozen=True)
class Cost:
    """Result of a cost study.

    Attributes
    ----------
    scene : str
    budget : float
        Wall time that was given for all runs [s].
    study : Study
        Runs, errors, orders of convergence, Pareto front.
    choices : list of Choice
        Recommended settings for an error of 5 %, 1 % and 0.1 % of the main quantity.
    written : list of dict or None
        Change of the scene file for each of them; None if nothing is recommended.
    """

    scene: str
    budget: float
    study: Study
    choices: list[Choice]
    written: list[dict[str, Any] | None]

    @property
    def paragraph(self) -> str:
        """The results as one paragraph of text."""
        return paragraph(self.scene, self.study, self.choices, self.budget)

    def as_dict(self) -> dict[str, Any]:
        """Contents of ``cost.json``."""
        head = {"scene": self.scene, "budget [s]": self.budget, "in words": self.paragraph}
        found = as_dict(self.study, self.choices)
        for choice, written in zip(found["recommended"], self.written, strict=True):
            choice["change in the scene"] = written
        return head | found | {"units": UNITS, "ngwear": VERSION}

    def table(self) -> list[dict[str, Any]]:
        """Rows of ``cost.csv``, one for each run."""
        return table(self.study)


def cost(
    scene: Scene | PinScene,
    *,
    budget: float,
    folder: Path | str | None = None,
    progress: bool = False,
    figures: bool = True,
) -> Cost:
    """Run a scene with coarser and finer settings, and compare error and computing time.

    Each run has its own process with one thread, one after the other, so that its time and memory are measured alone.
    The next run depends only on the recorded times of earlier runs: a call with the same folder and budget runs nothing
    new, a call after an interruption continues, and a call with a larger budget goes further. With a sealed fluid the
    leak pressure is computed too. If the scene gives ``accuracy.error``, the settings of the preset ``engineering`` are
    varied.

    Parameters
    ----------
    scene : Scene or PinScene
    budget : float
        Wall time for all runs, including those found in the folder [s].
    folder : path or None
        Folder for ``cost.csv``, ``cost.json``, ``cost.png``, and ``runs`` with the result of each run.
    progress : bool
        Show a progress bar.
    figures : bool
        Draw the figure into the folder.

    Returns
    -------
    Cost

    Raises
    ------
    SceneError
        If the budget is not positive, or too small for one run.
    ResultError
        If the folder cannot be used.
    """
    if not 0 < budget < math.inf:
        raise SceneError("cost.budget", budget, "must be finite and greater than 0 s")
    if isinstance(scene, Scene) and scene.fluid is not None:
        scene = replace(scene, fluid=replace(scene.fluid, leak_pressure=True))
    if isinstance(scene, Scene) and scene.accuracy.error is not None:  # the study itself finds settings for an error
        scene = replace(scene, accuracy=scene.accuracy.with_tolerances_of(Accuracy.engineering()))
    varied = parameters(scene)
    ladders = tuple(parameter.ladder for parameter in varied)
    main = DEPTH if isinstance(scene, PinScene) or scene.worn_edges else PEAK
    out = None if folder is None else OutFolder(Path(folder), "", resume=True)
    keep = tempfile.TemporaryDirectory() if out is None else nullcontext(out.path)
    with keep as path, _Bar(budget, shown=progress) as bar:
        run = _runner(scene, varied, Path(path) / RUNS, bar.begin, bar.end)
        study = run_ladders(ladders, main, budget, run)
        choices = confirm(study, budget, run)
    written = [None if c.setting is None else changes(scene, with_setting(scene, varied, c.setting)) for c in choices]
    found = Cost(scene.name, budget, study, choices, written)
    if out is not None:
        _write(out, found, figures=figures)
    return found


def _runner(
    scene: Scene | PinScene,
    varied: tuple[Parameter, ...],
    folder: Path,
    begin: Callable[[str], None],
    end: Callable[[float], None],
) -> Callable[[Setting, float], Measurement]:
    """Function that runs a setting in a process of its own, or reads its result from the folder."""
    if isinstance(scene, Scene):
        scene = replace(
            scene, part=replace(scene.part, outline=replace(scene.part.outline))
        )  # a copy without cached values, which would change the digest
    ladders = tuple(parameter.ladder for parameter in varied)

    def run(setting: Setting, left: float) -> Measurement:
        begin(", ".join(labels_of(ladders, setting).values()))
        try:
            there = with_setting(scene, varied, setting)
        except SceneError as error:
            return Measurement(status=GAVE_UP, message=str(error))
        for attempt in itertools.count():
            found, restored = _measured(Point(there, attempt), left, folder)
            if not (restored and _has_time_now(found, left)):
                break
        end(found.wall)
        return found

    return run


def _has_time_now(found: Measurement, left: float) -> bool:
    """Whether a run that was stopped in an earlier call has enough time now."""
    if found.status != STOPPED:
        return False
    return left > (2 * found.wall if math.isnan(found.needed) else max(found.needed, 1.05 * found.wall))


def _measured(point: Point, left: float, folder: Path) -> tuple[Measurement, bool]:
    start = time.perf_counter()
    with one_thread_pool(1) as workers:
        limited = Limited(workers, left)
        (outcome,) = sweep(measure, [point], executor=limited, folder=folder, resume=True, classes=(Measurement,))
    if outcome.failure is None:
        return outcome.result, outcome.restored
    message = f"{outcome.failure.kind}: {outcome.failure.message}"
    return Measurement(status=GAVE_UP, message=message, wall=time.perf_counter() - start), False


def _write(out: OutFolder, found: Cost, *, figures: bool) -> None:
    out.write_table(CSV, found.table())
    out.write_json(JSON, found.as_dict())
    if figures and found.study.front():
        from ngwear.error_estimates.cost_figure import draw_cost

        figure = draw_cost(found.scene, found.study, found.choices)
        out.replace(PNG, lambda file: figure.savefig(file, dpi=150, format="png"))


class _Bar:
    """Progress bar: seconds of the budget, and the present run."""

    def __init__(self, budget: float, *, shown: bool) -> None:
        self._budget, self._shown = budget, shown

    def __enter__(self) -> _Bar:
        from tqdm import tqdm

        shape = "{desc}: {percentage:3.0f}% of the budget |{bar}| {n:.0f}/{total:.0f} s {postfix}"
        self._bar = tqdm(total=self._budget, desc="cost", disable=not self._shown, dynamic_ncols=True, bar_format=shape)
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.close()

    def begin(self, setting: str) -> None:
        self._bar.set_postfix_str(setting)

    def end(self, seconds: float) -> None:
        self._bar.update(min(seconds, self._budget - self._bar.n))  # beyond its total tqdm does not show the total
