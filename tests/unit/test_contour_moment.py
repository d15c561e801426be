import numpy as np
import pytest

from ngwear.geometry.outline import Outline, polygon_area, polygon_moment


def test_moment_of_a_rectangle_and_of_a_notched_one_by_hand():
    assert polygon_moment(Outline.rectangle((1.0, 4.0), (10.0, 12.0)).points) == pytest.approx(3 * 2 * 11.0)
    notched = np.array([(0, 5), (4, 5), (4, 8), (3, 8), (3, 6), (1, 6), (1, 8), (0, 8)], dtype=float)
    assert polygon_area(notched) == pytest.approx(4 * 3 - 2 * 2)
    assert polygon_moment(notched) == pytest.approx(12 * 6.5 - 4 * 7.0)


def test_moment_moves_with_the_polygon_and_turns_its_sign_with_the_direction():
    points = np.random.default_rng(4).normal(size=(9, 2))
    area = polygon_area(points)
    assert polygon_moment(points + np.array([3.0, 2.0])) == pytest.approx(polygon_moment(points) + 2.0 * area)
    assert polygon_moment(points[::-1]) == pytest.approx(-polygon_moment(points))
