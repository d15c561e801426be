from dataclasses import replace

import numpy as np
import pytest

from ngwear.effects.elasticity import Elasticity
from ngwear.equilibrium.problem import Problem
from ngwear.errors import MeshError
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.cells import Fate
from ngwear.geometry.element_body import ElementBody
from ngwear.geometry.layers import layered
from ngwear.materials import NeoHooke


@pytest.fixture
def body(rectangle):
    """Layers on triangles, with a pit and a hole."""
    cells = layered(rectangle(2.0, 1.0), ("top",), depth=0.4, edge=0.1, coarse=0.4, grading=0.3)
    middle = cells.points[cells.corners].mean(axis=1, where=(cells.corners >= 0)[..., None])
    pit = np.linalg.norm(middle - (0.55, 0.95), axis=1) < 0.07
    hole = np.linalg.norm(middle - (1.45, 0.75), axis=1) < 0.07
    assert pit.sum() == hole.sum() == 1
    return ElementBody(cells.without(pit | hole, Fate.TORN))


def sunk(body, by=0.04):
    """The outline with its top waved."""
    points = body.base.points.copy()
    on = body.contour.on(("top",)) & np.roll(body.contour.on(("top",)), 1) & (points[:, 1] == 1.0)
    points[on, 1] -= by * np.sin(7 * points[on, 0]) ** 2
    return replace(body.contour, points=points)


def residual(body):
    problem = Problem(body, PlaneStrain(), [Elasticity(NeoHooke(shear=1.0, bulk_modulus=50.0))])
    state = problem.state.vec.FV().NumPy()
    state[:] = 1e-3 * np.sin(np.arange(len(state)) ** 1.5)
    out = problem.state.vec.CreateVector()
    problem.residual(out)
    return out.FV().NumPy().copy()


def assert_same(first, second):
    np.testing.assert_array_equal(first.mesh.ngmesh.Coordinates(), second.mesh.ngmesh.Coordinates())
    np.testing.assert_array_equal(first.contour.points, second.contour.points)
    np.testing.assert_array_equal(first.base.points, second.base.points)
    for name in ("vertices", "numbers"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))
    for name in ("element", "vertices", "edge", "t", "names"):
        np.testing.assert_array_equal(getattr(first.outline, name), getattr(second.outline, name))
    assert first.region_names == second.region_names
    np.testing.assert_array_equal(residual(first), residual(second))


@pytest.mark.parametrize("moved", [False, True], ids=["as meshed", "moved"])
def test_a_stored_body_comes_back_bit_for_bit(body, moved):
    if moved:
        body.move_to(sunk(body))
    back = ElementBody.from_data(body.to_data())
    assert_same(body, back)
    if moved:
        assert np.abs(residual(back) - residual(ElementBody(body.cells))).max() > 1e-6, "the outline has moved"


def test_the_mesh_moves_with_the_outline(body):
    import ngsolve as ng

    body.move_to(sunk(body))
    assert ng.Integrate(ng.CF(1.0), body.mesh) == pytest.approx(body.now.area, rel=1e-12)
    assert body.now.area < body.cells.area - 0.01
    body.move_to(body.base)
    assert ng.Integrate(ng.CF(1.0), body.mesh) == pytest.approx(body.cells.area, rel=1e-12)


def test_a_move_that_turns_an_element_inside_out_is_refused_and_changes_nothing(body):
    body.move_to(sunk(body))
    before, moves, contour = residual(body), body.moves, body.contour
    with pytest.raises(MeshError, match="would shrink an element to -0"):
        body.move_to(sunk(body, by=0.15))
    assert body.contour is contour
    assert body.moves == moves
    np.testing.assert_array_equal(residual(body), before)


def test_lost_elements_and_their_points_are_not_in_the_mesh(body):
    cells = body.cells
    assert body.mesh.ne == cells.living.sum() == len(cells.fate) - 2
    assert set(body.numbers) == set(np.flatnonzero(cells.living))
    kept = cells.corners[cells.living]
    assert set(body.vertices) == set(kept[kept >= 0])


def test_edges_that_are_lost_are_left_out_as_long_as_one_is_there(body):
    assert list(body.boundary(("top", "gone")).Mask()) == list(body.boundary(("top",)).Mask())
    with pytest.raises(MeshError, match=r"nothing of the edges \['gone'\] is left"):
        body.boundary(("gone",))
