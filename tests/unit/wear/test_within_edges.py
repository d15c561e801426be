"""A curve of the outline within a mesh edge that the contact does not see is worn off; the worn area stays."""

from dataclasses import replace

import numpy as np
import pytest

from ngwear.effects.contact_profile import ContactProfile
from ngwear.wear.within_edges import MOST, evened


def profile(t, standing_off, pressure=1.0):
    t = np.asarray(t, dtype=float)
    edges = np.stack([np.arange(len(t) - 1), np.arange(1, len(t))], axis=1)
    nodal, empty = np.full(len(t), pressure), np.zeros((len(t), 2))
    return ContactProfile(
        t=t,
        reference=empty,
        place=empty,
        nominal_pressure=nodal,
        pressure=nodal,
        gap=np.zeros(len(t)),
        weight=nodal,
        load=nodal,
        edges=edges,
        mean=nodal[edges].mean(axis=1),
        standing_off=np.asarray(standing_off),
    )


@pytest.fixture
def box(rectangle):
    return rectangle(4.0, 2.0, 8, 4)  # points 0.5 mm apart


def worn(box):
    return 1e-3 * 0.5 * (np.arange(len(box)) < 8)


def test_ends_gain_what_the_points_between_them_give(box):
    share = worn(box)
    made = evened(box, profile([2.0, 4.0, 6.0], [3e-4, 0.0]), share)
    # Both ends wear deeper by 2/3 of 3e-4 mm on half of a segment of 0.5 mm.
    assert made - share == pytest.approx(np.eye(len(box))[[2, 4]].sum(axis=0) * 5e-5 - np.eye(len(box))[3] * 1e-4)
    assert made.sum() == pytest.approx(share.sum(), rel=1e-15)


def test_the_unseen_curve_goes_with_its_exact_size(box):
    """After the wear that ``evened`` moves, a gap that has neither mean nor slope for the contact is gone."""
    off = 1e-5
    share = worn(box)
    flow = evened(box, profile([2.0, 6.0], [off]), share) - share
    depth = flow / box.widths()  # both ends have another edge beside them, which gives the other half there
    depth[[2, 6]] *= 2
    assert depth[2] == pytest.approx(2 / 3 * off)
    assert depth[6] == pytest.approx(2 / 3 * off)
    assert np.ptp(depth[3:6]) == pytest.approx(0.0, abs=1e-18)


def test_no_point_gives_more_than_its_part(box):
    share = worn(box)
    made = evened(box, profile([2.0, 4.0, 6.0], [1.0, 1.0]), share)
    assert made[[3, 5]] == pytest.approx((1 - MOST) * share[[3, 5]])
    assert made.sum() == pytest.approx(share.sum(), rel=1e-15)
    assert (made >= 0).all()


@pytest.mark.parametrize(
    ("t", "off", "pressure"),
    [([2.0, 4.0], [-1e-3], 1.0), ([2.0, 4.0], [1e-3], 0.0), ([2.0, 3.0], [1e-3], 1.0), ([2.3, 3.6], [1e-3], 1.0)],
    ids=["middle presses", "out of contact", "no point between", "ends are no points"],
)
def test_nothing_moves_without_cause(box, t, off, pressure):
    share = worn(box)
    assert evened(box, profile(t, off, pressure), share) == pytest.approx(share, rel=1e-15)


def test_an_edge_may_lie_across_the_end_of_the_outline(box):
    share = np.full(len(box), 5e-4)
    made = evened(box, replace(profile([1.0, 23.0], [3e-4]), edges=np.array([[1, 0]])), share)
    assert made.sum() == pytest.approx(share.sum(), rel=1e-15)
    assert made[[1, 23]] == pytest.approx(share[[1, 23]] + 5e-5)
    assert made[0] == pytest.approx(share[0] - 1e-4)
