import math

import numpy as np
import pytest
from shapely import LinearRing
from shapely import points as shapely_points

from ngwear.errors import GeometryError
from ngwear.geometry.outline import Outline
from ngwear.geometry.recession import SHAPE, recede, refuse_worn_through, tidied, without_tongues
from ngwear.geometry.sizing import SizeField


def exact_area(points):
    """Polygon area without rounding in the sum."""
    x, y = (points - points[0]).T
    x2, y2 = np.roll(x, -1), np.roll(y, -1)
    return 0.5 * math.fsum(np.concatenate([x * y2, -x2 * y]))


def test_uniform_wear_of_a_circle_is_a_smaller_circle(circle):
    ring = circle(200)
    worn = recede(ring, np.full(200, 1e-4), ("rim",))
    radii = np.linalg.norm(worn.points, axis=1)
    assert np.ptp(radii) < 1e-14
    assert radii[0] == pytest.approx(math.sqrt(1 - 2e-2 / ring.area), rel=1e-12)


@pytest.mark.parametrize("scale", [1e-7, 1e-5, 2e-4])
def test_circle_loses_exactly_the_shares(circle, scale):
    ring = circle(120)
    share = scale * (1.5 + np.sin(2 * np.pi * np.arange(120) / 40))
    share[60:80] = 0
    worn = recede(ring, share, ("rim",))
    assert len(worn) == len(ring)
    lost = exact_area(ring.points) - exact_area(worn.points)
    assert lost == pytest.approx(share.sum(), rel=1e-12, abs=4e-16 * ring.area)
    still = (share == 0) & (np.roll(share, 1) == 0) & (np.roll(share, -1) == 0)
    assert (worn.points[still] == ring.points[still]).all(), "what does not wear does not move"


def test_shipped_lip_loses_exactly_the_shares(seal):
    outline = seal.part.outline
    on = np.flatnonzero(outline.on(("lip",)))
    bump = np.exp(-(((np.arange(len(on)) - len(on) / 2) / (len(on) / 6)) ** 2))
    share = np.zeros(len(outline))
    share[on] = 2e-3 * outline.lengths[on] * bump
    worn = recede(outline, share, ("lip",))
    lost = exact_area(outline.points) - exact_area(worn.points)
    assert lost == pytest.approx(share.sum(), rel=1e-12, abs=4e-16 * outline.area)
    assert len(worn) == len(outline)


def test_each_point_gets_its_own_share(circle):
    """A single worn point of a circle moves along its normal by the area of the two triangles it loses."""
    ring = circle(40)
    share = np.zeros(40)
    share[7] = 1e-5
    worn = recede(ring, share, ("rim",))
    moved = ring.points[7] - worn.points[7]
    base = np.linalg.norm(ring.points[8] - ring.points[6])
    assert np.linalg.norm(moved) == pytest.approx(2 * 1e-5 / base, rel=1e-12)
    assert moved @ ring.points[7] == pytest.approx(np.linalg.norm(moved), rel=1e-12)


def test_ends_of_a_worn_edge_slide_along_the_unworn_neighbours(rectangle):
    box = rectangle(4.0, 2.0, 8, 4)
    width = 0.5 * (box.lengths * box.on(("top",)) + np.roll(box.lengths * box.on(("top",)), 1))
    worn = recede(box, 0.1 * width, ("top",))
    expected = np.where(np.isclose(box.points[:, 1:], 2.0), [[0, -0.1]], 0.0) + box.points
    assert np.allclose(worn.points, expected, atol=1e-12)


def test_nothing_worn_gives_the_same_outline(circle):
    ring = circle(12)
    assert recede(ring, np.zeros(12), ("rim",)) is ring


def finned(rectangle, width, height):
    """A 4 x 2 block with a fin on top, its sides and tip named fin."""
    n = 8
    y = np.linspace(0, height, n + 1)
    x0, x1 = 2 - width / 2, 2 + width / 2
    points = [(0, 0), (4, 0), (4, 2)]
    points += [(x1, 2 + v) for v in y] + [(x0, 2 + v) for v in y[::-1]] + [(0, 2)]
    names = ["bottom", "right", "top"] + ["fin"] * (2 * n + 1) + ["top", "left"]
    corners = [True] * 3 + [True] + [False] * (n - 1) + [True, True] + [False] * (n - 1) + [True, True]
    return Outline(np.array(points, dtype=float), tuple(names), np.array(corners))


def test_outline_that_crosses_itself_is_healed_to_a_simple_one(rectangle):
    """The side walls of a tapering fin, worn past each other at its tip, leave a shorter fin."""
    block = finned(rectangle, 0.3, 0.5)
    top = block.points[:, 1].max()
    narrow = block.points.copy()
    above = narrow[:, 1] > 2
    narrow[above, 0] = 2 + (narrow[above, 0] - 2) * (1.05 - (narrow[above, 1] - 2) / 0.5)
    block = Outline(narrow, block.names, block.corners)
    share = np.zeros(len(block))
    inner = block.on(("fin",)) & np.roll(block.on(("fin",)), 1)
    share[inner] = 0.03 * 0.5 * (block.lengths + np.roll(block.lengths, 1))[inner]
    worn = recede(block, share, ("fin",))
    assert len(worn) != len(block)
    assert set(worn.names) == set(block.names)
    assert worn.points[:, 1].max() < top - 0.03
    assert worn.area < block.area
    still = np.isclose(block.points[:, 1], 0)
    assert np.allclose(np.sort(worn.points[np.isclose(worn.points[:, 1], 0, atol=1e-6), 0])[[0, -1]], [0, 4], atol=1e-6)
    assert still.sum() == 2


def test_worn_through_is_refused_with_the_place(rectangle):
    thin = rectangle(4.0, 0.05, 40, 1)
    share = np.zeros(len(thin))
    middle = thin.on(("top",)) & (np.abs(thin.points[:, 0] - 3.0) < 0.6)
    share[middle] = 0.2 * thin.lengths[middle]
    with pytest.raises(GeometryError, match=r"worn through near \[3\.0, 0\.05\]"):
        recede(thin, share, ("top",))


def test_tidied_merges_short_segments_and_keeps_the_area(circle):
    ring = circle(60)
    t = np.array([10.1, 10.2, 30.05])
    crowded = ring.inserted(t)
    field = SizeField(np.empty((0, 2)), np.empty(0), 0.2)
    tidy = tidied(crowded, field, 0.5)
    assert len(tidy) < len(crowded)
    assert tidy.area == pytest.approx(crowded.area, rel=1e-14)
    assert tidy.lengths.min() > 0.3 * np.median(tidy.lengths)


def test_a_rounding_drawn_with_short_segments_is_merged_only_if_the_outline_moves_little_against_the_wear(circle):
    """An arc of segments of 0.031 and one of 0.01 on the unit circle, whose merging moves it by 2e-4 and 3e-5."""
    crowded = circle(60).inserted(np.concatenate([np.arange(0, 16, 2) + 0.3, np.arange(20, 24, 2) + 0.1]))
    field = SizeField(np.empty((0, 2)), np.empty(0), 0.2)
    assert tidied(crowded, field, 0.0) is crowded
    lengths = []
    for depth in (0.002, 0.5):
        tidy = tidied(crowded, field, depth)
        apart = LinearRing(tidy.points).distance(shapely_points(crowded.points))
        assert 0 < apart.max() < SHAPE * depth
        lengths.append(len(tidy))
    assert lengths == [68, 60]


def test_a_section_that_is_almost_gone_is_refused(rectangle):
    refuse_worn_through(rectangle(1.0, 0.01))
    with pytest.raises(GeometryError, match=r"worn through near .*less than 0\.004 mm"):
        refuse_worn_through(rectangle(1.0, 0.003))


def test_a_thin_sheet_that_loses_a_fifth_is_not_worn_through(rectangle):
    """Its corners slide past a point of the sides, so that the outline has to be healed."""
    sheet = rectangle(1.0, 0.1)
    points = np.insert(sheet.points, 2, [1.0, 0.085], axis=0)
    names = (*sheet.names[:2], sheet.names[1], *sheet.names[2:])
    sheet = Outline(points, names, np.insert(sheet.corners, 2, False))
    area = np.where([p[1] > 0.09 for p in sheet.points], 0.02 * 0.5, 0.0)
    worn = recede(sheet, area, ("top",))
    assert worn.area == pytest.approx(0.08, rel=1e-3)


@pytest.mark.parametrize(("width", "stays"), [(0.01, False), (0.05, False), (0.2, True)])
def test_tips_of_tongues_are_taken_off(width, stays):
    """A tongue of length 0.1: its inner angle is 6, 28 or 90 degrees."""
    points = np.array([[0, 0], [0.5 - width / 2, 0], [0.5, -0.1], [0.5 + width / 2, 0], [1, 0], [1, 1], [0, 1]])
    outline = Outline(points, ("worn",) * 4 + ("rest",) * 3, np.array([1, 0, 0, 0, 1, 1, 1], dtype=bool))
    blunt = without_tongues(outline, ("worn",))
    assert (blunt is outline) == stays
    assert blunt.area == pytest.approx(1 + stays * 0.05 * width, rel=1e-12)
    assert without_tongues(outline, ("rest",)) is outline, "what does not wear stays as it is drawn"
