"""A part with room to move that sticks: its cycle is solved without wear until it repeats itself."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable

import numpy as np

from ngwear.errors import ConvergenceError
from ngwear.loop.solution_checks import Finding
from ngwear.loop.state import State, StrokeReport
from ngwear.loop.stroke_report import Forces

log = logging.getLogger(__name__)

# Chosen: the list in tests/benchmarks/README.md says what was tried.
REPEATS, MOST_CYCLES = 0.02, 10  # of the largest force: change from a cycle to the next; and how many are solved
CYCLE_STEPS = 4  # load steps of each stroke in these cycles


def repeat_cycle(state: State, pass_stroke: Callable[[State, int], StrokeReport], forces: list[Forces]) -> float:
    """Solve the cycle without wear, each stroke in load steps from the one before, until it repeats itself.

    A part with room to move that sticks to a surface creeps there from cycle to cycle, away from where mounting has
    left it. A step of the wear stands for many cycles, so the wear begins where these repeat. If a cycle fails, the
    state is that of the one before.

    Parameters
    ----------
    state : State
    pass_stroke : callable
        Solves a stroke of the cycle without wear, by its index.
    forces : list of dict
        Forces on the part in each stroke of the last cycle.

    Returns
    -------
    float
        ``largest_change`` from the last cycle but one to the last [-]; 0 for a part that does not stick, infinite if
        the second cycle fails.
    """
    program = state.stage.scene.program
    creeps = bool(state.stage.floats) and state.stage.has_stick_slip
    cycles = min(MOST_CYCLES, program.strokes // len(program.cycle) - 1) if creeps else 0
    change = math.inf if cycles > 0 else 0.0
    for _ in range(cycles):
        saved = state.saved()
        try:
            reports = [pass_stroke(state, i) for i in range(len(program.cycle))]
        except ConvergenceError as error:
            log.info("%s: back to the cycle before", error)
            state.restore(saved)
            break
        state.reports, before = reports, forces
        forces = [report.forces for report in reports]
        change = largest_change(before, forces)
        log.info("forces differ by %.2g from those of the cycle before", change)
        if change <= REPEATS:
            break
    return change


def creeping(change: float) -> list[Finding]:
    """A finding if forces still change by more than ``REPEATS`` from cycle to cycle, or only one cycle is known."""
    if change <= REPEATS:
        return []
    if change == math.inf:
        sentence = (
            "the part sticks, and no equilibrium was found in its second cycle: the wear is that of the first one "
        )
        sentence += "after mounting, and where the part creeps it may be another; hold the part, or lower the friction"
        return [Finding("creep", 1.0, sentence)]
    sentence = f"the part still creeps where the wear begins: forces change by {100 * change:.0f} % of the largest "
    sentence += "from one cycle to the next, and the wear may change as much; hold the part, or lower the friction of "
    sentence += "what it rests on"
    return [Finding("creep", change, sentence)]


def largest_change(before: list[Forces], after: list[Forces]) -> float:
    """Largest change of a force on the part from one cycle to another, over the largest force [-]."""
    cycles = np.array([[list(forces.values()) for forces in cycle] for cycle in (before, after)])
    largest = float(np.abs(cycles).max(initial=0.0))
    return float(np.abs(cycles[1] - cycles[0]).max()) / largest if largest > 0 else 0.0
