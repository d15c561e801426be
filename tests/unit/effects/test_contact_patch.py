import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial import Delaunay

from ngwear.effects.contact_patch import Faces
from ngwear.sliding.patch import contact_patch
from ngwear.surfaces import Sphere

RADIUS, HIGHEST = 3.0, 5.0


def faces(count, *, scatter=0.0, pressure=None):
    """A disc cut in irregular triangles under Hertz's pressure, that of each face off by chance."""
    rng = np.random.default_rng(count)
    place = rng.uniform(-RADIUS, RADIUS, (count, 2))
    corners = np.pad(place, ((0, 0), (0, 1)))[Delaunay(place).simplices]
    centres = corners.mean(axis=1)
    r = np.linalg.norm(centres[:, :2], axis=1) / RADIUS
    p = HIGHEST * np.sqrt(np.maximum(1 - r**2, 0.0)) if pressure is None else pressure(centres)
    return Faces(corners, corners, p * (1 + scatter * rng.normal(size=len(p))))


@pytest.mark.parametrize("count", [100, 400, 1600])
def test_the_peak_of_a_smooth_pressure_is_its_own(count):
    assert faces(count).peak == pytest.approx(HIGHEST, rel=1e-3 if count > 100 else 5e-3)


@pytest.mark.parametrize("count", [400, 1600])
def test_scatter_of_single_faces_does_not_raise_the_peak(count):
    scattered = faces(count, scatter=0.01)
    assert scattered.pressure.max() > 1.01 * HIGHEST
    assert scattered.peak == pytest.approx(HIGHEST, rel=3e-3)


def test_few_faces_and_pressures_without_a_top_among_them_keep_the_highest_face():
    few = faces(12)
    assert few.peak == few.pressure.max()
    rising = faces(400, pressure=lambda centres: 2.0 + centres[:, 0])
    assert rising.peak == rising.pressure.max()
    assert Faces(np.zeros((0, 3, 3)), np.zeros((0, 3, 3)), np.zeros(0)).peak == 0.0


def test_areas_are_those_of_the_triangles():
    square = np.array([[[0, 0, 0], [2, 0, 0], [0, 3, 0]], [[0, 0, 1], [0, 1, 1], [0, 0, 2.0]]])
    np.testing.assert_allclose(Faces(square, square, np.ones(2)).areas, [3.0, 0.5])


def under_hertz(edge, *, half_axes=(3.0, 2.5), scatter=0.0, seed=1):
    """A contact on irregular triangles some ``edge`` long, whose faces bear the mean of Hertz's pressure on them."""
    rng = np.random.default_rng(seed)
    ticks = np.arange(-4.0, 4.0, edge)
    place = np.stack(np.meshgrid(ticks, ticks), axis=-1).reshape(-1, 2)
    place = place + rng.uniform(-0.25, 0.25, place.shape) * edge
    corners = np.pad(place, ((0, 0), (0, 1)))[Delaunay(place).simplices]
    share = rng.dirichlet(np.ones(3), 400)
    points = np.einsum("kc,ncd->nkd", share, corners[:, :, :2])
    p = HIGHEST * np.sqrt(np.maximum(1 - ((points / half_axes) ** 2).sum(axis=2), 0.0)).mean(axis=1)
    faces = Faces(corners, corners, p * (1 + scatter * rng.normal(size=len(p))))
    ball = Sphere(radius=1e4, centre=(0.0, 0.0, 1e4))
    return SimpleNamespace(faces=lambda: faces, deformed=lambda places: places, surface=ball)


@pytest.mark.parametrize(("edge", "off"), [(0.6, 0.004), (0.3, 0.002)])
@pytest.mark.parametrize("seed", range(4))
def test_the_area_is_that_inside_the_edge_of_the_pressure(edge, off, seed):
    patch = contact_patch(under_hertz(edge, scatter=0.01, seed=seed))
    assert patch.area == pytest.approx(math.pi * 3.0 * 2.5, rel=off)
    assert patch.reference_area == pytest.approx(patch.area, rel=2e-3)  # of a polygon
    radius = np.linalg.norm(patch.edge / (3.0, 2.5), axis=1)
    np.testing.assert_allclose(radius, 1.0, atol=5 * off)


def test_a_contact_on_a_handful_of_faces_has_an_edge_too():
    patch = contact_patch(under_hertz(2.5))
    assert patch.reference_area == pytest.approx(math.pi * 3.0 * 2.5, rel=0.3)
