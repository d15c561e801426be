import numpy as np
import pytest
from scipy.spatial import Delaunay

from ngwear.effects.contact_patch import Faces

RADIUS, HIGHEST = 3.0, 5.0


def faces(count, *, scatter=0.0, pressure=None):
    """A disc cut in irregular triangles under Hertz's pressure, that of each face off by chance."""
    rng = np.random.default_rng(count)
    place = rng.uniform(-RADIUS, RADIUS, (count, 2))
    corners = np.pad(place, ((0, 0), (0, 1)))[Delaunay(place).simplices]
    centres = corners.mean(axis=1)
    r = np.linalg.norm(centres[:, :2], axis=1) / RADIUS
    p = HIGHEST * np.sqrt(np.maximum(1 - r**2, 0.0)) if pressure is None else pressure(centres)
    return Faces(corners, centres, p * (1 + scatter * rng.normal(size=len(p))))


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
    assert Faces(np.zeros((0, 3, 3)), np.zeros((0, 3)), np.zeros(0)).peak == 0.0


def test_areas_are_those_of_the_triangles():
    square = np.array([[[0, 0, 0], [2, 0, 0], [0, 3, 0]], [[0, 0, 1], [0, 1, 1], [0, 0, 2.0]]])
    np.testing.assert_allclose(Faces(square, square.mean(axis=1), np.ones(2)).areas, [3.0, 0.5])
