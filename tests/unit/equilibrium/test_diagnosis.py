"""What a walk that gives up says about the cause."""

import ngsolve as ng
import pytest

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.friction import FullSliding
from ngwear.equilibrium.diagnosis import diagnosis, folds
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import advance
from ngwear.errors import ConvergenceError
from ngwear.fields.kinematics import Axisymmetric, PlaneStrain
from ngwear.materials import NeoHooke
from ngwear.surfaces import Plane
from ngwear.verify.builders import meshed

RUBBER = NeoHooke(shear=1.0, bulk_modulus=50.0)
LID = Plane(point=(0.0, 1.0), normal_vector=(0.0, -1.0))


def pressed(rectangle, supports, *, surface=LID, friction=0.0, kinematics=None, travel=1e-3):
    """A block 2 x 1 with a surface above that a force presses on."""
    body = meshed(rectangle(2.0, 1.0), 0.25)
    contact = OutlineContact("lid", ("top",), surface, modulus=1.0, force_controlled=True)
    terms = [Elasticity(RUBBER), contact]
    if friction:
        terms.append(FullSliding(contact, friction))
    problem = Problem(body, kinematics or PlaneStrain(), terms, supports=supports)
    problem.fields[contact.travel_name].vec[:] = travel
    return problem


@pytest.mark.parametrize(
    ("held", "missing"),
    [
        ([], "along x and along y:"),
        ([FixedEdges(("bottom",), x=False)], "along x:"),
        ([FixedEdges(("bottom",), y=False)], "along y:"),
    ],
)
def test_the_direction_that_nothing_holds_is_named(rectangle, held, missing):
    problem = pressed(rectangle, held, friction=0.3)
    with pytest.raises(ConvergenceError, match=f"nothing holds the part {missing}"):
        advance(problem, {"lid force [N]": 0.5})


def test_a_part_held_at_one_point_only_turns(rectangle):
    problem = pressed(rectangle, [], travel=-0.5)
    corner = int(problem.body.outline.vertices[0, 0])
    u = problem.part("displacement")
    for dof in (u.start + corner, u.start + (u.stop - u.start) // 2 + corner):
        problem.free[dof] = False
    assert "nothing holds the part against turning about z" in diagnosis(problem)


def test_axisymmetric_part_can_slide_along_its_axis_only(rectangle):
    problem = pressed(rectangle, [], kinematics=Axisymmetric(), travel=-0.5)
    assert "nothing holds the part along x:" in diagnosis(problem)


def test_a_surface_that_touches_nothing_is_named(rectangle):
    problem = pressed(rectangle, [FixedEdges(("bottom",))], travel=-0.5)
    with pytest.raises(ConvergenceError, match="surface 'lid' under force touches nothing"):
        advance(problem, {"lid force [N]": 0.5})


def test_a_part_that_is_held_and_touched_gets_no_advice(rectangle):
    problem = pressed(rectangle, [FixedEdges(("bottom",))])
    advance(problem, {"lid force [N]": 0.5})
    assert diagnosis(problem) == ""


def test_a_surface_that_creases_is_said_with_its_place_and_numbers(rectangle):
    problem = pressed(rectangle, [FixedEdges(("bottom",))], friction=0.5)
    contact = problem.terms[1]
    problem.fields["displacement"].Set(ng.CF((-0.4 * ng.x, 0.6 * ng.y)))
    problem.fields[contact.pressure_name].Set(2.0, definedon=problem.body.boundary(("top",)))
    least, place = contact.least_stretch()
    assert least == pytest.approx(0.6, rel=1e-9)
    assert place[1] == 1.0
    told = diagnosis(problem)
    assert "friction of 0.5 under p/G = 3.3 at contact 'lid' compresses the surface at (" in told
    assert ", 1) to 0.6 of its length; it creases from 0.65" in told


def test_friction_beyond_steady_sliding_is_said_with_its_margin(rectangle):
    problem = pressed(rectangle, [FixedEdges(("bottom",))], friction=1.5)
    _, contact, friction = problem.terms
    problem.fields[contact.pressure_name].Set(2.0, definedon=problem.body.boundary(("top",)))
    assert friction.margin() == pytest.approx(2 - 1.5**2 * 2.0, rel=1e-9)
    assert "friction of 1.5 under p/G = 2 at contact 'lid' is more than steady sliding bears" in diagnosis(problem)
    problem.set_loads({"lid slip": 0.0})
    assert "bears" not in diagnosis(problem)


@pytest.mark.parametrize(
    ("moved", "told"),
    [
        ((0.0, 0.0), ""),
        ((-2.4 * (ng.x - 1.0) * ng.y, 0.0), "the outline crosses itself at (1, 0.4167): the part touches itself there"),
        ((-0.4 * ng.x, 0.6 * ng.y), "is compressed to 0.6 of its length at ("),
        ((0.0, -0.2 * ng.y - 0.6 * ng.y * ng.x * (2.0 - ng.x)), " of the undeformed section is squeezed to 0.2"),
    ],
)
def test_a_load_that_folds_the_section_is_said_with_the_place(rectangle, moved, told):
    problem = pressed(rectangle, [FixedEdges(("bottom",))])
    problem.fields["displacement"].Set(ng.CF(moved))
    assert told in folds(problem)
    assert bool(folds(problem)) == bool(told)


def test_a_walk_that_fails_without_friction_says_where_it_folds(rectangle):
    problem = pressed(rectangle, [FixedEdges(("bottom",))])
    with pytest.raises(ConvergenceError, match="no equilibrium between") as failed:
        advance(problem, {"lid force [N]": 200.0})
    assert "is compressed to" in str(failed.value) or "is squeezed to" in str(failed.value)
    assert failed.value.cause == ""
