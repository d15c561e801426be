"""Wear against closed forms, a half-plane solver, and a scheme that is known to be unstable."""

import pytest

from ngwear.stepper import Stepper
from ngwear.verify import verify
from ngwear.verify.stability_pair import scene

WEAR = ("stability_pair", "worn_cylinder", "block_on_ring")


@pytest.mark.parametrize("case", WEAR)
def test_case_meets_its_reference(case):
    checks = verify([case])
    missed = [
        f"{c.quantity}: {c.value:.8g}, {c.bound} {c.reference:.8g} wanted, error {c.error:.2e} above {c.tolerance:.1e}"
        for c in checks
        if not c.passed
    ]
    assert checks, f"{case} checks nothing"
    assert not missed, f"{case}: " + "; ".join(missed)


def test_explicit_wear_beyond_the_critical_step_warns():
    with pytest.warns(RuntimeWarning, match="unstable"):
        Stepper(scene("explicit", 4.0))


@pytest.mark.parametrize(("scheme", "times"), [("explicit", 0.9), ("implicit", 10.0)])
def test_stable_wear_does_not_warn(scheme, times, recwarn):
    Stepper(scene(scheme, times))
    assert not [w for w in recwarn if issubclass(w.category, RuntimeWarning)]
