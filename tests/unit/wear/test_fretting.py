"""The worn profile of a counter-surface, and two bodies that wear each other."""

import numpy as np
import pytest

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.friction import FullSliding
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import advance
from ngwear.errors import SceneError
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.materials import NeoHooke
from ngwear.plots.fretting import draw_scars
from ngwear.surfaces import Cylinder, Plane, Sphere, WornProfile, bore
from ngwear.verify.builders import meshed
from ngwear.wear.fretting import Fretting, Motion
from ngwear.wear.jump_control import JumpControl

RUBBER = NeoHooke(shear=1.0, bulk_modulus=1e3)


def test_worn_area_and_its_centre_are_kept_for_pieces_that_meet_no_point():
    ends = np.array([[0.13, 0.19], [0.31, 0.19], [-0.07, -0.02]])  # one is given backwards
    depth = np.array([[1.0, 3.0], [0.5, 2.0], [0.0, 0.4]])
    worn = WornProfile(0.05).worn(ends, depth)
    half = np.abs(np.diff(ends, axis=1)).ravel() / 2
    assert worn.area == pytest.approx(float(half @ depth.sum(axis=1)), rel=1e-14)
    moment = half @ (depth * (2 * ends + ends[:, ::-1]) / 3).sum(axis=1)
    assert worn.spacing * worn.depth @ worn.along == pytest.approx(moment, rel=1e-13)
    assert worn.depth[0] == worn.depth[-1] == 0.0


def test_uniform_wear_is_uniform_within_and_adds_up():
    profile = WornProfile(0.1)
    for ends in ([[0.0, 1.0]], [[-2.0, 0.45], [0.45, 1.0]]):
        profile = profile.worn(np.array(ends), np.full((len(ends), 2), 0.25))
    assert profile.at(np.linspace(0.15, 0.85, 9)) == pytest.approx(np.full(9, 0.5), rel=1e-12)
    assert profile.at(np.array([-1.0, -5.0, 5.0])) == pytest.approx([0.25, 0.0, 0.0])
    assert profile.area == pytest.approx(0.25 * (1.0 + 3.0))
    assert profile.worn(np.array([[7.0, 8.0]]), np.zeros((1, 2))) is profile


@pytest.mark.parametrize(
    "surface",
    [bore(8.0), Plane(point=(0.3, 0.4), normal_vector=(3, -4)), Cylinder(centre=(0.0, 6.0), radius=2.0)],
)
def test_coordinate_along_a_surface_grows_with_its_slide(surface):
    ax, ay = surface.approach
    foot = (0.0, 4.0)
    ahead = (foot[0] - 1e-3 * ay, foot[1] + 1e-3 * ax)
    assert surface.along(*ahead) - surface.along(*foot) == pytest.approx(1e-3, rel=1e-5)


def test_a_ball_has_no_profile():
    with pytest.raises(SceneError, match=r"Sphere.*no coordinate"):
        Sphere(centre=(0.0, 0.0, 1.0), radius=1.0).along(0.0, 0.0, 0.0)


def block_under_cylinder(counter):
    """A block of 2 x 1 mm under a cylinder of 4 mm, 0.05 N/mm, with friction."""
    x = np.linspace(-0.5, 0.5, 26)
    body = meshed(Outline.rectangle((-1.0, 1.0), (0.0, 1.0)), 0.3, np.stack([x, 0 * x + 1.0], axis=1), 0.04)
    cylinder = Cylinder(centre=(0.0, 5.0), radius=4.0)
    contact = OutlineContact(
        "roller", ("top",), cylinder, force_controlled=True, slides=True, counter=counter, modulus=1.0
    )
    friction, elasticity = FullSliding(contact, 0.5), Elasticity(RUBBER)
    problem = Problem(body, PlaneStrain(), [elasticity, contact, friction], supports=[FixedEdges(("bottom",))])
    problem.fields[contact.travel_name].vec[0] = 0.01 if counter is None else 0.01 + counter.at(np.zeros(1)).item()
    problem.set_loads({"roller slip": 0.0})
    advance(problem, {"roller force [N]": 0.05})
    return problem, contact, friction, elasticity


def test_a_uniformly_worn_surface_only_comes_nearer():
    problem, contact, *_ = block_under_cylinder(None)
    before, travel = contact.profile().nominal_pressure, problem.fields[contact.travel_name].vec[0]
    worn = WornProfile(0.1).worn(np.array([[-3.0, 3.0]]), np.full((1, 2), 0.01))
    problem, contact, *_ = block_under_cylinder(worn)
    assert problem.fields[contact.travel_name].vec[0] - travel == pytest.approx(0.01, rel=2e-2)
    assert contact.profile().nominal_pressure == pytest.approx(before, abs=5e-3 * before.max())


def test_both_bodies_lose_what_the_law_wears_and_a_refused_jump_leaves_no_trace():
    motion = Motion(amplitude=0.05, wear_rate=1e-3, counter_wear_rate=5e-4, places=2)
    fretting = Fretting(*block_under_cylinder(WornProfile(0.04)), motion, JumpControl(0.01, cycles=64))
    unworn = fretting.scar()
    fretting.advance(100)
    assert fretting.work.retries > 0
    fretting.advance(fretting.cycles + 4)
    scar = fretting.scar()
    path = 4 * (motion.amplitude - fretting.drag) * fretting.cycles
    assert scar.area == pytest.approx(fretting.worn, rel=1e-11)
    assert scar.area == pytest.approx(motion.wear_rate * path * 0.05, rel=0.02)
    assert scar.counter.area == pytest.approx(fretting.counter_worn, rel=1e-12)
    assert scar.counter.area == pytest.approx(0.5 * scar.area, rel=2e-2)
    part, counter, _ = draw_scars([unworn, scar]).axes
    assert len(part.lines) == len(counter.lines) == 1
    assert part.lines[0].get_ydata().max() == pytest.approx(1e3 * scar.depth.max())
    assert counter.lines[0].get_ydata().max() == pytest.approx(1e3 * scar.counter.depth.max())
