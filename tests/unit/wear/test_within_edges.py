"""A curve of the outline within a mesh edge that the contact does not see is worn off; the worn area stays."""

from dataclasses import replace

import numpy as np
import pytest

from ngwear.effects.contact_profile import ContactProfile
from ngwear.wear.within_edges import evened


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


def worn(box, *shallow):
    """Worn area of 1 µm at the points along the lower side, and of half of it at these."""
    share = 1e-3 * 0.5 * (np.arange(len(box)) < 8)
    share[list(shallow)] *= 0.5
    return share


def test_ends_gain_what_the_points_between_them_give(box):
    share = worn(box, 2, 4)
    moved = evened(box, profile([2.0, 4.0, 6.0], [3e-4, 0.0]), share) - share
    exact = np.zeros(len(box))  # both ends wear deeper by 2/3 of 3e-4 mm on half of a segment of 0.5 mm
    exact[[2, 3, 4]] = 5e-5, -1e-4, 5e-5
    assert moved == pytest.approx(exact)


def test_the_unseen_curve_goes_with_its_exact_size(box):
    off, share = 1e-5, worn(box, 2, 6)
    moved = evened(box, profile([2.0, 6.0], [off]), share) - share
    depth = moved / box.widths()
    assert 2 * depth[[2, 6]] == pytest.approx(2 / 3 * off)  # the edge beside gives the other half
    assert np.ptp(depth[3:6]) == pytest.approx(0.0, abs=1e-18)


def test_no_end_becomes_the_deeper_one(box):
    share = worn(box, 2, 4, 6)
    made = evened(box, profile([2.0, 4.0, 6.0], [1.0, 1.0]), share)
    assert made.sum() == pytest.approx(share.sum(), rel=1e-15)
    assert made[[2, 4, 6]] == pytest.approx([1e-3 / 3] * 3)
    assert (made[[3, 5]] >= made[[2, 4]]).all()
    assert (made >= 0).all()


@pytest.mark.parametrize("standing_off", [1e-6, 1e-3, 1.0])
def test_where_ends_are_not_shallower_nothing_moves(box, standing_off):
    """A gap that is not of the worn shape stays from step to step; wear would run to the ends without bound."""
    share = worn(box, 3, 5)
    assert evened(box, profile([2.0, 4.0, 6.0], [standing_off] * 2), share) == pytest.approx(share, rel=1e-15)


@pytest.mark.parametrize(
    ("t", "off", "pressure"),
    [([2.0, 4.0], [-1e-3], 1.0), ([2.0, 4.0], [1e-3], 0.0), ([2.0, 3.0], [1e-3], 1.0), ([2.3, 3.6], [1e-3], 1.0)],
    ids=["middle presses", "out of contact", "no point between", "ends are no points"],
)
def test_nothing_moves_without_cause(box, t, off, pressure):
    share = worn(box, 2, 3, 4)
    share[3] *= 2
    assert evened(box, profile(t, off, pressure), share) == pytest.approx(share, rel=1e-15)


def test_an_edge_may_lie_across_the_end_of_the_outline(box):
    share = np.full(len(box), 5e-4)
    share[[1, 23]] = 2.5e-4
    moved = evened(box, replace(profile([1.0, 23.0], [3e-4]), edges=np.array([[1, 0]])), share) - share
    assert moved[[0, 1, 23]] == pytest.approx([-1e-4, 5e-5, 5e-5])
    assert moved.sum() == pytest.approx(0.0, abs=1e-18)
