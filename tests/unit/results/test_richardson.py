"""Errors from two or three levels of coarseness, against readings whose limit is known."""

import numpy as np
import pytest

from ngwear.results.richardson import HIGHEST, LOWEST, error_of_finest, observed_order, relative_errors

PLACES = np.linspace(1.0, 2.0, 5)
LENGTH = np.sqrt(np.mean(PLACES**2))


def readings(order, *, ratio=2.0, error=0.01):
    """Five places whose errors are 1 % of them on the finest, unless said otherwise."""
    return [PLACES * (1 + error * (edge**order)) for edge in ratio ** np.arange(3.0)]


@pytest.mark.parametrize("ratio", [1.6, 2.0])
@pytest.mark.parametrize("order", [1.0, 1.2, 1.5])
def test_an_order_is_seen_and_the_error_exact(order, ratio):
    levels = readings(order, ratio=ratio)
    assert observed_order(*levels, ratio=ratio) == pytest.approx(order)
    assert error_of_finest(*levels, ratio=ratio) == pytest.approx(0.01 * LENGTH)


@pytest.mark.parametrize(("order", "taken"), [(0.1, LOWEST), (5.0, HIGHEST)])
def test_orders_out_of_reason_are_not_believed(order, taken):
    levels = readings(order, error=1e-4)  # so that the coarsest is not far off
    assert observed_order(*levels) == taken
    assert error_of_finest(*levels) == pytest.approx(1e-4 * (2**order - 1) / (2**taken - 1) * LENGTH)


@pytest.mark.parametrize("coarsest", [1.6, 0.4])
def test_a_coarsest_level_far_off_is_left_out(coarsest):
    first, second, _ = readings(1.0)
    assert error_of_finest(first, second, coarsest * PLACES) == error_of_finest(first, second)
    assert error_of_finest(first, second, (1.0 + 0.5 * (coarsest - 1.0)) * PLACES) != error_of_finest(first, second)


def test_two_levels_are_of_first_order():
    first, second, _ = readings(1.0)
    assert error_of_finest(first, second) == pytest.approx(0.01 * LENGTH)
    coarse = PLACES * 1.016
    assert error_of_finest(PLACES * 1.01, coarse, ratio=1.6) == pytest.approx(0.01 * LENGTH)


def test_two_levels_of_a_known_order():
    first, second, _ = readings(2.0)
    assert error_of_finest(first, second, order=2.0) == pytest.approx(0.01 * LENGTH)
    found = relative_errors(
        {"a": {"a": first}, "b": {"b": first}}, {"a": {"a": second}, "b": {"b": second}}, orders={"a": 2.0}
    )
    assert found == pytest.approx({"a": 0.01 / 1.01, "b": 0.03 / 1.01})


@pytest.mark.parametrize("levels", [(1.0, 1.1, 1.05), (1.0, 1.1, 1.15), (1.0, 1.0, 1.0), (1.0, 1.1, 1.1)])
def test_differences_that_turn_round_or_grow_show_no_order(levels):
    assert observed_order(*levels) is None


def test_one_place_against_the_rest_does_not_hide_the_order():
    levels = np.array(readings(1.0))
    levels[2, 0] = levels[1, 0] - 0.001
    assert observed_order(*levels) == pytest.approx(1.0, abs=0.15)


def test_readings_that_agree_have_no_error():
    assert error_of_finest(3.0, 3.0, 3.0) == 0.0
    assert error_of_finest([1.0, 2.0], [1.0, 2.0]) == 0.0


@pytest.mark.parametrize("ratio", [1.6, 2.0])
def test_scatter_about_the_limit_is_estimated_without_bias(ratio):
    chance = np.random.default_rng(3).standard_normal((3, 20_000))
    levels = 7.0 + 0.01 * ratio ** np.arange(3.0)[:, None] * chance
    assert observed_order(*levels, ratio=ratio) is None
    assert error_of_finest(*levels, ratio=ratio) == pytest.approx(0.01, rel=0.02)
    assert error_of_finest(*levels[:2], ratio=2.0) == pytest.approx(0.01 * np.hypot(1, ratio), rel=0.02)


def test_differences_that_grow_show_a_trend_of_first_order_beside_scatter():
    """Seen at once in all places; that turns round is scatter alone."""
    best = (2.0 / 4 + 2.1 / 16) / 1.3125 + 1.0 / 1.3125
    scatter = ((1 - best) ** 2 + (2 - best) ** 2 / 4 + (2.1 - best) ** 2 / 16) / 2
    assert error_of_finest(1.0, 2.0, 2.1) == pytest.approx(np.sqrt(1 - 5 * scatter + scatter))
    best = (2.0 / 4 + 1.9 / 16) / 1.3125 + 1.0 / 1.3125
    scatter = ((1 - best) ** 2 + (2 - best) ** 2 / 4 + (1.9 - best) ** 2 / 16) / 2
    assert error_of_finest(1.0, 2.0, 1.9) == pytest.approx(np.sqrt(scatter))
