"""Many strokes at once against the same strokes one by one."""

import numpy as np
import pytest

from ngwear.wear.cycle_jumps import ArmMap, before_last, whole

TIMES = np.array([1e-4, 0.03, 1.0, 40.0, 1e9])
DURATIONS = (0.9, 0.2, 3.0)
RNG = np.random.default_rng(5)
STRESS = RNG.normal(size=(3, 4))
START = RNG.normal(size=(len(TIMES), 4))


def applied(done: ArmMap, q):
    return done.decay[:, None] * q + done.feed.T @ STRESS


def one_by_one(order, count, q):
    """Relaxed stress after ``count`` strokes in turn, by dq/dt = (S - q) / tau."""
    for k in range(count):
        kind = order[k % len(order)]
        e = np.exp(-DURATIONS[kind] / TIMES)[:, None]
        q = e * q + (1 - e) * STRESS[kind]
    return q


def plan_of(order, count):
    kinds = len(order)
    return [(order[k], (count - k + kinds - 1) // kinds) for k in range(min(kinds, count))]


@pytest.mark.parametrize("order", [(0,), (0, 1), (1, 0), (2, 0, 1)])
@pytest.mark.parametrize("count", [1, 2, 3, 7, 40, 301])
def test_all_strokes_of_a_plan_at_once(order, count):
    found = applied(whole(plan_of(order, count), DURATIONS, TIMES), START)
    assert found == pytest.approx(one_by_one(order, count, START), abs=1e-12)


@pytest.mark.parametrize("order", [(0, 1), (2, 0, 1)])
@pytest.mark.parametrize("count", [3, 7, 40])
def test_start_of_the_last_stroke_of_each_kind(order, count):
    kinds = len(order)
    for position, kind in enumerate(order):
        last = max(k for k in range(count) if k % kinds == position)
        found = applied(before_last(plan_of(order, count), kind, DURATIONS, TIMES), START)
        assert found == pytest.approx(one_by_one(order, last, START), abs=1e-12)


def test_a_single_cycle_starts_without_its_own_stress():
    """The stroke that is solved then takes no part of itself: its share is the arms' mean alone."""
    before = before_last([(0, 1), (1, 1)], 1, DURATIONS, TIMES)
    assert before.feed[1] == pytest.approx(0.0, abs=0)
    assert before.feed[0] == pytest.approx(-np.expm1(-DURATIONS[0] / TIMES), rel=1e-14)


def test_weights_and_what_is_left_add_up_to_one():
    """Under a stress that never changes, what has relaxed tends to it and does not overshoot."""
    done = whole([(0, 1000), (1, 999)], DURATIONS, TIMES)
    assert done.decay + done.feed.sum(axis=0) == pytest.approx(np.ones(len(TIMES)), abs=1e-12)
    assert (done.feed >= 0).all()
