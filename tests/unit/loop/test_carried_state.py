"""States carried over to a new mesh."""

import numpy as np
import pytest

from ngwear.equilibrium.attempts import let_go, solve
from ngwear.errors import ConvergenceError
from ngwear.loop import stepper
from ngwear.loop.carried_state import settle_carried
from ngwear.loop.finer_mesh import refine_everywhere
from ngwear.loop.stepper import Stepper


@pytest.fixture
def carried(ring):
    state = Stepper(ring).start()
    before = push(state)
    refine_everywhere(state)
    return state, before


def push(state):
    return float(state.reports[-1].forces["air wall"][0])


def set_last(state):
    stage, last = state.stage, state.phases[-1]
    stage.problem.set_loads(stage.stroke_loads(stage.scene.program.cycle[-1]))
    stage.begin(last.vector)
    stage.let_fluid_pass(last.passed)
    stage.problem.state.vec.FV().NumPy()[:] = last.vector
    for term in stage.problem.terms:
        term.refresh()
    return stage.problem


def test_springs_that_let_go_leave_nothing_behind(carried):
    state, _ = carried
    problem = set_last(state)
    reports = let_go(problem)
    assert reports[-1].converged
    near = problem.state.vec.FV().NumPy().copy()
    assert solve(problem).converged
    there = problem.state.vec.FV().NumPy()
    moved = np.abs(there - near)[: problem.fields["displacement"].space.ndof].max()
    assert moved < 1e-5 * problem.body.size
    forces = state.stage.forces()  # without the springs they balance
    assert abs(sum(forces.values())[0]) < 1e-6 * max(np.abs(force).max() for force in forces.values())


def test_the_cycle_settles_from_carried_states(ring, carried, monkeypatch):
    state, before = carried
    monkeypatch.setattr(stepper, "first_cycle", None)  # not mounted anew
    Stepper(ring).settle_on_new_mesh(state)
    assert push(state) == pytest.approx(before, rel=0.05)


def test_else_it_is_mounted_anew(ring, carried, monkeypatch):
    state, before = carried

    def fails(state):
        raise ConvergenceError("no equilibrium")

    monkeypatch.setattr(stepper, "settle_carried", fails)
    settle = Stepper._settle_cycle

    def fails_at_once(self, state, at_once=False, lowers=False):
        if at_once:
            fails(state)
        assert lowers, "friction that the part does not bear is no reason to give up: there is no other way"
        settle(self, state, lowers=lowers)

    monkeypatch.setattr(Stepper, "_settle_cycle", fails_at_once)
    Stepper(ring).settle_on_new_mesh(state)
    assert push(state) == pytest.approx(before, rel=0.05)


def test_springs_hold_a_state_from_which_a_solve_goes_elsewhere(carried):
    """What the sharp laws do not settle at once, springs bring to an equilibrium nearby."""
    state, _ = carried
    problem = set_last(state)
    vector = problem.state.vec.FV().NumPy()
    place = problem.part("displacement")
    start = vector.copy()
    rng = np.random.default_rng(0)
    vector[place] += 0.002 * problem.body.size * rng.standard_normal(place.stop - place.start)
    reports = let_go(problem)
    assert len(reports) == 3, "sharp laws at once, springs, sharp laws"
    assert reports[-1].converged
    assert np.abs(vector - start)[place].max() < 0.1 * problem.body.size


def test_every_stroke_is_carried(carried):
    state, _ = carried
    vectors = [phase.vector for phase in state.phases]
    settle_carried(state)
    assert all((phase.vector != vector).any() for phase, vector in zip(state.phases, vectors, strict=True))
