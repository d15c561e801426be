"""States carried over to a new mesh: brought near their equilibrium there by springs that hold the outline."""

from __future__ import annotations

from ngwear.equilibrium.attempts import let_go
from ngwear.loop.state import State

HARDEST = 1 / 16  # of the way to an equilibrium: below, another way is taken (a shorter jump, or mounting anew)


def settle_carried(state: State) -> None:
    """Let go the end of each stroke of the cycle, as carried over to a new mesh, from the last one on.

    A point that sticks at the end of the last stroke stays where it is.
    """
    stage, cycle = state.stage, state.stage.scene.program.cycle
    vector = stage.problem.state.vec.FV().NumPy()
    for i in range(-1, len(cycle) - 1):
        phase, before = state.phases[i], state.phases[i if i < 0 else i - 1]
        stage.begin(before.vector)
        stage.leave_fluid(before.left)
        stage.problem.set_loads(stage.stroke_loads(cycle[i]))
        stage.let_fluid_pass(phase.passed)
        vector[:] = phase.vector
        for term in stage.problem.terms:
            term.refresh()
        for report in let_go(stage.problem):
            state.work.count(report)
        phase.vector = vector.copy()
