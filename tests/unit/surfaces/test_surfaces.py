import math

import numpy as np
import pytest

from ngwear.errors import SceneError
from ngwear.surfaces import Cylinder, Plane, bore, rod

SURFACES = [
    rod(22.2),
    bore(29.6),
    Plane(point=(0.3, 0.4), normal_vector=(3.0, -4.0)),
    Cylinder(centre=(2.0, 4.0), radius=1.5, push=(1.0, -3.0)),
]


@pytest.mark.parametrize("surface", SURFACES, ids=["rod", "bore", "plane", "cylinder"])
def test_normal_is_the_unit_gradient_of_the_gap(surface):
    h = 1e-5
    for x, y in np.random.default_rng(3).uniform(0, 10, size=(8, 2)):
        slope = (
            (surface.gap(x + h, y) - surface.gap(x - h, y)) / (2 * h),
            (surface.gap(x, y + h) - surface.gap(x, y - h)) / (2 * h),
        )
        assert surface.normal(x, y) == pytest.approx(slope, abs=1e-8)
        assert math.hypot(*surface.normal(x, y)) == pytest.approx(1.0)
        tx, ty = surface.tangent(x, y)
        nx, ny = surface.normal(x, y)
        assert (tx * ny - ty * nx, tx * nx + ty * ny) == pytest.approx((1.0, 0.0)), "the normal turned clockwise"


@pytest.mark.parametrize("surface", SURFACES, ids=["rod", "bore", "plane", "cylinder"])
def test_approach_is_a_unit_vector_that_closes_the_gap(surface):
    ax, ay = surface.approach
    assert math.hypot(ax, ay) == pytest.approx(1.0)
    foot = (2.0 + 5 * ax, 4.0 + 5 * ay)  # ahead of the body
    assert surface.gap(foot[0] - 0.1 * ax, foot[1] - 0.1 * ay) < surface.gap(*foot)


def test_gap_signs_and_sizes():
    assert rod(22.2).gap(5.0, 11.5) == pytest.approx(0.4)
    assert bore(29.64).gap(5.0, 14.9) == pytest.approx(-0.08)
    assert Cylinder(centre=(0.0, 0.0), radius=2.0).gap(3.0, 4.0) == pytest.approx(3.0)
    gaps = Cylinder(centre=(0.0, 0.0), radius=2.0).gap(np.array([3.0, 1.0]), np.array([4.0, 0.0]))
    assert gaps == pytest.approx([3.0, -1.0])


@pytest.mark.parametrize("bad", [0.0, -1.0, math.nan])
@pytest.mark.parametrize(
    "build",
    [rod, bore, lambda v: Cylinder(centre=(0.0, 0.0), radius=v)],
    ids=["rod", "bore", "cylinder"],
)
def test_size_must_be_positive(build, bad):
    with pytest.raises(SceneError, match=r"surface\.(diameter|radius) = .*greater than 0 mm"):
        build(bad)


def test_directions_must_have_a_length():
    with pytest.raises(SceneError, match=r"surface\.normal.*longer than 0"):
        Plane(point=(0.0, 0.0), normal_vector=(0.0, 0.0))
    with pytest.raises(SceneError, match=r"surface\.push.*longer than 0"):
        Cylinder(centre=(0.0, 0.0), radius=1.0, push=(0.0, 0.0))
