"""In which order a study's runs are made, and which are not begun because they would not fit the budget."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from ngwear.costs.front import cheapest
from ngwear.costs.ladder import STOPPED, Ladder, Measurement, Setting, rung_of
from ngwear.costs.study import TARGETS, Study
from ngwear.errors import SceneError

CONFIRMING = 0.15  # of the budget: kept for runs of the settings that are recommended
OTHERS = 0.5  # of the budget: what ladders other than the mesh's may be expected to take, else on a coarser mesh
Measure = Callable[[Setting, float], Measurement]


@dataclass(frozen=True)
class Choice:
    """What is recommended for a target.

    Attributes
    ----------
    target : float
        Relative error of the main quantity.
    setting : tuple of int or None
        None if no setting is known to reach it.
    measured : bool
        Whether the setting itself has been run, or is put together from runs that differ in one knob each.
    """

    target: float
    setting: Setting | None
    measured: bool = False


def climb(ladders: tuple[Ladder, ...], main: str, budget: float, measure: Measure) -> Study:
    """Climb the ladders from coarse to fine, the cheapest rung of all first, as far as the budget reaches.

    Parameters
    ----------
    ladders : tuple of Ladder
        That of the mesh first.
    main : str
        The quantity that the targets are about.
    budget : float
        Wall seconds of all runs.
    measure : callable
        Of a setting and the seconds left; it stops a run that takes more.

    Raises
    ------
    SceneError
        If not even the coarsest run fits.
    """
    study = Study(ladders, main, tuple(ladder.own for ladder in ladders))
    own = study.own
    mesh_rungs = _climb_mesh(study, budget, measure)
    study.base = rung_of(own, 0, mesh_rungs)
    ended: set[int] = set()
    ladder_budget = (1 - CONFIRMING) * budget
    while len(ended) < len(ladders):
        waiting = {}
        for k in set(range(len(ladders))) - ended:
            rung = _next_rung(study, k)
            if rung is None:
                ended.add(k)
            else:
                waiting[k] = rung, study.next_seconds(k, rung)
        if not waiting:
            break
        k = min(waiting, key=lambda k: (waiting[k][1], k))
        rung, seconds = waiting[k]
        setting = rung_of(study.base, k, rung)
        if not seconds <= ladder_budget - study.spent:
            _leave_out(study, k, rung, seconds)
            ended.add(k)
        elif _run(study, setting, budget, measure).status == STOPPED:
            ended.add(k)
    return study


def _run(study: Study, setting: Setting, budget: float, measure: Measure) -> Measurement:
    run = measure(setting, budget - study.spent)
    study.runs[setting] = run
    if run.status == STOPPED:
        study.left_out[setting] = run.needed
    return run


def _climb_mesh(study: Study, budget: float, measure: Measure) -> int:
    """Run the mesh's ladder up to the rung on which the other ladders are climbed; return that rung."""
    mesh = study.ladders[0]
    for rung in range(mesh.own + 1):
        if study.rungs(0) and study.next_seconds(0, rung) * _other_runs(study) > OTHERS * budget:
            break
        run = _run(study, rung_of(study.own, 0, rung), budget, measure)
        if run.status == STOPPED:
            if not study.rungs(0):
                _refuse(budget, run, mesh.labels[rung])
            break
    return max(study.rungs(0), default=mesh.own)


def _other_runs(study: Study) -> float:
    """What the other ladders take up to a rung beyond the scene's, over a run of the scene on the same mesh."""
    runs = 1.0
    for ladder in study.ladders[1:]:
        own = ladder.values[ladder.own]
        values = ladder.values[: ladder.own + 2]
        runs += sum((own / value) ** ladder.growth if own and value else 1.0 for value in values)
    return runs


def _next_rung(study: Study, k: int) -> int | None:
    """The coarsest rung of a ladder that has not been tried; None at its end."""
    ladder = study.ladders[k]
    tried = [i for i in range(len(ladder.values)) if rung_of(study.base, k, i) in study.runs]
    rung = next((i for i in range(len(ladder.values)) if i not in tried), None)
    failed_fine = any(i > ladder.own and not study.runs[rung_of(study.base, k, i)].ok for i in tried)
    return None if failed_fine or study.settled(k) else rung


def _leave_out(study: Study, k: int, rung: int, seconds: float) -> None:
    """Note a rung for which there is no time, and the scene's own if it is finer still."""
    study.left_out[rung_of(study.base, k, rung)] = seconds
    own = study.ladders[k].own
    if own > rung:
        study.left_out[rung_of(study.base, k, own)] = study.next_seconds(k, own)


def _refuse(budget: float, run: Measurement, label: str) -> None:
    known = math.isfinite(run.needed)
    takes = f"about {run.needed:.0f} s" if known else f"more than {run.wall:.0f} s"
    give = f"give a few times {run.needed:.0f} s" if known else "give many times as much"
    raise SceneError(
        "cost.budget", budget, f"does not reach for one run: on the coarsest mesh ({label}) it takes {takes}; {give}"
    )


def confirm(study: Study, budget: float, measure: Measure) -> list[Choice]:
    """The cheapest setting for each target, run as far as the budget reaches: what fails its target gives way.

    Parameters
    ----------
    study : Study
        Gets the runs.
    budget : float
        Wall seconds of all runs.
    measure : callable
    """
    if any(len(study.rungs(k)) < 2 for k in range(len(study.ladders))) or study.base not in study.runs:
        return [Choice(target, None) for target in TARGETS]
    return [_confirmed(study, target, budget, measure) for target in TARGETS]


def _confirmed(study: Study, target: float, budget: float, measure: Measure) -> Choice:
    unfit: set[Setting] = set()
    while True:
        setting = cheapest(
            target,
            [study.rungs(k) for k in range(len(study.ladders))],
            lambda s: study.predicted_error(s, study.main),
            study.seconds,
            unfit,
            study.own,
        )
        if setting is None:
            return Choice(target, None)
        if setting not in study.runs:
            if study.seconds(setting, wall=True) > budget - study.spent:
                return _fall_back(study, target, setting)
            _run(study, setting, budget, measure)
        if study.runs[setting].ok and study.error(setting, study.main) <= target:
            return Choice(target, setting, measured=True)
        unfit.add(setting)


def _fall_back(study: Study, target: float, predicted: Setting) -> Choice:
    """A run that reaches the target if there is one, else the setting that should."""
    fit = [s for s in study.front() if study.error(s, study.main) <= target]
    return Choice(target, fit[0], measured=True) if fit else Choice(target, predicted)
