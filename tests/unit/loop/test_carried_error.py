"""What contacts wear less where a depth is too large, against equilibria that are solved."""

from dataclasses import replace

import numpy as np
import pytest

from ngwear.loop.carried_error import with_more_worn
from ngwear.loop.stepper import Stepper
from ngwear.loop.stroke_solve import solve_stroke
from ngwear.loop.wear_step import WearStep
from ngwear.scene.accuracy import Accuracy
from ngwear.wear.archard import worn_share


@pytest.fixture(scope="module")
def worn_seal(seal):
    """The shipped seal in the middle of a step of one cycle, after two strokes."""
    stepper = Stepper(replace(seal, accuracy=Accuracy(patch=0.015, mounting=0.04), save=replace(seal.save, strokes=())))
    state = stepper.start()
    while state.strokes < 2:
        state = stepper.advance(state)
    sliding = stepper._strokes(0, state.strokes, 1)
    wear_step = WearStep.begin(state, 0, sliding)
    solve(state, sliding)
    solve(state, sliding)  # from the equilibrium itself, as the solve that it is compared with
    return state, sliding, wear_step


def solve(state, sliding):
    state.phases[0] = replace(state.phases[0], rate=None)
    solve_stroke(state, 0, state.stage.scene.program.cycle[0], sliding)


def bump(state):
    """A depth that is too large over a part of the contact, of a tenth of what is worn there [mm]."""
    profile = state.stage.contacts["rod"].profile()
    middle = state.contour.points[int(np.rint(profile.t[profile.pressure.argmax()])) % len(state.contour)]
    away = np.linalg.norm(state.contour.points - middle, axis=1)
    return 0.1 * state.ledger.depth * np.exp(-((away / 0.03) ** 2))


def test_pressures_with_more_worn_are_those_of_another_solve(worn_seal):
    state, sliding, wear_step = worn_seal
    contact, problem = state.stage.contacts["rod"], state.stage.problem
    more, vector = bump(state), problem.state.vec.FV().NumPy().copy()
    load = contact.profile().load
    with with_more_worn(state.stage, wear_step.known_depth, more) as found:
        assert found
        told = contact.profile().load - load
    assert (problem.state.vec.FV().NumPy() == vector).all(), "it changes nothing"
    assert contact.profile().load == pytest.approx(load, rel=1e-12)
    contact.set_worn(wear_step.known_depth["rod"] + more)
    solve(state, sliding)
    true = contact.profile().load - load
    contact.set_worn(wear_step.known_depth["rod"])
    problem.state.vec.FV().NumPy()[:] = vector
    assert np.abs(told - true).sum() < 0.05 * np.abs(true).sum()


def test_where_too_much_is_worn_less_is_worn(worn_seal):
    state, _, wear_step = worn_seal
    more = bump(state)
    spec = state.stage.scene.contacts[0]
    profile, rate = wear_step._rate(spec, {})
    end = np.array([worn_share(state.contour, profile, rate * profile.weight)])
    most = int(more.argmax())
    assert 0 < wear_step._carried(more, end, {})[most] < 0.999 * more[most]
    assert wear_step._carried(-more, end, {})[most] > -0.999 * more[most]
    assert (wear_step._carried(0 * more, end, {}) == 0).all()


def test_a_tangent_that_is_singular_tells_nothing(worn_seal, monkeypatch):
    state, _, wear_step = worn_seal
    vector = state.stage.problem.state.vec.FV().NumPy().copy()
    monkeypatch.setattr(state.stage.problem.solver, "solve", lambda right_side, solution: 1e-3)
    with with_more_worn(state.stage, wear_step.known_depth, bump(state)) as found:
        assert not found
        assert (state.stage.problem.state.vec.FV().NumPy() == vector).all()
