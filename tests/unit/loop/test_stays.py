"""A stroke that begins at its own end in the last cycle."""

import numpy as np
import pytest

from ngwear.equilibrium.newton import Outcome
from ngwear.loop import stroke_solve
from ngwear.loop.stepper import Stepper


@pytest.fixture
def mounted(ring):
    stepper = Stepper(ring)
    return stepper, stepper.start()


def fail_first(monkeypatch):
    """The solve from the end of the stroke before finds nothing; the next one is as it is."""
    solves, calls = stroke_solve._solves, []

    def fails(state, guess, work):
        calls.append(guess)
        report = solves(state, guess, work)
        if len(calls) == 1:
            report.outcome = Outcome.STALLED
        return report

    monkeypatch.setattr(stroke_solve, "_solves", fails)


def test_without_wear_it_is_the_equilibrium_of_the_last_cycle(mounted, monkeypatch):
    stepper, state = mounted
    ended = state.phases[1].vector.copy()
    slid = {name: share.copy() for name, share in state.phases[1].shares.items()}
    fail_first(monkeypatch)
    report = stepper._solve_without_wear(state, 1, stepper._next_cycle(state))
    assert state.phases[1].stays
    size = state.stage.body.size
    place = state.stage.problem.part("displacement")
    assert np.abs(state.phases[1].vector - ended)[place].max() < 5e-4 * size  # the front of the fluid has an error
    assert abs(sum(report.forces.values())[0]) < 1e-6 * max(np.abs(force).max() for force in report.forces.values())
    for name, share in state.phases[1].shares.items():  # the slip is that of the whole stroke
        np.testing.assert_allclose(share, slid[name], atol=1e-3 * max(share.max(), 1e-6))


def test_it_wears_as_from_the_stroke_before(mounted, monkeypatch):
    stepper, state = mounted
    saved = state.saved()
    stepper._step(state, 20)
    worn, force = state.ledger.worn, state.reports[-1].forces["air wall"][0]
    state.restore(saved)
    solve = stroke_solve._solves

    def only_from_its_own_end(state, guess, work):
        report = solve(state, guess, work)
        own = any(np.array_equal(guess, phase.vector) for phase in state.phases)
        if not own:
            report.outcome = Outcome.STALLED
        return report

    monkeypatch.setattr(stroke_solve, "_solves", only_from_its_own_end)
    monkeypatch.setattr(stroke_solve, "_by_steps", None)
    stepper._step(state, 20)
    assert state.ledger.worn == pytest.approx(worn, rel=0.01)
    assert state.reports[-1].forces["air wall"][0] == pytest.approx(force, rel=0.01)
