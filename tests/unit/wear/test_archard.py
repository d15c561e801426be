import math

import numpy as np
import pytest

from ngwear.effects.contact_profile import ContactProfile
from ngwear.wear.archard import critical_distance, worn_share


def profile(t, depth, lengths):
    """A contact with nodes at contour parameters t of an outline of given segment lengths, and W phi_i ds for W."""
    arc = np.interp(t, np.arange(len(lengths) + 1), np.concatenate([[0], np.cumsum(lengths)]))
    h = np.diff(arc)
    edges = np.stack([np.arange(len(t) - 1), np.arange(1, len(t))], axis=1)
    weight = np.bincount(edges.ravel(), np.repeat(h / 2, 2))
    empty = np.zeros((len(t), 2))
    made = ContactProfile(
        t=np.asarray(t, dtype=float),
        reference=empty,
        place=empty,
        nominal_pressure=depth,
        pressure=depth,
        gap=np.zeros(len(t)),
        weight=weight,
        load=depth * weight,
        edges=edges,
        mean=depth[edges].mean(axis=1),
        standing_off=np.zeros(len(edges)),
    )
    return made, depth * weight


def test_uniform_wear_is_uniform_at_points_that_are_no_nodes(rectangle):
    box = rectangle(4.0, 2.0, 8, 4)
    made, amount = profile(np.array([0.0, 1.6, 3.2, 5.0]), np.full(4, 2e-3), box.lengths)
    share = worn_share(box, made, amount)
    assert share.sum() == pytest.approx(2e-3 * 5.0 * 0.5, rel=1e-14)
    assert share[:6] == pytest.approx(2e-3 * 0.5 * np.array([0.5, 1, 1, 1, 1, 0.5]), rel=1e-12)
    assert (share[6:] == 0).all()


def test_a_node_under_low_pressure_wears_least_also_beside_nodes_between_points(rectangle):
    """Else a dent, where the pressure is low, would deepen: the outline got teeth after a remesh."""
    box = rectangle(4.0, 2.0, 8, 4)
    depth = 1e-3 * np.array([3.0, 3.0, 1.0, 3.0, 3.0])
    made, amount = profile(np.array([0.0, 2.0, 3.0, 3.7, 6.0]), depth, box.lengths)
    share = worn_share(box, made, amount)
    assert share.sum() == pytest.approx(amount.sum(), rel=1e-14)
    worn = share[1:6] / 0.5
    assert worn.argmin() == 2  # the point at the node t = 3
    assert worn[2] == pytest.approx(1e-3, rel=0.1)
    assert worn[:2] == pytest.approx([3e-3, 3e-3], rel=0.1)


def test_share_keeps_sum_and_first_moment_for_linear_wear(rectangle):
    box = rectangle(4.0, 2.0, 8, 4)
    t = np.array([1.0, 2.5, 4.5, 6.0])
    made, _ = profile(t, 1e-3 * t, box.lengths)
    # W linear: int W phi ds by Simpson's rule on each edge
    amount = np.zeros(4)
    for i in range(3):
        h, a, b = 0.5 * (t[i + 1] - t[i]), 1e-3 * t[i], 1e-3 * t[i + 1]
        amount[i] += h * (2 * a + b) / 6
        amount[i + 1] += h * (a + 2 * b) / 6
    share = worn_share(box, made, amount)
    assert share.sum() == pytest.approx(0.5 * 1e-3 * (36 - 1) / 2, rel=1e-13)
    assert (share >= 0).all()


def test_between_nodes_wear_is_a_parabola_of_the_mesh_edges_own_mean(rectangle):
    box = rectangle(4.0, 2.0, 16, 8)
    t = np.array([0.0, 4.0, 8.0, 12.0, 16.0])

    def pressure(x):
        return 1e-3 * (1 + x - 0.05 * x**2)

    made, amount = profile(t, pressure(t), box.lengths)
    mean = (pressure(t[:-1]) + 4 * pressure(t[:-1] + 2) + pressure(t[1:])) / 6  # Simpson's rule is exact
    share = worn_share(box, ContactProfile(**{**made.__dict__, "mean": mean}), amount)
    worn = share[1:16] / 0.25
    assert worn / worn.mean() == pytest.approx(pressure(np.arange(1, 16)) / pressure(np.arange(1, 16)).mean(), rel=5e-3)
    bulge = made.mean * np.array([1.0, 1.1, 0.9, 1.0])  # what all nodes' pressures would not tell
    share = worn_share(box, ContactProfile(**{**made.__dict__, "mean": bulge}), amount)
    plain = worn_share(box, made, amount)
    assert share[6] / plain[6] == pytest.approx(1.15, abs=0.01)
    assert share[10] / plain[10] == pytest.approx(0.85, abs=0.01)


def test_where_a_contact_ends_within_a_mesh_edge_nothing_is_worn_beyond(rectangle):
    box = rectangle(4.0, 2.0, 16, 8)
    made, amount = profile(np.array([0.0, 8.0, 16.0]), np.array([2e-3, 1e-3, 0.0]), box.lengths)
    share = worn_share(box, ContactProfile(**{**made.__dict__, "mean": np.array([1.5e-3, 0.2e-3])}), amount)
    assert share.sum() == pytest.approx(amount.sum(), rel=1e-14)
    assert (share[13:] == 0).all()
    assert (share[:12] > 0).all()


def test_share_across_the_outlines_end(circle):
    ring = circle(10)
    made, amount = profile(np.array([8.5, 9.5]), np.full(2, 1e-3), ring.lengths)
    wrapped = ContactProfile(**{**made.__dict__, "t": np.array([9.5, 0.5])})
    share = worn_share(ring, wrapped, amount)
    assert share.sum() == pytest.approx(amount.sum(), rel=1e-14)
    assert share[0] == pytest.approx(amount.sum())  # the only point of the outline in between


def test_no_load_no_share(rectangle):
    made, amount = profile(np.array([0.0, 1.0]), np.zeros(2), rectangle(4.0, 2.0).lengths)
    assert (worn_share(rectangle(4.0, 2.0), made, amount) == 0).all()


def test_critical_distance():
    assert critical_distance(0.01, 0.0, 5.0) == math.inf
    assert critical_distance(0.01, 1e-6, 5.0) == pytest.approx(0.04 / (math.pi * 5e-6))
