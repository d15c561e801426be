"""Newton's method; its report states why it stopped."""

from __future__ import annotations

import enum
import math
from dataclasses import dataclass, field

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.unilateral import UnilateralContact
from ngwear.equilibrium.linear import RESIDUAL_TOLERANCE, DirectSolver, norm
from ngwear.equilibrium.problem import Problem


class Outcome(enum.Enum):
    """How a solve ended, with a remedy."""

    CONVERGED = "converged"
    TOO_MANY_ITERATIONS = "no convergence: take smaller load steps"
    FOLDED = "an element{at} would turn inside out: take smaller load steps or refine there"
    SINGULAR = "the tangent is singular: is the body held, and does every force-controlled surface touch it?"
    STALLED = "the corrections do not shrink: take smaller load steps"
    ROLLED = "the part rolls over on the way to another equilibrium"
    CREASED = "friction creases the surface on the way to an equilibrium"
    BAD_START = "the start state has inverted elements: start from a state closer to the solution"


SHORTEST = 1 / 64  # of a damped correction; it is taken even if the next one is longer
CREEPS = 3  # damped corrections in a row of which only SHORTEST is taken: such a solve is given up
LONGER = 4.0  # times the share taken of a damped correction: the first one tried of the next
HALVINGS = 7  # of a correction that would fold an element: to 1/64 of it; shorter ones get nowhere
# The next four change the time, hardly the result: settled on the rod seal and the shaft, whose
# steps took 5.2 iterations with LEAVES = 0.01 and 4.7 with 0.02 (``verify shaft_on_plate``; tutorial 2 for SMALL).
NEARLY = 1e3  # times the tolerance: a correction after which the tangent is kept,
SMALL = 0.05  # of the shortest element edge in contact, too
SHRINKS = 0.3  # times the correction before: the next, if the tangent is to be reused further
LEAVES = 0.02  # times the tolerance: error that a correction by a reused tangent may leave
EXACT = 1e-2  # of the residual left by a correction: its tangent is as good as Newton's own
PATIENCE = 8  # iterations within which the smallest correction must halve; an active set needs some to settle


@dataclass(frozen=True)
class NewtonOptions:
    """When to stop.

    Parameters
    ----------
    tolerance : float
        Largest accepted last displacement correction over the section's size [-]. Newton converges
        quadratically: the error left is far smaller.
    pressure_tolerance : float
        Largest accepted last correction of a nominal traction in contact over the highest one [-].
    max_iterations : int
    reuse : bool
        Start with the tangent of the previous solve, and reuse it as long as the corrections reduce the residual fast.
        The share of the residual that a correction leaves is the ratio of the next correction to it.
    damped : bool
        Halve a correction until the next one is shorter. Only for smooth laws: at a corner the next one may be longer.
    rounds, moves : bool
        Whether a solve that fails may go on by rounded laws, and over states out of equilibrium (``attempts.solve``).
    """

    tolerance: float = 1e-7  # of the section: 0.5 nm of one of 5 mm
    pressure_tolerance: float = 1e-3  # what is left after it is about its square
    max_iterations: int = 25  # a solve takes four to eight
    reuse: bool = False
    damped: bool = False
    rounds: bool = True
    moves: bool = True


@dataclass
class Report:
    """Report of a solve; ``place`` is where an element would turn inside out, in the undeformed section [mm]."""

    outcome: Outcome
    iterations: int = 0
    corrections: list[float] = field(default_factory=list)
    residual: float = math.nan
    linear_residual: float = 0.0
    rounded: bool = False  # whether it went by rounded laws, which takes many iterations but bears large steps
    place: tuple[float, ...] = ()

    @property
    def converged(self) -> bool:
        """Whether the state is an equilibrium."""
        return self.outcome is Outcome.CONVERGED

    def __str__(self) -> str:
        steps = " ".join(f"{c:.1e}" for c in self.corrections[-8:])
        at = f" at ({', '.join(f'{x:.4g}' for x in self.place)}) of the undeformed section" if self.place else ""
        ended = self.outcome.value.format(at=at)
        return f"{ended} (iterations {self.iterations}; last displacement corrections [mm] {steps})"


def iterate(problem: Problem, options: NewtonOptions) -> Report:
    """Newton's iteration from the problem's state, under its present loads; on failure the state is anything.

    Iterates whose energy is not finite (J <= 0 somewhere) are refused and the correction is halved, a few times.
    """
    size, edges = problem.body.size, [t.finest for t in problem.terms if isinstance(t, UnilateralContact)]
    nearly = min([NEARLY * options.tolerance * size, *(SMALL * edge for edge in edges)])
    u = problem.part(DISPLACEMENT)
    pressures = [problem.part(name) for term in problem.terms for name in term.tractions]
    vector = problem.state.vec
    residual, correction, trial = (vector.CreateVector() for _ in range(3))
    report = Report(Outcome.TOO_MANY_ITERATIONS)
    problem.residual(residual)
    if not math.isfinite(norm(residual)):
        report.outcome = Outcome.BAD_START
        return report
    kept, solver = False, problem.solver if options.reuse else None
    left = 1.0 if solver is None else 0.0
    goal, longest = options.tolerance * size, 1.0
    whole: list[float] = []  # corrections, undamped
    shortest = 0  # damped corrections in a row of which SHORTEST was taken
    for report.iterations in range(1, options.max_iterations + 1):
        kept = left <= EXACT if options.reuse else _will_do(report.corrections, nearly, kept=kept)
        if not kept:
            solver = problem.tangent()
        if solver is None:
            report.outcome = Outcome.SINGULAR
            break
        report.linear_residual = max(report.linear_residual, solver.solve(residual, correction))
        if not report.linear_residual < RESIDUAL_TOLERANCE:
            report.outcome = Outcome.SINGULAR
            break
        problem.limit(correction)
        before = solver.scaled_norm(residual) if options.reuse else 0.0
        asked = float(np.abs(correction.FV().NumPy()[u]).max())
        damps = options.damped and not kept and asked > goal  # below it, rounding decides which correction is shorter
        step, trial.data = longest if damps else 1.0, vector
        for _ in range(HALVINGS):
            vector.data = trial - step * correction
            problem.residual(residual)
            report.residual = norm(residual)
            if math.isfinite(report.residual):
                break
            step /= 2
        else:
            report.outcome, report.place = Outcome.FOLDED, problem.most_squeezed()
            break
        if damps:
            step = _damped(problem, solver, correction, trial, step, residual)
            longest = min(1.0, LONGER * step)
            shortest = shortest + 1 if step <= SHORTEST else 0
            report.residual = norm(residual)
        left = min(1.0, solver.scaled_norm(residual) / before) if before > 0 else 1.0
        change = step * asked
        report.corrections.append(change)
        whole.append(asked)
        # Far below the tolerance the displacement is exact, and further changes of pressure do no work.
        settled = change <= 1e-4 * goal or _settled(vector, correction, pressures, options.pressure_tolerance, left)
        leaves = change * _ratio(report.corrections) if kept and not options.reuse else 0.0
        if step == 1.0 and change <= goal and leaves <= LEAVES * goal and settled:
            report.outcome = Outcome.CONVERGED
            break
        if _stalled(whole) or shortest == CREEPS:
            report.outcome = Outcome.STALLED
            break
    return report


def _damped(
    problem: Problem,
    solver: DirectSolver,
    correction: ng.BaseVector,
    start: ng.BaseVector,
    step: float,
    residual: ng.BaseVector,
) -> float:
    """Share of a correction, at most ``step``, after which the next one, by the same tangent, is shorter.

    State and ``residual`` are those after ``step``, and of the share in the end. The natural monotonicity test,
    independent of the units of the equations (Deuflhard, *Newton Methods for Nonlinear Problems*, 2004, section 3.3).
    """
    state, length = problem.state.vec, solver.scaled_length(correction)
    following = state.CreateVector()
    while step > SHORTEST:
        solver.solve(residual, following)
        if solver.scaled_length(following) <= (1 - step / 4) * length:
            break
        step /= 2
        state.data = start - step * correction
        problem.residual(residual)
    return step


def _settled(
    vector: ng.BaseVector, correction: ng.BaseVector, parts: list[slice], tolerance: float, left: float
) -> bool:
    """Whether the last correction, times ``left``, is small for the tractions too (on a stiff body)."""
    values, change = vector.FV().NumPy(), correction.FV().NumPy()
    highest = max((np.abs(values[p]).max() for p in parts), default=0.0)
    moved = max((np.abs(change[p]).max() for p in parts), default=0.0)
    return bool(left * moved <= tolerance * highest or highest == 0.0)


def _will_do(corrections: list[float], mark: float, *, kept: bool) -> bool:
    """Whether the present tangent can be reused.

    It can after the first correction that is small compared with an element in contact, since it then differs little
    from Newton's own, and as long as corrections shrink. Assembly and factorisation are four fifths of an iteration.
    """
    if len(corrections) < 2 or corrections[-1] > mark:
        return False
    first = not kept and corrections[-2] > mark
    return first or _ratio(corrections) <= SHRINKS


def _ratio(corrections: list[float]) -> float:
    """The last correction over the one before; with a reused tangent also the next one over the last."""
    return corrections[-1] / corrections[-2] if len(corrections) > 1 and corrections[-2] > 0 else 0.0


def _stalled(corrections: list[float]) -> bool:
    """Whether the last few corrections are not smaller than those before."""
    if len(corrections) <= PATIENCE:
        return False
    return min(corrections[-PATIENCE:]) > 0.5 * min(corrections[:-PATIENCE])
