"""What nodes on mesh edges tell of a pressure between them."""

import numpy as np
import pytest

from ngwear.effects.contact_profile import ContactProfile, EdgeNodes, nodal_pressure

PEAK = 1.0


def parabola(first, edges, *, longer=1.0):
    """Profile of the pressure 1 - x^2 MPa from the L2 projection on each mesh edge; edges beyond ``edges`` are longer.

    ``first`` is the coordinate of the first node, in mm.
    """
    lengths = 0.25 * np.where(np.arange(edges) < edges // 2, 1.0, longer)
    x = first + np.concatenate([[0.0], np.cumsum(lengths)])
    ends = np.stack([x[:-1], x[1:]], axis=1)
    mean = PEAK - (ends**2).mean(axis=1) + lengths**2 / 6
    slope = -(ends[:, 1] + ends[:, 0])
    samples = mean[:, None] + slope[:, None] * (ends - ends.mean(axis=1, keepdims=True))
    nodes = EdgeNodes(np.arange(edges + 1.0), np.stack([np.arange(edges), np.arange(1, edges + 1)], axis=1))
    pressure, load, weight = nodal_pressure(nodes, lengths, samples)
    place = np.stack([x, 0.0 * x], axis=1)
    values = {"nominal_pressure": pressure, "pressure": pressure, "weight": weight, "load": load}
    places = {"t": nodes.t, "reference": place, "place": place, "edges": nodes.of_edges}
    flat = {"gap": 0.0 * x, "mean": mean, "standing_off": 0.0 * lengths}
    return ContactProfile(**values, **places, **flat)


@pytest.mark.parametrize("shift", [0.0, 0.03, 0.06, 0.09, 0.125])
@pytest.mark.parametrize("longer", [1.0, 1.5])
def test_a_parabola_is_missed_at_its_peak_by_no_more_than_stated(shift, longer):
    profile = parabola(-0.75 + shift, 6, longer=longer)
    missed = PEAK - profile.pressure.max()
    assert 0 < missed <= 1.001 * profile.missed_at_peak


def test_that_is_all_of_it_if_the_peak_lies_midway_between_two_nodes():
    profile = parabola(-0.875, 7)
    assert PEAK - profile.pressure.max() == pytest.approx(profile.missed_at_peak, rel=1e-9)


def test_nothing_is_missed_out_of_contact():
    profile = parabola(5.0, 6)
    assert not profile.pressure.any()
    assert profile.missed_at_peak == 0.0
