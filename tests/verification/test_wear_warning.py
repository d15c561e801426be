"""A warning where the explicit wear step is unstable, and only there."""

import pytest

from ngwear.loop.stepper import Stepper
from ngwear.verify.stability_pair import scene


def test_explicit_wear_beyond_the_critical_step_warns():
    with pytest.warns(RuntimeWarning, match="unstable"):
        Stepper(scene("explicit", 4.0))


@pytest.mark.parametrize(("scheme", "times"), [("explicit", 0.9), ("implicit", 10.0)])
def test_stable_wear_does_not_warn(scheme, times, recwarn):
    Stepper(scene(scheme, times))
    assert not [w for w in recwarn if issubclass(w.category, RuntimeWarning)]
