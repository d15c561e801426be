import math

import numpy as np
import pytest

from ngwear.errors import SceneError
from ngwear.surfaces import Corner, Cylinder, Plane, bore, rod

SURFACES = [
    rod(22.2),
    bore(29.6),
    Plane(point=(0.3, 0.4), normal_vector=(3.0, -4.0)),
    Corner(point=(5.0, 5.0), normal_vector=(0.6, 0.8), side=(0.8, -0.6), radius=1.2),
    Cylinder(centre=(2.0, 4.0), radius=1.5, push=(1.0, -3.0)),
]
IDS = ["rod", "bore", "plane", "corner", "cylinder"]


@pytest.mark.parametrize("surface", SURFACES, ids=IDS)
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


@pytest.mark.parametrize("surface", SURFACES, ids=IDS)
def test_approach_is_a_unit_vector_that_closes_the_gap(surface):
    ax, ay = surface.approach
    assert math.hypot(ax, ay) == pytest.approx(1.0)
    foot = (2.0 + 5 * ax, 4.0 + 5 * ay)  # ahead of the body, or beside it
    assert surface.gap(foot[0] - 0.1 * ax, foot[1] - 0.1 * ay) < surface.gap(*foot)


def test_gap_signs_and_sizes():
    assert rod(22.2).gap(5.0, 11.5) == pytest.approx(0.4)
    assert bore(29.64).gap(5.0, 14.9) == pytest.approx(-0.08)
    assert Cylinder(centre=(0.0, 0.0), radius=2.0).gap(3.0, 4.0) == pytest.approx(3.0)
    gaps = Cylinder(centre=(0.0, 0.0), radius=2.0).gap(np.array([3.0, 1.0]), np.array([4.0, 0.0]))
    assert gaps == pytest.approx([3.0, -1.0])


def corner(**changes):
    """A wall of normal x that ends at a gap above y = 0.1."""
    return Corner(**{"point": (0.0, 0.1), "normal_vector": (1.0, 0.0), "side": (0.0, -1.0), "radius": 0.1} | changes)


def test_a_corner_is_two_faces_and_an_arc():
    x = np.array([0.3, 0.0, -0.5, -0.5, -0.3, 0.1])
    y = np.array([0.5, 0.5, 0.0, 0.3, 1.0, 0.0])
    arc = np.hypot(0.2, 0.2) - 0.1  # of its middle at (-0.1, 0.2)
    assert corner().gap(x, y) == pytest.approx([0.3, 0.0, 0.1, -0.2, -0.3, arc])
    assert np.stack(corner().normal(x, y), axis=1) == pytest.approx(
        np.array([(1, 0), (1, 0), (0, -1), (0, -1), (1, 0), (0.5**0.5, -(0.5**0.5))])
    )


def test_the_way_along_a_corner_goes_over_its_edge_without_a_jump():
    for side in ((0.0, -1.0), (0.0, 1.0)):  # the approach turned by +90 degrees is (0, 1)
        there = corner(point=(0.0, 0.0), side=side)
        angle, far = np.linspace(0.0, np.pi / 2, 31), np.linspace(0.0, 1.0, 11)[1:]
        x = np.concatenate([np.zeros(10), -0.1 + 0.1 * np.cos(angle), -0.1 - far])
        y = side[1] * np.concatenate([-0.1 - far[::-1], -0.1 + 0.1 * np.sin(angle), np.zeros(10)])
        assert there.gap(x, y) == pytest.approx(0.0, abs=1e-12)
        way = np.append(0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y))))
        along = there.along(x, y)
        assert along - along[0] == pytest.approx(side[1] * way, rel=1e-3)
        assert there.along(-0.3, side[1] * 0.01) - there.along(-0.3, 0.0) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"side": (1.0, 1.0)}, r"surface\.side.*at right angles"),
        ({"side": (0.0, 0.0)}, r"surface\.side.*longer than 0"),
        ({"normal_vector": (0.0, 0.0)}, r"surface\.normal.*longer than 0"),
    ],
)
def test_a_corner_has_two_normals_at_right_angles(changes, words):
    with pytest.raises(SceneError, match=words):
        corner(**changes)


@pytest.mark.parametrize("bad", [0.0, -1.0, math.nan])
@pytest.mark.parametrize(
    "build",
    [rod, bore, lambda v: Cylinder(centre=(0.0, 0.0), radius=v), lambda v: corner(radius=v)],
    ids=["rod", "bore", "cylinder", "corner"],
)
def test_size_must_be_positive(build, bad):
    with pytest.raises(SceneError, match=r"surface\.(diameter|radius) = .*greater than 0 mm"):
        build(bad)


def test_directions_must_have_a_length():
    with pytest.raises(SceneError, match=r"surface\.normal.*longer than 0"):
        Plane(point=(0.0, 0.0), normal_vector=(0.0, 0.0))
    with pytest.raises(SceneError, match=r"surface\.push.*longer than 0"):
        Cylinder(centre=(0.0, 0.0), radius=1.0, push=(0.0, 0.0))
