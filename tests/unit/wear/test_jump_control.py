import math

import pytest

from ngwear.loop.state import Ledger
from ngwear.wear.jump_control import GROWTH, SAFETY, JumpControl


def test_unknown_error_keeps_the_jump():
    control = JumpControl(0.01, cycles=4)
    control.update(math.nan, 4)
    assert control.cycles == 4


@pytest.mark.parametrize("ratio", [0.0, 1e-9])
def test_growth_is_bounded(ratio):
    control = JumpControl(0.01)
    control.update(ratio, 5)
    assert control.cycles == 5 * GROWTH


def test_error_at_the_tolerance_shrinks_by_the_safety_factor():
    control = JumpControl(0.01)
    control.update(0.01, 100)
    assert control.cycles == 100 * SAFETY


def test_large_error_shrinks_but_not_below_one():
    control = JumpControl(0.01)
    control.update(1.0, 100)
    assert control.cycles == 30
    control.update(1.0, 1)
    assert control.cycles == 1


def test_the_depths_error_shortens_a_step_that_areas_would_let_grow():
    control = JumpControl(0.01, cycles=16, depth=0.002)
    control.update(0.0001, 16, 0.008)
    assert control.cycles == int(SAFETY * 16 / 2)
    control.update(0.0001, 7, 0.002 * SAFETY**2)
    assert control.cycles == 7
    control.update(0.04, 7, 0.0)
    assert control.cycles == int(SAFETY * 7 / 2), "areas count all the same"


def test_a_steps_error_of_depth_is_told_by_its_share_of_the_program():
    """Half done, 10 deep, and 2 deep a tenth: 20 at the end; 0.1 off within a tenth is 0.05 in all."""
    before, after = Ledger(depth=8.0, step_error=-0.05), Ledger(depth=10.0, step_error=0.05)
    assert after.depth_ratio(before, 0.1, left=0.5) == pytest.approx(0.1 / 20 / 0.1)
    assert Ledger().depth_ratio(Ledger(), 0.1, left=0.9) == 0.0


def test_without_a_limit_the_depths_error_says_nothing():
    control = JumpControl(0.01, cycles=16)
    control.update(0.0, 16, 0.9)
    assert control.cycles == 32


def test_longest_caps_the_growth():
    control = JumpControl(0.01, longest=7)
    control.update(0.0, 5)
    assert control.cycles == 7


@pytest.mark.parametrize(
    ("ratio", "cycles", "accepted"),
    [(0.02, 5, True), (0.0201, 5, False), (9.9, 1, True), (math.nan, 5, True), (math.inf, 5, False)],
)
def test_acceptance(ratio, cycles, accepted):
    assert JumpControl(0.01).accepts(ratio, cycles) is accepted


def test_cut_halves_down_to_one():
    control = JumpControl(0.01)
    control.cut(9)
    assert control.cycles == 4
    control.cut(1)
    assert control.cycles == 1


def test_cut_to_one_is_one_at_once():
    assert JumpControl(0.01).cut(9, to_one=True) == 1


@pytest.mark.parametrize(
    ("cycles", "left", "step"),
    [(10, 100, 10), (10, 10, 10), (10, 12, 12), (10, 13, 7), (10, 24, 12), (10, 25, 10), (10, 3, 3), (1, 1, 1)],
)
def test_the_last_steps_are_of_one_length(cycles, left, step):
    """One a fifth longer spares a step; of two, none is a remnant."""
    assert JumpControl(0.01, cycles=cycles).share(left) == step
