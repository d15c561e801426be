"""The error by friction that does not act, from what less of it changes."""

from dataclasses import replace

import numpy as np
import pytest

from ngwear.error_estimates.stated_errors import LARGE, state_errors, with_parts
from ngwear.errors import ConvergenceError
from ngwear.loop import friction_left_out
from ngwear.loop.cycle_quantities import read_cycle
from ngwear.loop.friction_left_out import friction_errors
from ngwear.loop.run import run
from ngwear.loop.stepper import Stepper
from ngwear.loop.time_step_error import next_cycle
from ngwear.results.quantities_of_interest import BY_FRICTION, BY_HALVED, DEPTH, FRICTION, PEAK
from ngwear.results.richardson import relative_errors

SHARE = 0.6
BY_DEPTH, BY_PEAK, BY_FORCE = (f"{name[:-4]} {BY_FRICTION}" for name in (DEPTH, PEAK, FRICTION))


def with_share(state, share):
    """The next cycle of a copy of the state, with this share of the friction in the inward stroke."""
    there = replace(state, stage=state.stage, phases=list(state.phases))
    there.stage.friction_shares = {"inward": (share, "creases the surface")} if share < 1 else {}
    return next_cycle(there)


@pytest.fixture(scope="module")
def sliding(ring):
    """State of a ring that bears its friction, but is solved with a share of it."""
    rubs = replace(ring, contacts=tuple(replace(c, friction=0.15 if c.slides else 0.4) for c in ring.contacts))
    return with_share(Stepper(rubs).start(), SHARE)


def test_the_deepest_place_may_be_another_one_with_all_of_the_friction(sliding, monkeypatch):
    """At the second node the inward stroke wears 7, or 12 with ten times the change from 6.5: 14 instead of 10."""
    wear = {1: np.array([[10.0, 2.0], [0.0, 7.0]]), 2: np.array([[10.0, 2.0], [0.0, 6.5]])}
    states = {k: replace(sliding, strokes=k) for k in wear}
    monkeypatch.setattr(friction_left_out, "wear_per_stroke", lambda state, name: wear[state.strokes])
    assert friction_left_out._deeper(states[1], states[2], 10.0) == pytest.approx(0.4)
    wear[2] = 1.01 * wear[1]
    assert friction_left_out._deeper(states[1], states[2], 10.0) == 0.0


def test_each_stroke_of_a_part_that_rolls_may_wear_another_place(sliding, monkeypatch):
    """Both strokes wear the second node, 6 and 5; apart, the depth is that of the first stroke: 6 instead of 11."""
    wear = np.array([[1.0, 6.0], [2.0, 5.0]])
    monkeypatch.setattr(friction_left_out, "wear_per_stroke", lambda state, name: wear)
    apart = 1.0 - 6.0 / 11.0
    assert friction_left_out._apart(sliding) == pytest.approx(apart)
    assert friction_errors(sliding)[BY_DEPTH] < apart
    monkeypatch.setattr(sliding.stage, "friction_shares", {"inward": (SHARE, "rolls the part over")})
    assert friction_errors(sliding)[BY_DEPTH] >= apart


def test_they_are_what_the_rest_of_the_friction_changes(sliding):
    errors = friction_errors(sliding)
    less = read_cycle(sliding)
    changes = relative_errors(less, read_cycle(with_share(sliding, 1.0)))
    sliding.stage.friction_shares = {"inward": (SHARE, "creases the surface")}
    assert changes[PEAK] > 0.01
    assert errors[BY_FORCE] == pytest.approx(changes[FRICTION], rel=0.1)
    for name, by in ((DEPTH, BY_DEPTH), (PEAK, BY_PEAK)):  # extrapolated to seven times the change
        assert 0.5 < errors[by] / changes[name] < 2


def test_the_state_stays_as_it_is(sliding):
    before, shares = sliding.phases[-1].vector.copy(), dict(sliding.stage.friction_shares)
    friction_errors(sliding)
    assert sliding.stage.friction_shares == shares
    assert (sliding.phases[-1].vector == before).all()
    assert (sliding.stage.problem.state.vec.FV().NumPy() == before).all()


def test_there_are_none_if_all_of_the_friction_acts(sliding, monkeypatch):
    monkeypatch.setattr(friction_left_out, "next_cycle", None)
    monkeypatch.setattr(sliding.stage, "friction_shares", {})
    assert friction_errors(sliding) == {}


def test_a_run_states_them_or_says_that_they_are_not_known(ring, monkeypatch):
    from ngwear.loop import run as module

    def states(recorder, summary):
        state_errors(summary, summary["error estimates"] | with_parts(summary["error estimates"]))

    monkeypatch.setattr(module, "add_mesh_errors", lambda state: [])
    monkeypatch.setattr(module, "friction_errors", lambda state: {BY_DEPTH: 0.4})
    told = run(ring, errors=states).summary
    assert told["error estimates"][DEPTH] >= told["error estimates"][BY_DEPTH] == 0.4
    assert any("most of it is by the friction that the part does not bear" in warning for warning in told["warnings"])

    def fails(state):
        raise ConvergenceError("no equilibrium")

    monkeypatch.setattr(module, "friction_errors", fails)
    told = run(ring, errors=states).summary
    assert any("the error by the friction left out is not known" in warning for warning in told["warnings"])


def test_totals_have_the_part_in_them():
    by_halved = f"{DEPTH[:-4]} {BY_HALVED}"
    assert with_parts({DEPTH: 0.01, by_halved: 0.02, BY_DEPTH: 0.3, BY_PEAK: 0.1}) == {
        DEPTH: pytest.approx(0.32),
        PEAK: pytest.approx(0.1),
    }


def test_a_large_error_by_the_mesh_is_told_as_such():
    summary = {"warnings": []}
    state_errors(summary, {DEPTH: 1.1 * LARGE, BY_DEPTH: 0.1 * LARGE})
    assert "its mesh or steps are too coarse" in summary["warnings"][0]
