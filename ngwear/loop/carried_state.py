"""States carried over to a new mesh: brought near their equilibrium there by springs that hold the outline."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ngwear.equilibrium.attempts import let_go
from ngwear.equilibrium.stepping import StepOptions
from ngwear.errors import ConvergenceError
from ngwear.loop.stage import Stage
from ngwear.loop.state import Phase, State
from ngwear.scene.program import Stroke

Array = NDArray[np.float64]

HARDEST = 1 / 16  # of the way to an equilibrium: below, another way is taken (a shorter jump, or mounting anew)


def set_to_end(stage: Stage, phase: Phase, stroke: Stroke) -> None:
    """Set loads, fluids and first guess of the end of a stroke; slip counts from there, so that what sticks stays."""
    stage.problem.set_loads(stage.stroke_loads(stroke))
    stage.begin(phase.vector)
    stage.leave_fluid(phase.left)
    set_guess(stage, phase.vector, phase.passed)


def set_guess(stage: Stage, vector: Array, passed: Array | None) -> None:
    """Set the first guess of a solve, and how far the fluids have passed contacts in it."""
    stage.let_fluid_pass(passed)
    stage.problem.state.vec.FV().NumPy()[:] = vector
    for term in stage.problem.terms:
        term.refresh()


def settle_carried(state: State) -> None:
    """Let go the end of each stroke of the cycle, as carried over to a new mesh.

    A point that sticks at the end of a stroke stays where it is.

    Raises
    ------
    ConvergenceError
        If friction sticks, and springs do not hold the end of the last stroke: the next stroke begins there.
    """
    stage, cycle = state.stage, state.stage.scene.program.cycle
    vector = stage.problem.state.vec.FV().NumPy()
    for phase, stroke in zip(state.phases, cycle, strict=True):
        set_to_end(stage, phase, stroke)
        moved = False
        for _ in range(StepOptions.max_updates):
            reports = let_go(stage.problem)
            for report in reports:
                state.work.count(report)
            if not reports[-1].converged:
                break
            phase.vector, phase.passed, moved = vector.copy(), stage.fluid_passed(), True
            if not any([term.refresh(solved=True) for term in stage.problem.terms]):
                break
    if stage.has_stick_slip and not moved:
        raise ConvergenceError("springs do not bring the last stroke of the cycle near an equilibrium", reports[-1])
