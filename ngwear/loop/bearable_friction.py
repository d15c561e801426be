"""A stroke whose friction rolls the part over, or creases its surface: solved with as much of it as the part bears."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ngwear.equilibrium.diagnosis import WRINKLING, creases
from ngwear.equilibrium.newton import Outcome, Report
from ngwear.equilibrium.problem import Loads
from ngwear.equilibrium.stepping import StepOptions, Work, advance
from ngwear.errors import ConvergenceError
from ngwear.loop.finer_mesh import advance_on_finer
from ngwear.loop.stage import Stage
from ngwear.loop.state import State

Array = NDArray[np.float64]
log = logging.getLogger(__name__)

BELOW = 0.9  # of the most friction that the part bears: wear and a new mesh move that by some per cent
LOWER = (0.5, 0.25, 0.0)  # times the friction that it did not bear on the way there
FIRST, SMALLEST = 1 / 8, 1 / 64  # load step with which that begins, and with which it is given up
NEAREST = 1 / 16  # of the friction's limit: how near to the most that it bears the state is searched
ROLLS, CREASES = "rolls the part over", "creases the surface"
WHY = {Outcome.ROLLED: ROLLS, Outcome.CREASED: CREASES}


def is_too_much(error: ConvergenceError) -> bool:
    """Whether load steps have failed because friction rolls the part over, or creases its surface."""
    return error.report is not None and error.report.outcome in WHY


def advance_while_sliding(
    state: State,
    stroke: str,
    target: Loads,
    options: StepOptions,
    *,
    begin: Array,
    on_step: Callable[[float, Report], None] | None = None,
) -> Work:
    """As ``advance_on_finer``; where the part does not bear the friction, ``lower_friction``."""
    stage, start = state.stage, _Start.of(state.stage)
    try:
        return advance_on_finer(state, target, options, begin=begin, on_step=on_step)
    except ConvergenceError as error:
        if not is_too_much(error):
            raise
        # On another mesh the beginning of the stroke is not known.
        return lower_friction(state.stage, stroke, target, error, start if state.stage is stage else None)


@dataclass(frozen=True)
class _Start:
    """The beginning of a stroke: equilibrium, loads, and what the fluids have done."""

    vector: Array
    loads: Loads
    passed: Array | None
    left: Array | None

    @classmethod
    def of(cls, stage: Stage) -> _Start:
        """The present state."""
        vector = stage.problem.state.vec.FV().NumPy().copy()
        return cls(vector, stage.problem.get_loads(), stage.fluid_passed(), stage.fluid_left())

    def restore(self, stage: Stage) -> None:
        """Go back to it."""
        stage.begin(self.vector)
        stage.problem.set_loads(self.loads)
        stage.let_fluid_pass(self.passed)
        stage.leave_fluid(self.left)
        stage.problem.state.vec.FV().NumPy()[:] = self.vector
        for term in stage.problem.terms:
            term.refresh()


def lower_friction(
    stage: Stage, stroke: str, target: Loads, error: ConvergenceError, start: _Start | None = None
) -> Work:
    """Bring on a stroke's loads with less friction, and then friction as long as the part slides with it.

    From the beginning of the stroke, if it is given, else from the last equilibrium. The stage's ``friction_shares``
    then has the share of friction that acts in this stroke, and what more of it does.

    Raises
    ------
    ConvergenceError
        If the part bears hardly any friction, or the loads without friction have no equilibrium.
    """
    problem, now = stage.problem, stage.problem.get_loads()
    slips = {name: target[name] for friction in stage.sliding.values() for name in friction.loads if target[name] != 0}
    if not slips:
        raise error
    reached = min(max(0.0, now[name] / slip) for name, slip in slips.items())
    why = WHY[error.report.outcome] if error.report is not None else ""
    work, looks, held, goal = Work(), False, 0.0, 0.0
    for share in LOWER:
        goal = share * reached
        try:
            work.add(_with_less_friction(stage, target, {name: goal * slip for name, slip in slips.items()}, start))
        except ConvergenceError:
            if share == LOWER[-1]:
                raise error from None
            continue
        # Coarse elements bear more than the surface: it must not wrinkle, unless the squeeze alone does that.
        looks = why == CREASES and not creases(problem, WRINKLING)
        if looks or why != CREASES:
            break
    while not (looks and creases(problem, WRINKLING)):
        held = goal
        if held == 1.0:
            return work
        goal = min(1.0, held + NEAREST)
        try:
            work.add(advance(problem, {name: goal * slip for name, slip in slips.items()}, StepOptions(smallest=1.0)))
        except ConvergenceError as nearer:  # the state is the last one with which it slides
            log.info("%s", nearer)
            break
    held *= BELOW
    if held <= 0:
        raise error
    less = {name: held * slip for name, slip in slips.items()}
    try:
        work.add(advance(problem, less, StepOptions(first=0.5, smallest=SMALLEST)))
    except ConvergenceError:  # a surface that has creased does not come back by itself
        work.add(_with_less_friction(stage, target, less, start))
    before, _ = stage.friction_shares.get(stroke, (1.0, ""))  # found on coarser elements
    stage.friction_shares[stroke] = (held * before, why)
    log.info("stroke '%s': friction %s; %.0f %% of it act", stroke, why, 100 * held * before)
    return work


def _with_less_friction(stage: Stage, target: Loads, slips: Loads, start: _Start | None) -> Work:
    """Bring on a stroke's loads, with these of friction in place of its own."""
    options, lower = StepOptions(first=FIRST, smallest=SMALLEST), {**target, **slips}
    if start is not None:
        start.restore(stage)
        return advance(stage.problem, lower, options)
    work = advance(stage.problem, slips, options)
    work.add(advance(stage.problem, lower, options))
    return work
