"""States carried over to a new mesh: brought near their equilibrium there by springs that hold the outline."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ngwear.equilibrium.attempts import ROUNDED
from ngwear.equilibrium.newton import NewtonOptions, Report, iterate
from ngwear.equilibrium.problem import Problem
from ngwear.loop.state import State

Array = NDArray[np.float64]

# Of G / L: the first springs hold the outline while the section beneath finds its stresses, the last hardly anything.
STRENGTHS = (1000.0, 30.0, 1.0)
HARDEST = 1 / 16  # of the way to an equilibrium: below, another way is taken (a shorter jump, or mounting anew)


def let_go(problem: Problem) -> list[Report]:
    """Bring the present state near equilibrium: springs hold the outline at where it was, weaker ones each time.

    The corners of the laws are rounded off meanwhile, by the first of ``attempts.ROUNDED`` with which all solves
    converge, so that contact on a new mesh does not alternate. Pseudo-transient continuation (Kelley & Keyes, *SIAM J.
    Numer. Anal.* 35 (1998) 508). Only a part with room to move has such springs. If none converges, the state is the
    present one, and the last report is a failure's.
    """
    reports: list[Report] = []
    for term in problem.terms:
        term.prepare()
        term.attempt(0)
    try:
        with problem.threads():
            for rounded in ROUNDED:
                for term in problem.terms:
                    term.round_off(rounded)
                reports += _let_go(problem)
                if reports[-1].converged:
                    break
    finally:
        for term in problem.terms:
            term.hold_back(0.0)
            term.round_off(0.0)
    return reports


def _let_go(problem: Problem) -> list[Report]:
    """The same with the laws as they are; after a failure the state is the first one."""
    reports: list[Report] = []
    vector = problem.state.vec.FV().NumPy()
    before = vector.copy()
    for strength in STRENGTHS:
        for term in problem.terms:
            term.hold_back(strength)
        reports.append(iterate(problem, NewtonOptions(damped=True)))
        if not reports[-1].converged:
            vector[:] = before
            break
    return reports


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
