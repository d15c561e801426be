"""What a walk that gives up says about the cause."""

import numpy as np
import pytest

from ngwear.effects.contact import Contact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.friction import FullSliding
from ngwear.equilibrium.diagnosis import diagnosis
from ngwear.equilibrium.problem import Problem, Support
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.errors import ConvergenceError
from ngwear.fields.kinematics import Axisymmetric, PlaneStrain
from ngwear.materials import NeoHooke
from ngwear.surfaces import Cylinder, Plane
from ngwear.verify.builders import meshed

RUBBER = NeoHooke(shear=1.0, bulk_modulus=50.0)
LID = Plane(point=(0.0, 1.0), normal_vector=(0.0, -1.0))


def pressed(rectangle, supports, *, surface=LID, friction=0.0, kinematics=None, travel=1e-3):
    """A block 2 x 1 with a surface above that a force presses on."""
    body = meshed(rectangle(2.0, 1.0), 0.25)
    contact = Contact("lid", ("top",), surface, modulus=1.0, force_controlled=True)
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
        ([Support(("bottom",), x=False)], "along x:"),
        ([Support(("bottom",), y=False)], "along y:"),
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
    problem = pressed(rectangle, [Support(("bottom",))], travel=-0.5)
    with pytest.raises(ConvergenceError, match="surface 'lid' under force touches nothing"):
        advance(problem, {"lid force [N]": 0.5})


def test_a_part_that_is_held_and_touched_gets_no_advice(rectangle):
    problem = pressed(rectangle, [Support(("bottom",))])
    advance(problem, {"lid force [N]": 0.5})
    assert diagnosis(problem) == ""


def test_friction_that_wrinkles_the_surface_is_said_with_its_numbers(rectangle):
    roller = Cylinder(centre=(1.0, 3.0), radius=2.0)
    problem = pressed(rectangle, [Support(("bottom",))], surface=roller, friction=0.8)
    with pytest.raises(ConvergenceError, match=r"friction of 0\.8 under p/G = [\d.]+ at contact 'lid'") as found:
        advance(problem, {"lid force [N]": 4.0}, StepOptions(first=0.05))
    assert "control the force" in str(found.value)
    strain = problem.points.strain(problem.state.vec.FV().NumPy())[..., :4].reshape(-1, 2, 2)
    least = np.linalg.svd(np.eye(2) + strain, compute_uv=False)[:, -1].min()
    assert f"to {least:.2g} of its length" in str(found.value)
