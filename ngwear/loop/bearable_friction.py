"""A stroke whose friction rolls the part over, or creases its surface: solved with as much of it as the part bears."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ngwear.equilibrium.diagnosis import CRUSHED, WRINKLING, creases
from ngwear.equilibrium.newton import Outcome, Report
from ngwear.equilibrium.problem import Loads, Problem
from ngwear.equilibrium.stepping import StepOptions, Work, advance
from ngwear.errors import ConvergenceError, MeshError
from ngwear.loop.finer_mesh import advance_on_finer
from ngwear.loop.solution_checks import CREASES, CRUSHES, NO_STATE, ROLLS
from ngwear.loop.stage import Stage
from ngwear.loop.state import State

Array = NDArray[np.float64]
log = logging.getLogger(__name__)

BELOW = 0.9  # of the most friction that the part bears: wear and a new mesh move that by some per cent
LOWER = (0.5, 0.25, 0.0)  # times the friction that it did not bear on the way there
REVERSED = (1.0, 0.5, 0.25)  # times its own, before the other loads, if it fails while the friction still reverses
FIRST, SMALLEST = 1 / 8, 1 / 64  # load step with which that begins, and with which it is given up
NEAREST = 1 / 16  # of the friction's limit: how near to the most that it bears the state is searched,
NEARER = 1 / 4  # and of what it did not bear on the way, if that is nearer
LEAST = 1 / 64  # of its friction: a part that does not bear this bears none
WHY = {Outcome.ROLLED: ROLLS, Outcome.CREASED: CREASES}


def reason(error: ConvergenceError | MeshError) -> str:
    """What friction does that a part does not bear, from how load steps with it have failed."""
    report = error.report if isinstance(error, ConvergenceError) else None
    return NO_STATE if report is None else WHY.get(report.outcome, NO_STATE)


def is_too_much(error: ConvergenceError) -> bool:
    """Whether load steps have failed because friction rolls the part over, or creases its surface."""
    return reason(error) != NO_STATE


def takes_less(stage: Stage, stroke: str, error: ConvergenceError) -> bool:
    """Lower the friction of a stroke for the next solve, if the part does not bear it any more; False if it is not."""
    share, _ = stage.friction_shares.get(stroke, (1.0, ""))
    if not (stage.floats and stage.sliding and is_too_much(error)) or BELOW * share < LEAST:
        return False
    stage.friction_shares[stroke] = (BELOW * share, reason(error))
    log.info("stroke '%s': %.0f %% of the friction act", stroke, 100 * BELOW * share)
    return True


def advance_while_sliding(
    state: State,
    stroke: str,
    target: Loads,
    options: StepOptions,
    *,
    begin: Array,
    on_step: Callable[[float, Report], None] | None = None,
    lowers: bool = True,
) -> tuple[Work, bool]:
    """As ``advance_on_finer``; where the part does not bear the friction, ``lower_friction``.

    Not if friction rolls it over, unless ``lowers``.

    Returns the work, and whether the whole way was that of ``on_step``.

    Coarse elements bear more than the rubber: an equilibrium with a crushed element does not count, if there is one
    without, with less friction.
    """
    stage, start, saved = state.stage, Start.of(state.stage), state.saved()
    bears = not (stage.floats and stage.sliding)
    try:
        work = advance_on_finer(state, target, options, begin=begin, on_step=on_step)
    except (ConvergenceError, MeshError) as error:
        if bears:
            raise
        if state.stage is not stage:
            state.restore(saved)
        if reason(error) == ROLLS and not lowers:
            raise
        return lower_friction(stage, stroke, target, error, start), False
    whole = True
    if state.stage is stage and not bears and _is_crushed(stage.problem):
        end = Start.of(stage)
        try:
            crushed = ConvergenceError("a crushed element")
            work.add(lower_friction(stage, stroke, target, crushed, start, must_not=_is_crushed))
            whole = False
        except ConvergenceError:
            end.restore(stage)
            stage.begin(start.vector)
    return work, whole


def _never(problem: Problem) -> bool:
    return False


def _is_crushed(problem: Problem) -> bool:
    return bool(problem.jacobians().min() < CRUSHED)


@dataclass(frozen=True)
class Start:
    """A state to go back to: equilibrium, loads, what the fluids have done, and what stick and slip have counted."""

    vector: Array
    loads: Loads
    passed: Array | None
    left: Array | None
    counted: tuple[tuple[float, float | Array], ...]

    @classmethod
    def of(cls, stage: Stage) -> Start:
        """The present state."""
        vector = stage.problem.state.vec.FV().NumPy().copy()
        counted = tuple(friction.counted for friction in stage.sticking.values())
        return cls(vector, stage.problem.get_loads(), stage.fluid_passed(), stage.fluid_left(), counted)

    def restore(self, stage: Stage) -> None:
        """Go back to it and begin the stroke there."""
        stage.begin(self.vector)
        self._set(stage)

    def put_back(self, stage: Stage) -> None:
        """Go back to it within the stroke."""
        self._set(stage)
        for friction, counted in zip(stage.sticking.values(), self.counted, strict=True):
            friction.go_back(counted)

    def _set(self, stage: Stage) -> None:
        stage.problem.set_loads(self.loads)
        stage.let_fluid_pass(self.passed)
        stage.leave_fluid(self.left)
        stage.problem.state.vec.FV().NumPy()[:] = self.vector
        for term in stage.problem.terms:
            term.refresh()


def lower_friction(
    stage: Stage,
    stroke: str,
    target: Loads,
    error: ConvergenceError | MeshError,
    start: Start,
    *,
    must_not: Callable[[Problem], bool] | None = None,
) -> Work:
    """Bring on a stroke's loads from its beginning with less friction, and then friction as long as the part slides.

    The stage's ``friction_shares`` then has the share of friction that acts in this stroke, and what more of it does.
    ``must_not`` says of a state whether the friction is too much, though it is an equilibrium.

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
    why = reason(error) if must_not is None else CRUSHES
    work, held, goal, before_others = Work(), 0.0, 0.0, False
    over = must_not or (partial(creases, stretch=WRINKLING) if why == CREASES else _never)
    goals = (
        [(share * reached, False) for share in LOWER] if reached > 0 else [(0.0, False), *((s, True) for s in REVERSED)]
    )
    comes_on = False
    for goal, before_others in goals:
        less = {name: goal * slip for name, slip in slips.items()}
        try:
            work.add(_with_less_friction(stage, target, less, start, before_others=before_others))
        except ConvergenceError:
            comes_on = False
            continue
        comes_on = True
        if not over(problem):
            break
    else:
        if must_not is not None or not comes_on:
            raise error
        over = _never  # the squeeze alone wrinkles it
    begun, step = goal, min(NEAREST, NEARER * reached) if reached > 0 else NEAREST
    slid: list[tuple[float, Start]] = []  # states in which it slides, and the shares of friction
    while not over(problem):
        held = goal
        slid.append((held, Start.of(stage)))
        if held == 1.0:
            return work
        goal = min(1.0, held + step)
        try:
            work.add(advance(problem, {name: goal * slip for name, slip in slips.items()}, StepOptions(smallest=1.0)))
        except ConvergenceError as nearer:  # the state is the last one with which it slides
            log.info("%s", nearer)
            why = reason(nearer) if why == NO_STATE else why
            break
    before, _ = stage.friction_shares.get(stroke, (1.0, ""))  # found on coarser elements
    for share, options, state in _ways(slid, held, begun):
        if share * before < LEAST:
            raise error
        held, less = share, {name: share * slip for name, slip in slips.items()}
        if state is not None:
            state.put_back(stage)
        try:
            if options is None:
                work.add(_with_less_friction(stage, target, less, start, before_others=before_others))
            else:
                work.add(advance(problem, less, options))
            break
        except ConvergenceError as failed:
            log.info("%s", failed)
    else:
        raise error
    stage.friction_shares[stroke] = (held * before, why)
    log.info("stroke '%s': friction %s; %.0f %% of it act", stroke, why, 100 * held * before)
    return work


def _ways(
    slid: list[tuple[float, Start]], held: float, begun: float
) -> Iterator[tuple[float, StepOptions | None, Start | None]]:
    """Shares of the friction to slide with, and by which steps from which state; None: from the stroke's beginning.

    What has creased, or rolled on, does not come back by itself: so from the last state with less friction in one step,
    as on the way up; else back from the last state, or from the beginning, at last by a way that was gone.
    """
    for _, state in [known for known in slid if known[0] <= BELOW * held][-1:]:
        yield BELOW * held, StepOptions(smallest=1.0), state
    for _, state in slid[-1:]:
        yield BELOW * held, StepOptions(first=0.5, smallest=SMALLEST), state
    for share in (BELOW * held, BELOW**2 * held, begun):
        yield share, None, None


def _with_less_friction(stage: Stage, target: Loads, slips: Loads, start: Start, *, before_others: bool) -> Work:
    """Bring on a stroke's loads from its beginning, with these of friction in place of its own, maybe before others."""
    start.restore(stage)
    options, work = StepOptions(first=FIRST, smallest=SMALLEST), Work()
    if before_others:
        work.add(advance(stage.problem, slips, options))
    work.add(advance(stage.problem, {**target, **slips}, options))
    return work
