import netgen.occ as occ
import ngsolve as ng
import numpy as np
import pytest

from ngwear.errors import MeshError
from ngwear.geometry import section
from ngwear.geometry.body import Body
from ngwear.geometry.outline import Outline
from ngwear.geometry.recession import recede
from ngwear.geometry.sizing import SizeField, fitted, mesh_nodes

NOWHERE = (np.empty((0, 2)), np.empty(0))


def test_size_grows_with_the_distance_up_to_coarse():
    field = SizeField(np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([0.1, 0.02]), 0.3, 0.25)
    points = np.array([[0, 0], [1, 0], [1, 0.4], [0, -0.4], [9, 9]], dtype=float)
    assert field(points) == pytest.approx([0.1, 0.02, 0.12, 0.2, 0.3])


def test_no_seeds_is_coarse_everywhere():
    assert SizeField(*NOWHERE, 0.3)(np.zeros((4, 2))).tolist() == [0.3] * 4


def test_fitted_leaves_no_long_segment_and_keeps_the_area(rectangle):
    field = SizeField(np.array([[2.0, 2.0]]), np.array([0.02]), 0.5, 0.25)
    fit = fitted(rectangle(4.0, 2.0, 8, 4), field)
    ends = field(fit.points)
    assert (fit.lengths <= 1.3 * np.minimum(ends, np.roll(ends, -1)) + 1e-12).all()
    assert fit.area == pytest.approx(8.0, rel=1e-13)
    assert fitted(fit, field) is fit


def test_mesh_nodes_take_corners_and_name_changes_and_bound_the_turn(circle, rectangle):
    box = rectangle(4.0, 2.0, 40, 20)
    nodes = mesh_nodes(box, SizeField(*NOWHERE, 0.5))
    assert set(np.flatnonzero(box.corners)) <= set(nodes)
    assert len(nodes) < len(box) / 2
    ring = circle(100)
    assert len(mesh_nodes(ring, SizeField(*NOWHERE, 5.0))) >= 4, "a coarse mesh still shows the shape"


def turns(ring, body):
    """How far the outline turns along each mesh edge [rad], of a circle."""
    return 2 * np.pi * np.diff(body.outline.t)[:, 0] / len(ring)


@pytest.mark.parametrize("turn", [0.2, 0.3])
def test_mesh_edges_turn_as_far_as_the_field_allows(circle, turn):
    ring = circle(200)
    body = Body(ring, SizeField(*NOWHERE, 5.0, 0.5, elsewhere=turn))
    assert turns(ring, body).max() <= turn + 2 * np.pi / 200
    assert np.median(turns(ring, body)) > 0.8 * turn, "the mesher itself divides no more"


@pytest.mark.parametrize("elsewhere", [0.5, 0.7])
def test_a_mesh_that_cuts_corners_is_made_anew_with_shorter_edges_on_curves(circle, elsewhere):
    ring = circle(200)  # by quadratic edges that turn by 0.5 rad an area is 4e-4 too small
    body = Body(ring, SizeField(*NOWHERE, 5.0, 0.5, elsewhere=elsewhere))
    assert turns(ring, body).max() <= 0.5 * elsewhere + 2 * np.pi / 200
    assert ng.Integrate(1, body.mesh) == pytest.approx(np.pi, rel=1e-4)


def test_mesh_has_the_outlines_area_and_names(rectangle):
    body = Body(rectangle(4.0, 2.0), SizeField(*NOWHERE, 0.5))
    assert ng.Integrate(1, body.mesh) == pytest.approx(8.0, rel=1e-10)
    assert set(body.region_names) == {"bottom", "right", "top", "left"}
    assert section.smallest_angle(body.mesh)[0] > section.MIN_ANGLE


def small_mesh(width=1.0, height=1.0):
    face = occ.WorkPlane().Rectangle(width, height).Face()
    face.edges.name = "rim"
    return ng.Mesh(occ.OCCGeometry(face, dim=2).GenerateMesh(maxh=1.0))


def test_area_gate_names_both_areas():
    with pytest.raises(MeshError, match=r"area of 1 mm².*section 1\.01 mm²"):
        section.check(small_mesh(), area=1.01, names={"rim"})


def test_name_gate_names_the_edge():
    with pytest.raises(MeshError, match=r"lost the edges \['lip'\]"):
        section.check(small_mesh(), area=1.0, names={"rim", "lip"})


def test_angle_gate_names_angle_and_place():
    needle = Outline(np.array([[0, 0], [3, 0], [3, 0.3]], dtype=float), ("a", "b", "c"), np.ones(3, dtype=bool))
    with pytest.raises(MeshError, match=r"element at \[.*angle of 5\.\d°, below 12"):
        Body(needle, SizeField(*NOWHERE, 0.5))


def test_unknown_boundary_is_named(rectangle):
    body = Body(rectangle(4.0, 2.0), SizeField(*NOWHERE, 1.0))
    with pytest.raises(MeshError, match=r"no edges \['lip'\].*bottom"):
        body.boundary(("lip",))


def test_mesh_follows_a_worn_outline(rectangle):
    body = Body(rectangle(4.0, 2.0), SizeField(*NOWHERE, 0.5))
    base = body.base
    share = np.zeros(len(base))
    on = base.on(("top",))
    share[on & np.roll(on, 1)] = 1e-3
    worn = recede(base, share, ("top",))
    body.move_to(worn)
    assert ng.Integrate(1, body.mesh) == pytest.approx(worn.area, rel=1e-4)
    body.move_to(base)
    assert ng.Integrate(1, body.mesh) == pytest.approx(8.0, rel=1e-10)


def test_fold_is_refused_and_the_body_left_as_it_was(rectangle):
    body = Body(rectangle(4.0, 2.0), SizeField(*NOWHERE, 0.5))
    base = body.base
    move = np.zeros_like(base.points)
    middle = np.argmin(np.linalg.norm(base.points - [2.0, 2.0], axis=1))
    move[middle, 1] = -1.5
    with pytest.raises(MeshError, match="shrink an element"):
        body.move_to(base.moved(move))
    assert body.contour is base
    assert ng.Integrate(1, body.mesh) == pytest.approx(8.0, rel=1e-10)
