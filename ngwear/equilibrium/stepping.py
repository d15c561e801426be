"""Load steps with a prediction from the last two states; shorter after a failed solve, longer after an easy one."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from ngwear.equilibrium.attempts import solve
from ngwear.equilibrium.diagnosis import ROLLS_OVER, creases, diagnosis, folds, has_collapsed, has_room, rolls
from ngwear.equilibrium.newton import NewtonOptions, Outcome, Report
from ngwear.equilibrium.problem import IMBALANCE, Loads, Problem
from ngwear.errors import ConvergenceError

# A fluid floods a gap at once, however short the load step: from SHORT on, its load is applied in steps to SHORTEST.
SHORT, SHORTEST = 1 / 8, 1 / 64
LOOSER = 1e3  # tolerance of a solve on the way over the last one's, if it only starts the next


@dataclass(frozen=True)
class StepOptions:
    """Step control from one set of loads to another.

    Parameters
    ----------
    first : float
        Fraction of the load change tried first, in (0, 1].
    smallest : float
        Fraction below which the stepping gives up.
    largest : float
        Fraction up to which the next step grows.
    easy : int
        Iterations up to which the next step grows.
    leaps : bool
        Whether a part with room to move may move over to another equilibrium.
    shorter : bool
        Whether shorter steps are tried after the part has rolled over on its way there: they may get there without, but
        it turns at hardly any load then, and needs many.
    max_updates : int
        Solves allowed for what terms fix within a solve (the fluid front) to settle.
    """

    first: float = 1.0
    smallest: float = 1 / 512  # nine halvings; a way that needs more ends in a report
    largest: float = 1.0
    easy: int = 8  # a third of the most iterations
    leaps: bool = True
    shorter: bool = True
    max_updates: int = 12  # a front that still moves is left then, within an edge of its place
    newton: NewtonOptions = field(default_factory=NewtonOptions)


@dataclass
class Work:
    """Cost of load steps: solves, Newton iterations and retries with a shorter step."""

    solves: int = 0
    iterations: int = 0
    retries: int = 0

    def count(self, report: Report) -> None:
        """Add one solve."""
        self.solves += 1
        self.iterations += report.iterations
        self.retries += not report.converged

    def add(self, other: Work) -> None:
        """Add another cost."""
        self.solves += other.solves
        self.iterations += other.iterations
        self.retries += other.retries


def settle(
    problem: Problem, options: StepOptions, work: Work, *, update: bool = True, gradually: bool = False
) -> Report:
    """Solve at the present loads, again while a term (the fluid front) asks for it, if ``update``.

    If what a term changes is too much for one solve, its load is applied in steps if ``gradually``.
    """
    for updates in range(options.max_updates):
        report = solve(problem, options.newton)
        work.count(report)
        if not report.converged:
            if updates == 0 or not update or not gradually or IMBALANCE in problem.get_loads():
                return report
            try:
                work.add(relax(problem, replace(options, first=0.25, smallest=SHORTEST)))
            except ConvergenceError:
                return report
            return replace(report, outcome=Outcome.CONVERGED)
        last = updates == options.max_updates - 1  # what the terms have fixed stays as it was solved: an equilibrium
        if not update or last or not any([term.refresh(solved=True) for term in problem.terms]):
            return report
    return report


def advance(
    problem: Problem,
    target: Loads,
    options: StepOptions | None = None,
    *,
    duration: float = math.inf,
    on_step: Callable[[float, Report], None] | None = None,
) -> Work:
    """Change the loads in steps from the present equilibrium to ``target``.

    Loads vary linearly in ``duration`` seconds, and every accepted step is committed to the history. On the way from a
    start state that is not an equilibrium, only the last step is committed: the intermediate states are fictitious, and
    sticking points must not slip by them. ``on_step`` is called with the fraction reached and the report of its solve.

    Raises
    ------
    ConvergenceError
        When the step has been cut back to ``smallest``; the state and loads are the last equilibrium.
    """
    options = options or StepOptions()
    start = {name: problem.get_loads()[name] for name in target} if target else {}
    vector = problem.state.vec
    last = vector.CreateVector()
    rate = vector.CreateVector()
    last.data = vector
    have_rate = stands = leaps = False
    changes = any(start[name] != target[name] for name in target)
    done, step, work = 0.0, options.first if changes else 1.0, Work()
    loose = options.newton.tolerance * LOOSER
    on_the_way = replace(options, newton=replace(options.newton, tolerance=loose))
    if any(term.remembers for term in problem.terms):
        on_the_way = options
    while done < 1.0:
        step = min(step, 1.0 - done)
        if 1.0 - done - step < 1e-9:
            step = 1.0 - done
        goal = 1.0 if leaps else done + step
        problem.set_loads({name: start[name] + goal * (target[name] - start[name]) for name in target})
        problem.set_time_step((goal - done) * duration)
        if have_rate:
            vector.data = last + step * rate
        # With an imbalance load the fluid front stays: moving it would change that load.
        update = IMBALANCE not in target or goal == 1.0
        here = options if goal == 1.0 else on_the_way
        moves = options.leaps and (leaps or step < 2 * options.smallest)
        gradually = step <= SHORT  # a longer one is halved first, before the laws are rounded off, too
        rounds = here.newton.rounds and (gradually or step < 2 * options.smallest)
        here = replace(here, newton=replace(here.newton, rounds=rounds, moves=moves))
        report = settle(problem, here, work, update=update, gradually=gradually)
        if have_rate and not report.converged and report.outcome is Outcome.BAD_START:
            vector.data = last
            report = settle(problem, here, work, update=update, gradually=gradually)
        if not report.converged:
            vector.data = last
            have_rate = False
            leapt = leaps
            stands |= leapt
            # Where the part moves over to another equilibrium, the loads on the way there say little: all at once.
            leaps = options.leaps and not stands and step <= SHORT and goal < 1.0
            leaps = leaps and IMBALANCE not in target and has_room(problem)
            if leaps:
                continue
            step /= 2
            beyond = report.outcome is Outcome.ROLLED and not (leapt and options.shorter)
            if has_room(problem):
                beyond |= has_collapsed(problem) or (step < SHORTEST and creases(problem))
            if step < options.smallest or beyond:
                problem.set_loads({name: start[name] + done * (target[name] - start[name]) for name in target})
                way = f"no equilibrium between {done:.1%} and {goal:.1%} of the load step to {dict(target)}"
                if rolls(problem):
                    report = replace(report, outcome=Outcome.ROLLED)
                elif creases(problem):
                    report = replace(report, outcome=Outcome.CREASED)
                cause = f"\n{ROLLS_OVER}" if report.outcome is Outcome.ROLLED else diagnosis(problem)
                raise ConvergenceError(way + (cause or folds(problem)), report, cause=cause)
            continue
        if update or math.isfinite(duration):
            problem.commit()
        rate.data = (1 / (goal - done)) * (vector - last)
        last.data = vector
        have_rate = True
        done = goal
        if on_step is not None:
            on_step(done, report)
        if report.iterations <= options.easy:
            step = min(2 * step, max(step, options.largest))
        elif report.iterations > 2 * options.easy and not report.rounded:
            step = max(step / 2, options.smallest)  # slow steps end, too
    return work


def relax(
    problem: Problem,
    options: StepOptions | None = None,
    *,
    duration: float = math.inf,
    on_step: Callable[[float, Report], None] | None = None,
) -> Work:
    """Find the equilibrium under the present loads from the present state, any admissible one.

    The imbalance of the start state becomes a fictitious load, which is removed in steps. Arguments and errors as of
    ``advance``.
    """
    problem.freeze_imbalance()
    try:
        return advance(problem, {IMBALANCE: 0.0}, options, duration=duration, on_step=on_step)
    finally:
        problem.drop_imbalance()
