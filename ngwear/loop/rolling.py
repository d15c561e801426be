"""A stroke in which friction rolls the part over: it is solved with as much of the friction as the part bears."""

from __future__ import annotations

import logging
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ngwear.equilibrium.newton import Outcome, Report
from ngwear.equilibrium.problem import Loads
from ngwear.equilibrium.stepping import StepOptions, Work, advance
from ngwear.errors import ConvergenceError
from ngwear.loop.finer_mesh import advance_on_finer
from ngwear.loop.stage import Stage
from ngwear.loop.state import State

Array = NDArray[np.float64]
log = logging.getLogger(__name__)

BELOW = 0.9  # of the friction from which on the part rolls over: wear and a new mesh move that by some per cent
LOWER = (0.5, 0.25, 0.0)  # times the friction at which it rolled on the way there
NEAREST = 1 / 16  # of the friction's limit: how near to rolling the state is searched


def is_rolling(error: ConvergenceError) -> bool:
    """Whether load steps have failed because friction rolls the part over."""
    return error.report is not None and error.report.outcome is Outcome.ROLLED


def advance_while_sliding(
    state: State,
    stroke: str,
    target: Loads,
    options: StepOptions,
    *,
    begin: Array,
    on_step: Callable[[float, Report], None] | None = None,
) -> Work:
    """As ``advance_on_finer``; where friction rolls the part over, ``hold_short_of_rolling``."""
    try:
        return advance_on_finer(state, target, options, begin=begin, on_step=on_step)
    except ConvergenceError as error:
        if not is_rolling(error):
            raise
        return hold_short_of_rolling(state.stage, stroke, target, error)


def hold_short_of_rolling(stage: Stage, stroke: str, target: Loads, error: ConvergenceError) -> Work:
    """From the last equilibrium before the part rolls over, bring on a stroke's loads, and friction while it slides.

    The stage's ``friction_shares`` then has the share of friction that acts in this stroke.

    Raises
    ------
    ConvergenceError
        If the part rolls with hardly any friction, or the loads without friction have no equilibrium.
    """
    problem, now = stage.problem, stage.problem.get_loads()
    slips = {name: target[name] for friction in stage.sliding.values() for name in friction.loads if target[name] != 0}
    if not slips:
        raise error
    same_way = {name: now[name] if now[name] * slips[name] > 0 else 0.0 for name in slips}
    work, lower = Work(), dict(target)
    for share in LOWER:
        lower |= {name: share * slip for name, slip in same_way.items()}
        try:
            work.add(advance(problem, {name: lower[name] for name in slips}, StepOptions(first=0.25)))
            work.add(advance(problem, lower, StepOptions(first=0.25)))
            break
        except ConvergenceError:
            if share == LOWER[-1]:
                raise error from None
    try:
        work.add(advance(problem, dict(target), StepOptions(first=NEAREST, smallest=NEAREST, largest=NEAREST)))
        return work
    except ConvergenceError as nearer:  # the state is the last one with which it slides
        log.info("%s", nearer)
    reached = problem.get_loads()
    held = BELOW * min(reached[name] / slips[name] for name in slips)
    if held <= 0:
        raise error
    work.add(advance(problem, {name: held * slip for name, slip in slips.items()}, StepOptions(first=0.5)))
    stage.friction_shares[stroke] = held
    log.info("stroke '%s': the part rolls over; %.0f %% of the friction act", stroke, 100 * held)
    return work
