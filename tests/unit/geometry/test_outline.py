import math

import numpy as np
import pytest

from ngwear.errors import GeometryError
from ngwear.geometry.outline import Outline, polygon_area, polygon_moment

SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]


def contour(points, names=None, corners=None):
    n = len(points)
    return Outline(np.array(points, dtype=float), names or ("edge",) * n, np.array(corners or [True] * n))


def test_area_length_and_turning_of_a_rectangle(rectangle):
    box = rectangle(4.0, 2.0, 8, 4)
    assert box.area == pytest.approx(8.0, rel=1e-14)
    assert box.lengths.sum() == pytest.approx(12.0, rel=1e-14)
    assert box.turning.sum() == pytest.approx(2 * np.pi, rel=1e-14)
    assert np.flatnonzero(box.turning > 1).tolist() == np.flatnonzero(box.corners).tolist()


def test_area_does_not_lose_digits_far_from_the_origin(rectangle):
    far = rectangle(0.01, 0.02).moved(np.array([1e4, 1e4]))
    assert far.area == pytest.approx(2e-4, rel=1e-8)


def test_clockwise_is_refused_and_the_remedy_named():
    with pytest.raises(GeometryError, match=r"clockwise.*reverse"):
        contour(SQUARE[::-1])


def test_self_intersection_is_refused_with_its_place():
    with pytest.raises(GeometryError, match=r"crosses or touches itself.*1 1"):
        contour([[0, 0], [2, 2], [2, 1.5], [1.0, 1.0], [0, 2.0]])


def test_bow_tie_with_positive_area_is_refused_with_its_place():
    with pytest.raises(GeometryError, match=r"crosses or touches itself.*\[1 1"):
        contour([[0, 0], [3, 0], [3, 3], [1.0, 1.0], [0, 1.0], [2, 1]])


def test_repeated_point_is_refused_with_numbers_and_place():
    with pytest.raises(GeometryError, match=r"points 1 and 2 coincide at \[1\.0, 0\.0\]"):
        contour([[0, 0], [1, 0], [1, 0], [1, 1], [0, 1]])


@pytest.mark.parametrize("name", ["", " lip", "lip|heel", ".*", "é"])
def test_unusable_edge_name_is_refused_with_its_point(name):
    with pytest.raises(GeometryError, match=r"contour point 2 .*name"):
        contour(SQUARE, names=("a", "a", name, "a"))


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_coordinates_must_be_finite(bad):
    with pytest.raises(GeometryError, match=r"point 2 .*finite"):
        contour([[0, 0], [1, 0], [1, bad], [0, 1]])


@pytest.mark.parametrize("points", [[[0, 0], [1, 0]], [[0, 0, 0], [1, 0, 0], [0, 1, 0]]])
def test_too_few_points_or_dimensions(points):
    with pytest.raises(GeometryError, match="at least 3 points"):
        contour(points)


def test_names_and_corners_must_match_the_points():
    with pytest.raises(GeometryError, match="one edge name and one corner flag"):
        contour(SQUARE, names=("a", "b"))


def test_spline_follows_a_circle_to_fourth_order(circle):
    def off(n):
        t = np.linspace(0, n, 7 * n + 1)
        return np.abs(np.linalg.norm(circle(n, 2.0).at(t), axis=1) - 2.0).max()

    errors = [off(n) for n in (16, 32, 64)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[-1] < 1e-5
    assert (orders > 3.8).all(), orders


def test_spline_passes_through_its_points_and_slopes_are_its_derivative(circle):
    ring = circle(24)
    assert np.allclose(ring.at(np.arange(24)), ring.points, atol=1e-14)
    t, h = np.array([0.3, 5.7, 23.5]), 1e-5
    assert np.allclose(ring.slopes(t), (ring.at(t + h) - ring.at(t - h)) / (2 * h), atol=1e-9)


def test_parameter_wraps_around_the_closed_outline(circle):
    ring = circle(24)
    assert np.allclose(ring.at(24 + 0.25), ring.at(0.25), atol=1e-14)


def test_straight_edges_stay_straight(rectangle):
    box = rectangle(4.0, 2.0, 5, 3)
    t = np.linspace(0, 5, 41)
    assert np.abs(box.at(t)[:, 1]).max() < 1e-14


def test_arc_length_of_a_segment_beats_the_chord(circle):
    ring = circle(48)
    arc = ring.arc_lengths(np.array([3.0]), np.array([4.0]))[0]
    assert arc == pytest.approx(2 * np.pi / 48, rel=1e-6)


def test_inserted_point_lies_on_the_spline_and_inherits_the_name(rectangle):
    box = rectangle(4.0, 2.0, 2, 2)
    more = box.inserted(np.array([0.5, 2.25, 3.0]))
    assert len(more) == len(box) + 2, "an existing point is not inserted again"
    assert more.points[1].tolist() == [1.0, 0.0]
    assert more.names[1] == "bottom"
    assert more.names[4] == "right"
    assert not more.corners[1]
    assert more.corners.sum() == 4
    assert more.area == pytest.approx(8.0, rel=1e-14)


def test_without_undoes_inserted(rectangle):
    box = rectangle(4.0, 2.0, 2, 2)
    more = box.inserted(np.array([0.5, 5.5]))
    back = more.without(~np.isin(np.arange(len(more)), [0, 2, 3, 4, 5, 6, 8, 9]))
    assert np.allclose(back.points, box.points)
    assert back.names == box.names


def test_controls_are_linear_in_the_data(circle):
    ring = circle(20)
    d = np.random.default_rng(1).normal(size=(20, 2)) * 1e-3
    assert np.allclose(ring.controls(ring.points + d), ring.bezier + ring.controls(d), atol=1e-13)


def test_area_of_many_points_is_exact_enough_for_one_stroke_of_wear(circle):
    many = circle(4000, radius=100.0)
    x, y = many.points.T.tolist()
    ahead = [*range(1, 4000), 0]
    exact = 0.5 * math.fsum(x[i] * y[j] - y[i] * x[j] for i, j in enumerate(ahead))
    assert abs(many.area - exact) < 2e-15 * exact


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
