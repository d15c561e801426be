"""A fluid that a contact just holds."""

from types import SimpleNamespace

import numpy as np
import pytest

from ngwear.effects.blow_by import barely_held

PRESSURE = 10.0


def fluid(*carried, share=()):
    """A fluid before mesh edges that carry these contact pressures, on one way; the first ones are its inlet."""
    carried = np.array([0.0, *carried])
    contact = SimpleNamespace(positions=np.arange(len(carried)), edge_peaks=lambda: carried)
    shares = np.zeros(len(carried))
    shares[: len(share) + 1] = [1.0, *share]
    return SimpleNamespace(
        name="fluid",
        pressure=SimpleNamespace(Get=lambda: PRESSURE),
        contacts=[contact],
        names=np.array([f"edge {i}" for i in range(len(carried))]),
        paths=[(1, np.arange(len(carried)))],
        shares=shares,
        stops=lambda: [carried > 0],
    )


def test_a_low_ridge_before_a_higher_one_holds_hardly():
    (held,) = barely_held(fluid(3.0, 9.8, 10.05, 7.0, 8.0, 20.0, 5.0))
    assert (held.edge, held.next_edge) == ("edge 3", "edge 6")
    assert (held.pressure, held.ridge, held.behind) == (PRESSURE, 10.05, 7.0)


@pytest.mark.parametrize(
    "carried",
    [
        pytest.param((3.0, 12.0, 7.0, 20.0), id="more than it errs by"),
        pytest.param((3.0, 10.05, 9.8, 20.0), id="nothing lower behind"),
        pytest.param((3.0, 10.05, 7.0, 8.0), id="nothing behind would hold it"),
        pytest.param((3.0, 4.0), id="nothing holds it: that is blow-by"),
    ],
)
def test_else_it_is_held_or_not(carried):
    assert barely_held(fluid(*carried)) == []


def test_edges_that_the_fluid_has_wetted_hold_nothing():
    assert barely_held(fluid(10.05, 7.0, 20.0, share=(1.0, 1.0))) == []
