"""The outline before and after a deformation: stretch of its edges, and where it crosses itself."""

import ngsolve as ng
import numpy as np
import pytest

from ngwear.fields.deformed_outline import crossing, outline_places, stretches
from ngwear.verify.builders import meshed


@pytest.fixture
def block(rectangle):
    """A block 2 x 1, and its displacements."""
    section = meshed(rectangle(2.0, 1.0), 0.25)
    return section, ng.GridFunction(ng.VectorH1(section.mesh, order=2))


def test_edges_stretch_as_the_section_does(block):
    section, displacement = block
    displacement.Set(ng.CF((-0.4 * ng.x, 0.5 * ng.y)))
    before, after = outline_places(section, displacement)
    along = np.isin(section.outline.names, ("bottom", "top"))
    found = stretches(before, after)
    assert found[:, along] == pytest.approx(0.6, rel=1e-9)
    assert found[:, ~along] == pytest.approx(1.5, rel=1e-9)
    assert after[..., 0] == pytest.approx(0.6 * before[..., 0], abs=1e-12)
    assert crossing(after) is None


def test_sides_moved_through_each_other_cross(block):
    """The top is turned over: x = 1 + (X - 1) (1 - 2.4 Y), which is 1 at Y = 1/2.4."""
    section, displacement = block
    displacement.Set(ng.CF((-2.4 * (ng.x - 1.0) * ng.y, 0.0)))
    _, after = outline_places(section, displacement)
    assert crossing(after) == pytest.approx((1.0, 1 / 2.4), rel=1e-9)
