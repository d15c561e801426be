"""Presets and fixed settings find the same wear; the scripts beside this file measure how nearly."""

import adaptive_against_fixed
import presets
import pytest
from subjects import measure

DEPTH = "maximum depth [mm]"


@pytest.mark.slow
def test_a_draft_and_fixed_settings_find_the_same_depth():
    draft = measure(presets.__file__, 6.0, "shaft_on_plate/scene")
    assert draft["cpu"] > 0
    assert draft["peak memory [MB]"] > 0
    for kind in ("contact", "edges"):
        fixed = measure(adaptive_against_fixed.__file__, kind, 0.2, 25, "shaft_on_plate")
        assert fixed["depths"][-1] == pytest.approx(draft[DEPTH], rel=0.02), kind
        assert fixed["solves"] > 8, kind
    assert measure(presets.__file__, 6.0, "nowhere/scene") is None
