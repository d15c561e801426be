"""Order of the runs of a cost study, and which runs do not fit the budget."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from ngwear.error_estimates.cost_study import TARGETS, Study
from ngwear.error_estimates.ladder import STOPPED, Ladder, Measurement, Setting, with_level
from ngwear.error_estimates.pareto_front import cheapest
from ngwear.errors import SceneError

# Shares of the budget, in the order in which they are spent: what a short budget tells depends on them, no result does.
# Tried on the rod seal and the shaft within 600 and 300 s (``ngwear cost``).
CONFIRMING, CONFIRMING_RUNS = 0.15, 2.0  # of the budget, or runs of the base: kept for the settings recommended
FIRST = 0.5  # of what is left: what a first run, and then the scene's own, may take
OTHERS = 0.5  # of what is left: what ladders other than the mesh's may be expected to take, else on a coarser mesh
TOGETHER = 0.4  # of what is then left: what a run with all parameters at their finest may take
BEYOND = 30.0  # s: what a run may take that only tells what one takes, where the budget did not even show that
Measure = Callable[[Setting, float], Measurement]


@dataclass(frozen=True)
class Choice:
    """Recommended setting for a target error.

    Attributes
    ----------
    target : float
        Relative error of the main quantity.
    setting : tuple of int or None
        None if no setting is known to reach it.
    measured : bool
        True: the setting has been run. False: it is predicted from runs that differ in one parameter each.
    """

    target: float
    setting: Setting | None
    measured: bool = False


def run_ladders(ladders: tuple[Ladder, ...], main: str, budget: float, measure: Measure) -> Study:
    """Run the levels of all ladders from coarse to fine, the cheapest next level first, within the budget.

    A ladder whose coarsest level is that of the scene gives no information until a finer one is run: it comes first.

    Parameters
    ----------
    ladders : tuple of Ladder
        The ladder of the mesh first.
    main : str
        The quantity to which the target errors belong.
    budget : float
        Wall time of all runs [s].
    measure : callable
        Runs a setting, with a limit of time [s], and returns its Measurement.

    Raises
    ------
    SceneError
        If the budget is too small for one run.
    """
    study = Study(ladders, main, tuple(ladder.own for ladder in ladders))
    base = _run_mesh_ladder(study, budget, measure)
    study.base = with_level(study.own, 0, base)
    ended: set[int] = set()
    first = study.runs.get(study.base)
    ladder_budget = budget - min(CONFIRMING * budget, CONFIRMING_RUNS * (first.wall if first else budget))
    while len(ended) < len(ladders):
        waiting = {}
        for k in set(range(len(ladders))) - ended:
            level = _next_level(study, k)
            if level is None:
                ended.add(k)
            else:
                waiting[k] = level, study.next_seconds(k, level)
        if not waiting:
            break
        k = min(waiting, key=lambda k: (not _has_base_only(study, k), waiting[k][1], k))
        level, seconds = waiting[k]
        setting = with_level(study.base, k, level)
        if not seconds <= ladder_budget - study.spent:
            _leave_out(study, k, level, seconds)
            ended.add(k)
        elif _run(study, setting, ladder_budget, measure).status == STOPPED:
            ended.add(k)
    return study


def _run(study: Study, setting: Setting, budget: float, measure: Measure, *, share: float = 1.0) -> Measurement:
    """Run a setting for at most a share of the remaining time; a run that is stopped counts as left out."""
    run = measure(setting, share * (budget - study.spent))
    study.runs[setting] = run
    if run.status == STOPPED:
        study.left_out[setting] = run.needed
    return run


def _run_mesh_ladder(study: Study, budget: float, measure: Measure) -> int:
    """Run the scene on a coarser mesh and on its own; return the mesh level for the other ladders.

    Still coarser meshes are used only if this is too slow: on them wear may need many more steps.
    """
    mesh = study.ladders[0]
    first = max(mesh.own - 1, 0)
    _run(study, with_level(study.own, 0, first), budget, measure, share=FIRST)
    level = first - 1
    while level >= 0 and not study.levels(0) and study.spent < budget:
        _run(study, with_level(study.own, 0, level), budget, measure)
        level -= 1
    if mesh.own > first and study.next_seconds(0, mesh.own) <= FIRST * (budget - study.spent):
        _run(study, study.own, budget, measure)
    _refuse_if_none_fits(study, budget, measure)
    walls = {level: run.wall for level, run in study.levels(0).items()}
    left = OTHERS * (budget - study.spent)
    fit = [level for level, wall in walls.items() if wall * _other_runs(study) <= left]
    return max(fit) if fit else min(walls, key=lambda level: walls[level], default=mesh.own)


def _other_runs(study: Study) -> float:
    """Time of the other ladders up to one level finer than the scene, over a run of the scene on the same mesh."""
    runs = 1.0
    for ladder in study.ladders[1:]:
        own = ladder.values[ladder.own]
        values = ladder.values[: ladder.own + 2]
        runs += sum((own / value) ** ladder.cost_exponent if own and value else 1.0 for value in values)
    return runs


def _next_level(study: Study, k: int) -> int | None:
    """The coarsest level of a ladder that has not been run; None at its end."""
    ladder = study.ladders[k]
    tried = [i for i in range(len(ladder.values)) if with_level(study.base, k, i) in study.runs]
    levels = study.levels(k)
    finest = max(levels, default=-1)
    left = [i for i in range(len(ladder.values)) if i not in tried and not ladder.own < i < finest]
    failed_fine = any(i > ladder.own and not study.runs[with_level(study.base, k, i)].ok for i in tried)
    if not left or failed_fine or study.settled(k):
        return None
    if ladder.most_solves and 0 <= finest < left[0] and levels[finest].solves >= ladder.most_solves:
        return left[-1]  # each stroke is solved already: smaller tolerances change nothing
    return left[0]


def _has_base_only(study: Study, k: int) -> bool:
    """Whether a ladder has no run other than the base, which is its coarsest level."""
    return study.ladders[k].own == 0 and len(study.levels(k)) < 2


def _leave_out(study: Study, k: int, level: int, seconds: float) -> None:
    """Record a level for which there is no time, and that of the scene if it is finer."""
    study.left_out[with_level(study.base, k, level)] = seconds
    own = study.ladders[k].own
    if own > level and with_level(study.base, k, own) not in study.runs:
        study.left_out[with_level(study.base, k, own)] = study.next_seconds(k, own)


def _refuse_if_none_fits(study: Study, budget: float, measure: Measure) -> None:
    """SceneError if all runs had to be stopped, with the time that one run needs.

    If that time is not known, it is measured by a run beyond the budget of at most ``BEYOND`` seconds.
    """
    stopped = {setting: run for setting, run in study.runs.items() if run.status == STOPPED}
    if not stopped or len(stopped) < len(study.runs):
        return
    setting = min(stopped, key=lambda s: (stopped[s].needed if math.isfinite(stopped[s].needed) else math.inf, s))
    run, source = stopped[setting], ""
    if not math.isfinite(run.needed):
        run = measure(setting, BEYOND)
        source = f" (measured by a run of {_rounded(run.wall)} s beyond the budget)"
    needed = run.needed if run.status == STOPPED else run.wall
    known = math.isfinite(needed)
    takes = f"about {_rounded(needed)} s" if known else f"more than {_rounded(run.wall)} s"
    give = f"give {_rounded(10 * needed)} s or more for a study" if known else "give many times as much"
    label = study.ladders[0].labels[setting[0]]
    raise SceneError(
        "cost.budget", budget, f"is too small for one run: on a mesh of {label} it takes {takes}{source}; {give}"
    )


def _rounded(seconds: float) -> str:
    """Two digits, without an exponent."""
    return f"{float(f'{seconds:.2g}'):g}"


def confirm(study: Study, budget: float, measure: Measure) -> list[Choice]:
    """Run the fastest setting for each target within the budget; a setting that misses its target is replaced.

    If there is time, all parameters at their finest are run first: this shows whether their errors add up.

    Parameters
    ----------
    study : Study
        The runs are added to it.
    budget : float
        Wall time of all runs [s].
    measure : callable
    """
    if any(len(study.levels(k)) < 2 for k in range(len(study.ladders))) or study.base not in study.runs:
        return [Choice(target, None) for target in TARGETS]
    if study.seconds(study.finest, wall=True) <= TOGETHER * (budget - study.spent):
        _run(study, study.finest, budget, measure)
    choices = [_confirmed(study, target, budget, measure) for target in TARGETS]
    # A run for another target may be faster.
    return [_cheapest_run(study, c.target, c.setting) if c.measured else c for c in choices]


def _confirmed(study: Study, target: float, budget: float, measure: Measure) -> Choice:
    unfit: set[Setting] = set()
    while True:
        setting = cheapest(
            target,
            [study.levels(k) for k in range(len(study.ladders))],
            lambda s: study.predicted_error(s, study.main),
            study.seconds,
            unfit,
            study.own,
        )
        if setting is None:
            return Choice(target, None)
        if setting not in study.runs:
            if study.seconds(setting, wall=True) > budget - study.spent:
                return _cheapest_run(study, target, setting)
            _run(study, setting, budget, measure)
        if study.runs[setting].ok and study.error(setting, study.main) <= target:
            return Choice(target, setting, measured=True)
        unfit.add(setting)


def _cheapest_run(study: Study, target: float, predicted: Setting | None) -> Choice:
    """The fastest run that reaches the target; without one, the predicted setting."""
    fit = [s for s in study.front() if study.error(s, study.main) <= target]
    return Choice(target, fit[0], measured=True) if fit else Choice(target, predicted)
