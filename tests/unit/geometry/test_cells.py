from dataclasses import replace

import numpy as np
import pytest

from ngwear.errors import GeometryError
from ngwear.geometry.cells import HOLE, Fate
from ngwear.geometry.element_body import ElementBody
from ngwear.verify.cell_blocks import grid, named

N, M = 6, 5
BLOCK = grid(np.arange(N + 1.0), np.arange(M + 1.0))


def mask(*places, n=N, m=M):
    """Elements by column and row."""
    out = np.zeros((m, n), dtype=bool)
    for i, j in places:
        out[j, i] = True
    return out.ravel()


def lost(*places, fate=Fate.TORN, **options):
    return BLOCK.without(mask(*places), fate, **options)


def one(points, corners):
    return named(np.array(points, dtype=float), [corners], lambda ends: "rim", np.full(len(points), -1))


def sides(cells):
    """Names of the outline's segments by their middles."""
    a, b = cells.points[cells.rim], cells.points[np.roll(cells.rim, -1)]
    return {tuple(middle): name for middle, name in zip((0.5 * (a + b)).tolist(), cells.names, strict=True)}


@pytest.mark.parametrize(
    ("points", "corners", "area", "cosine", "jacobian"),
    [
        ([(0, 0), (2, 0), (3, 2), (0, 1)], (0, 1, 2, 3), 3.5, np.sqrt(0.5), 2.0),
        ([(0, 0), (2, 0), (3, 2), (0, 1)], (2, 3, 0, 1), 3.5, np.sqrt(0.5), 2.0),
        ([(0, 0), (4, 0), (0, 3)], (0, 1, 2), 6.0, 0.8, 12.0),
        ([(0, 0), (4, 0), (0, 3)], (1, 2, 0), 6.0, 0.8, 12.0),
        ([(0, 0), (4, 0), (0, 3)], (2, 0, 1), 6.0, 0.8, 12.0),
        ([(0, 0), (4, 0), (1, 1), (0, 4)], (0, 1, 2, 3), 4.0, 1.0, -8.0),  # a dart is inside out at its notch
    ],
)
def test_area_and_corners_are_those_by_hand(points, corners, area, cosine, jacobian):
    cell = one(points, corners)
    assert cell.areas() == pytest.approx([area])
    assert cell.corner_cosines() == pytest.approx([cosine])
    assert cell.least_jacobians() == pytest.approx([jacobian])


def test_a_lost_surface_element_leaves_a_pit_that_is_part_of_its_edge():
    left = lost((2, 4))
    before, after = sides(BLOCK), sides(left)
    assert {place for place in before if place not in after} == {(2.5, 5.0)}
    assert {place: after[place] for place in after if place not in before} == dict.fromkeys(
        [(2.0, 4.5), (2.5, 4.0), (3.0, 4.5)], "top"
    )
    assert all(after[place] == name for place, name in before.items() if place in after)
    assert left.area == pytest.approx(N * M - 1)
    assert left.contour.area == pytest.approx(N * M - 1)
    assert left.fate.tolist().count(Fate.TORN) == 1


def test_a_lost_layer_leaves_one_of_the_same_name_with_its_corners():
    left = lost(*[(i, 4) for i in range(N)])
    floor = {place[0]: name for place, name in sides(left).items() if place[1] == 4.0}
    assert floor == {i + 0.5: "top" for i in range(N)}


def test_the_outline_begins_where_it_did_as_long_as_that_point_is_left():
    for begin in range(len(BLOCK.rim)):
        turned = replace(BLOCK, rim=np.roll(BLOCK.rim, -begin), names=BLOCK.names[begin:] + BLOCK.names[:begin])
        assert turned.without(mask((2, 4)), Fate.TORN).rim[0] == turned.rim[0]
        assert turned.without(mask((0, 0)), Fate.TORN).rim[0] == turned.rim[int(turned.rim[0] == 0)]


def test_what_a_support_held_is_not_passed_on():
    assert sides(lost((2, 0)))[2.5, 1.0] == "bottom"
    after = sides(lost((2, 0), bonded=("bottom",)))
    assert after[1.5, 0.0] == "bottom"
    assert after[2.5, 1.0] != "bottom"
    assert sides(lost((2, 0), bonded=("bottom", "right", "top", "left")))[2.5, 1.0] == "exposed"


def test_an_element_lost_inside_leaves_a_hole():
    left = lost((2, 2))
    np.testing.assert_array_equal(left.rim, BLOCK.rim)
    around = {frozenset(map(tuple, left.points[side].tolist())) for side in left.holes()}
    square = [(2.0, 2.0), (3.0, 2.0), (3.0, 3.0), (2.0, 3.0)]
    assert around == {frozenset(pair) for pair in zip(square, [*square[1:], square[0]], strict=True)}
    assert left.contour.area - left.area == pytest.approx(1.0)
    assert HOLE in ElementBody(left).mesh.GetBoundaries()
    assert len(BLOCK.holes()) == 0


def test_a_fragment_is_lost_with_what_it_hung_on():
    left = lost((0, 3), (1, 4))
    assert left.fate[mask((0, 4))] == Fate.LOOSE
    assert left.area == pytest.approx(N * M - 3)
    assert (left.fate == Fate.LOOSE).sum() == 1


def test_elements_that_meet_in_one_point_are_no_hinge():
    left = lost((2, 2), (3, 3), fate=Fate.DISTORTED)
    loose = np.flatnonzero(left.fate == Fate.LOOSE)
    assert len(loose) == 1
    assert loose[0] in np.flatnonzero(mask((2, 3), (3, 2)))
    assert (left.fate == Fate.DISTORTED).sum() == 2
    around = left.holes()[:, 0]
    assert len(around) == len(np.unique(around)) == 8


@pytest.mark.parametrize("middle", [2.9, 3.1])
def test_of_the_elements_at_a_hinge_the_smaller_goes(middle):
    uneven = grid(np.array([0.0, 1.0, 2.0, middle, 4.0, 5.0, 6.0]), np.arange(M + 1.0))
    left = uneven.without(mask((2, 2), (3, 3)), Fate.TORN)
    widths = {(2, 3): middle - 2, (3, 2): 4 - middle}
    smaller = min(widths, key=widths.get)
    assert np.flatnonzero(left.fate == Fate.LOOSE).tolist() == np.flatnonzero(mask(smaller)).tolist()


def test_a_hinge_at_the_surface_goes_as_well():
    left = lost((2, 4), (3, 3))
    assert (left.fate == Fate.LOOSE).sum() == 1
    assert len(np.unique(left.rim)) == len(left.rim)
    assert left.contour.area == pytest.approx(left.area)


def test_lost_elements_stay_lost():
    left = lost((2, 4)).without(mask((2, 4), (3, 4)), Fate.DISTORTED)
    assert left.fate[mask((2, 4))] == Fate.TORN
    assert left.fate[mask((3, 4))] == Fate.DISTORTED


def test_a_section_cut_in_two_is_refused_with_area_and_place():
    with pytest.raises(GeometryError, match=r"cut in two: 10 of 25 mm² around \[1\.0, 2\.5\].*critical stress"):
        lost(*[(2, j) for j in range(M)])


def test_nothing_left_is_refused():
    with pytest.raises(GeometryError, match="every element is deactivated"):
        BLOCK.without(np.ones(N * M, dtype=bool), Fate.TORN)


def surface(*columns):
    """Points of the top."""
    return np.array([np.flatnonzero((BLOCK.points == (i, M)).all(axis=1))[0] for i in columns])


def worn(*columns, depth):
    """The block, some of whose surface points have sunk."""
    points = BLOCK.points[BLOCK.rim].copy()
    points[np.isin(BLOCK.rim, surface(*columns)), 1] -= depth
    return BLOCK.moved(points)


@pytest.mark.parametrize("depth", [0.85, 1.0, 1.2])
def test_merging_one_point_keeps_the_area_and_makes_triangles(depth):
    before, (top,) = worn(2, depth=depth), surface(2)
    merged = before.merged(np.array([top]))
    assert merged.area == pytest.approx(before.area, rel=1e-15)
    assert merged.contour.area == pytest.approx(merged.area, rel=1e-15)
    shrunk = mask((1, 4), (2, 4))
    assert not merged.quads[shrunk].any()
    assert merged.quads[~shrunk].all()
    assert merged.living.all()
    assert (merged.areas()[shrunk] > 0).all()
    assert merged.below[top] == BLOCK.below[BLOCK.below[top]]
    np.testing.assert_array_equal(merged.rim, BLOCK.rim)
    assert merged.names == BLOCK.names


def test_what_is_between_merged_points_is_worn_away():
    before = worn(2, 3, depth=0.95)
    merged = before.merged(surface(2, 3))
    assert np.flatnonzero(merged.fate == Fate.WORN) == np.flatnonzero(mask((2, 4)))
    assert merged.area == pytest.approx(before.area, rel=1e-15)
    assert ElementBody(merged).mesh.ne == N * M - 1


def test_merged_again_a_column_goes_on_down():
    (top,) = surface(2)
    before = worn(2, depth=1.95)
    twice = before.merged(surface(2)).merged(surface(2))
    assert BLOCK.points[twice.below[top]].tolist() == [2.0, 2.0]
    assert twice.area == pytest.approx(before.area, rel=1e-15)
    assert (twice.areas()[twice.living] > 0).all()
    assert np.flatnonzero(~twice.quads).tolist() == np.flatnonzero(mask((1, 3), (2, 3), (1, 4), (2, 4))).tolist()


def test_points_of_a_wall_that_are_merged_leave_the_outline():
    pit = lost((2, 4))
    points = pit.points[pit.rim].copy()
    top = surface(2)
    points[np.isin(pit.rim, top), 1] -= 1.0
    merged = pit.moved(points).merged(top)
    assert len(merged.rim) == len(pit.rim) - 1
    assert merged.contour.area == pytest.approx(merged.area, rel=1e-15)
