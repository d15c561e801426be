"""A pin on a plate: limits that need no reference, and what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest

from ngwear.equilibrium.steady_sliding import SteadyOptions
from ngwear.errors import SceneError
from ngwear.geometry.sheet import Sheet
from ngwear.materials import MooneyRivlin, PronySeries
from ngwear.scene.pin_scene import Pin, PinMesh
from ngwear.sliding.pin import PinStage, slide_pin

RUBBER = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1500.0)
PIN = Pin(material=RUBBER, series=PronySeries((1.0,), (1e-3,)), load=20.0, track_radius=math.inf)
COARSE = PinMesh(patch=1.2, column=0.6, reach=2.5, beside=2.0)
FINE = PinMesh(patch=0.8, column=0.4, reach=3.0, beside=2.5)


def pressed(scale=1.0):
    stiffer = MooneyRivlin(c10=0.6 * scale, c01=0.15 * scale, bulk_modulus=1500.0)
    stage = PinStage(replace(PIN, material=stiffer, series=None), FINE, (0.0, 0.0, 2.0))
    stage.press()
    return stage.depth


def slid(mesh):
    stage = PinStage(PIN, mesh, (0.0, 0.0, 2.0))
    stage.press()
    found = []
    for speed in (1e-2, 2e3, 1e9):
        work = stage.slide(speed, SteadyOptions(tolerance=2e-3))
        found.append(stage.result(speed, work, 0.0))
    return found


@pytest.fixture(scope="module")
def slides():
    return slid(COARSE)


@pytest.mark.slow
def test_slow_and_fast_are_elastic_with_the_relaxed_and_the_instantaneous_stiffness():
    slides = slid(FINE)
    assert slides[0].depth == pytest.approx(pressed(), rel=0.02)  # the surface friction is in it
    assert slides[2].depth == pytest.approx(pressed(2.0), rel=0.02)
    assert slides[0].dissipation < 0.02 * slides[1].dissipation
    assert slides[2].dissipation < 0.02 * slides[1].dissipation


def test_energy_and_force_tell_the_same_friction(slides):
    for s in slides:
        assert s.dissipation + s.slip_work == pytest.approx(s.friction, rel=0.03)


def test_friction_leans_the_contact_ahead(slides):
    assert slides[1].internal_friction > 2 * slides[0].internal_friction
    assert slides[1].patch.edge[:, 0].mean() > 0.02


def test_area_lies_between_that_of_the_reference_and_of_the_cap(slides):
    s = slides[0]
    assert s.patch.reference_area < s.patch.area < 2 * math.pi * PIN.radius * s.depth


def test_mirrored_mesh_is_whole():
    body = Sheet(
        thickness=2.0,
        track_radius=8.0,
        reach=3.0,
        beside=2.0,
        seeds=np.array([[0.0, 0.0, 2.0]]),
        sizes=np.array([0.5]),
        coarse=1.5,
    )
    assert set(body.region_names) == {"bottom", "top", "side"}
    x = np.array(body.mesh.ngmesh.Coordinates())[:, 0]
    np.testing.assert_allclose(np.sort(x), np.sort(-x), atol=1e-12)


def test_track_that_leaves_the_sheet_is_told_how_large_to_be():
    with pytest.raises(SceneError, match=r"track leaves the sheet.*take .* mm or more"):
        replace(PIN, track_radius=16.5, sheet_radius=18.0)


@pytest.mark.parametrize("change", [{"radius": 0.0}, {"load": -1.0}, {"thickness": 0.0}, {"friction": -0.1}])
def test_sizes_must_be_positive(change):
    with pytest.raises(SceneError, match=next(iter(change))):
        replace(PIN, **change)


@pytest.mark.parametrize("speed", [0.0, -1.0, float("inf")])
def test_sliding_needs_a_speed(speed):
    with pytest.raises(SceneError, match="above 0 mm/s"):
        slide_pin(PIN, speed)


def test_sliding_needs_memory():
    with pytest.raises(SceneError, match="memory"):
        slide_pin(replace(PIN, series=None), 1.0)


def test_block_that_reaches_over_the_centre_is_refused():
    with pytest.raises(SceneError, match=r"sheet\.beside"):
        PinStage(replace(PIN, track_radius=16.5), replace(COARSE, beside=5.0), (0.0, 0.0, 2.0))
