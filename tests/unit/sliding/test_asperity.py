"""Sliding of one asperity: what is refused, and limits that need no reference."""

import numpy as np
import pytest

from ngwear.errors import ConvergenceError, SceneError
from ngwear.materials import NeoHooke, PronySeries
from ngwear.materials.library import filled_rubber
from ngwear.sliding.asperity import Asperity, slide
from ngwear.sliding.figures import draw_friction, draw_pressures
from ngwear.sliding.passing import slide_in_time

RUBBER = NeoHooke(shear=2.0, bulk_modulus=2e4)
ARMS = PronySeries((1.0,), (1e-3,))


def cylinder(**changes):
    return Asperity(**{"material": RUBBER, "series": ARMS, "radius": 5.0, "load": 0.01, **changes})


@pytest.fixture(scope="module")
def slides():
    return [slide(cylinder(), speed, fineness=8) for speed in (1e-3, 60.0, 1e6)]


def test_friction_vanishes_where_nothing_or_everything_is_relaxed(slides):
    slow, middle, fast = (s.friction for s in slides)
    assert middle > 20 * abs(slow)
    assert middle > 20 * abs(fast)


def test_limits_are_hertz_with_the_relaxed_and_the_instantaneous_modulus(slides):
    for s, stiffening in ((slides[0], 1.0), (slides[2], 2.0)):
        half = np.sqrt(4 * 0.01 * 5.0 / (np.pi * 4 * 2.0 * stiffening))
        assert s.half_length == pytest.approx(half, rel=5e-3)
        assert s.centre == pytest.approx(0.0, abs=0.01 * half)
        assert s.peak == pytest.approx(2 * 0.01 / (np.pi * half), rel=0.01)


@pytest.mark.slow
def test_an_asperity_far_smaller_than_its_block_is_solved_where_rubber_hardly_relaxes():
    """The first correction is a hundredth of the block's edge and many elements in contact: no tangent may be kept."""
    rubber = filled_rubber()
    fast = slide(Asperity(material=rubber.elastic, series=rubber.prony, radius=0.25, load=0.05), 3e5, fineness=6)
    assert fast.work.retries == 0
    assert fast.dissipation == pytest.approx(fast.friction, rel=0.015)


def test_contact_leans_ahead_of_the_axis(slides):
    assert slides[1].centre > 0.05 * slides[1].half_length
    assert slides[1].frequency == pytest.approx(60.0 / (4 * slides[1].half_length))


def test_pictures(slides):
    assert len(draw_friction(slides, ARMS).axes) == 2
    assert len(draw_pressures(slides).axes[0].lines) == 3


@pytest.mark.parametrize("speed", [0.0, -1.0, float("inf")])
def test_steady_sliding_needs_a_speed(speed):
    with pytest.raises(SceneError, match="above 0 mm/s"):
        slide(cylinder(), speed)


def test_block_too_small_for_its_wake_is_told_how_deep_to_be():
    asperity = cylinder(depth=0.1)
    with pytest.raises(SceneError, match=f"take {asperity.least_depth(60.0):.4g} mm or more"):
        slide(asperity, 60.0)


@pytest.mark.parametrize("change", [{"radius": 0.0}, {"load": -1.0}, {"depth": float("nan")}])
def test_bad_values(change):
    with pytest.raises(SceneError, match=next(iter(change))):
        cylinder(**change)


@pytest.mark.slow
def test_sliding_in_time_ends_in_the_steady_state():
    passage = slide_in_time(cylinder(), 60.0, fineness=6)
    assert passage.travel[0] == 0.0
    assert passage.steady == pytest.approx(slide(cylinder(), 60.0, fineness=6).friction, rel=0.02)


def test_track_too_short_for_a_steady_state_is_told():
    with pytest.raises(ConvergenceError, match=r"slide more than 0\.3 wakes"):
        slide_in_time(cylinder(), 60.0, fineness=6, wakes=0.3)
    with pytest.raises(SceneError, match="wakes = 0"):
        slide_in_time(cylinder(), 60.0, wakes=0.0)
