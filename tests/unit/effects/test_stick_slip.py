"""Friction that sticks and slips: limits that need no reference."""

import numpy as np
import pytest

from ngwear.effects.contact import OutlineContact
from ngwear.effects.contact_patch import PatchContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.friction import FullSliding
from ngwear.effects.stick_slip import StickSlip
from ngwear.equilibrium.attempts import solve
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance, relax
from ngwear.errors import SceneError
from ngwear.fields.kinematics import Axisymmetric, PlaneStrain, Solid
from ngwear.geometry.outline import Outline
from ngwear.geometry.sheet import Sheet
from ngwear.materials import MooneyRivlin
from ngwear.surfaces import Plane, Sphere
from ngwear.verify.builders import meshed

RUBBER = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1000.0)
MU = 0.4
STEPS = StepOptions(first=0.25)


def pressed(kinematics, friction, *, force=0.8):
    """A block 4 x 2 under a plane that is pressed on by a force, N/mm or N."""
    inner = 10.0 if kinematics.axisymmetric else 0.0
    body = meshed(Outline.rectangle((0.0, 4.0), (inner, inner + 2.0)), 0.4)
    lid = Plane(point=(0.0, inner + 2.0), normal_vector=(0.0, -1.0))
    contact = OutlineContact("lid", ("top",), lid, force_controlled=True, modulus=RUBBER.shear_modulus)
    term = friction(contact, MU)
    problem = Problem(body, kinematics, [Elasticity(RUBBER), contact, term], supports=[FixedEdges(("bottom",))])
    problem.fields[contact.travel_name].vec[0] = 0.02
    scale = 2 * np.pi * inner if kinematics.axisymmetric else 1.0
    load = {"lid force [N]": force * scale}
    if friction is FullSliding:
        problem.set_loads({"lid slip": 0.0})
    advance(problem, load, STEPS)
    return problem, contact, term


@pytest.mark.parametrize("kinematics", [PlaneStrain(), pytest.param(Axisymmetric(), marks=pytest.mark.slow)])
def test_far_travel_ends_in_full_sliding_and_back_again(kinematics):
    problem, contact, sticks = pressed(kinematics, StickSlip)
    other, _, slides = pressed(kinematics, FullSliding)
    for sign in (1.0, -1.0):
        advance(problem, {"lid travel [mm]": 2.0 * sign}, STEPS)
        advance(other, {"lid slip": sign}, STEPS)
        assert sticks.force() == pytest.approx(slides.force(), rel=1e-3, abs=1e-6)
        assert abs(sticks.force()[0]) == pytest.approx(MU * abs(contact.force()[1]), rel=1e-6)


def test_small_travel_sticks_and_returns_to_where_it_was():
    problem, _, sticks = pressed(PlaneStrain(), StickSlip)
    before, rest = problem.state.vec.FV().NumPy().copy(), sticks.force()[0]
    advance(problem, {"lid travel [mm]": 1e-3}, STEPS)
    moved = sticks.force()[0]
    assert 0 < abs(moved - rest) < 0.2 * MU * 0.8
    advance(problem, {"lid travel [mm]": 0.0}, STEPS)
    assert sticks.force()[0] == pytest.approx(rest, abs=0.1 * abs(moved - rest)), "a little slips at the rims"
    u = problem.part("displacement")
    assert np.median(np.abs(problem.state.vec.FV().NumPy()[u] - before[u])) < 1e-2 * 1e-3


def test_friction_never_exceeds_its_limit_nor_helps_the_slip():
    problem, contact, sticks = pressed(PlaneStrain(), StickSlip)
    start = problem.get_loads()["lid travel [mm]"]
    advance(problem, {"lid travel [mm]": start + 0.1}, STEPS)
    pressure = contact.end_pressures().mean(axis=1)
    traction = contact._sample(problem.fields[sticks.tractions[0]])[:, 0]
    assert (np.abs(traction) <= MU * np.maximum(pressure, 0) * (1 + 1e-6) + 1e-9).all()
    assert 0 < abs(sticks.force()[0]) <= MU * abs(contact.force()[1]) * (1 + 1e-9)


def test_a_node_beside_an_edge_that_sticks_does_not_slip():
    _, contact, _ = pressed(PlaneStrain(), StickSlip)
    edges = contact.profile().edges
    slip = np.linspace(0.5, 1.5, len(edges))
    slip[: len(edges) // 2] = 0.0
    at_nodes = contact.edges_to_nodes(slip)
    stuck = np.unique(edges[slip == 0])
    assert (at_nodes[stuck] < 1e-12).all()
    beyond = np.setdiff1d(edges, stuck)
    assert len(beyond) > 2
    assert (at_nodes[beyond] > 0.9).all()
    contact.set_share(at_nodes)
    assert contact.sample_middles(contact.share) == pytest.approx(at_nodes[edges].mean(axis=1), abs=1e-12)


def test_state_that_is_not_committed_leaves_no_trace():
    problem, _, sticks = pressed(PlaneStrain(), StickSlip)
    start = problem.state.vec.FV().NumPy().copy()
    forces = []
    for _ in range(2):
        problem.state.vec.FV().NumPy()[:] = start
        problem.set_loads({"lid travel [mm]": 0.05})
        assert solve(problem).converged
        forces.append(sticks.force()[0])
    assert forces[0] == pytest.approx(forces[1], rel=1e-9)


def test_a_way_out_of_a_bad_guess_lets_nothing_slip():
    """The guess is dragged far beyond the limit; what sticks from the start to the goal has not been there."""
    problem, _, sticks = pressed(PlaneStrain(), StickSlip)
    vector, forces = problem.state.vec.FV().NumPy(), []
    start = vector.copy()
    for travel in (0.05, 0.005):
        vector[:] = start
        problem.set_loads({"lid travel [mm]": travel})
        assert solve(problem).converged
        forces.append(sticks.force()[0])
        if travel == 0.05:
            guess = vector.copy()
    vector[:] = guess
    work = relax(problem, StepOptions(first=0.25))
    assert work.solves > 1
    assert sticks.force()[0] == pytest.approx(forces[1], rel=1e-4)
    assert abs(forces[1]) < 0.5 * abs(forces[0])


@pytest.mark.slow
def test_ball_on_a_sheet_slips_from_its_rim_and_then_altogether():
    ticks = np.arange(-1.6, 1.7, 0.8)
    places = np.stack(np.meshgrid(ticks, ticks), axis=-1).reshape(-1, 2)
    seeds = np.column_stack([places, np.full(len(places), 3.0)])
    size = {"thickness": 3.0, "reach": 4.0, "beside": 4.0, "coarse": 3.0}
    sheet = Sheet(track_radius=np.inf, seeds=seeds, sizes=np.full(len(seeds), 0.8), **size)
    ball = Sphere(centre=(0.0, 0.0, 8.0), radius=5.0)
    contact = PatchContact("ball", ("top",), ball, modulus=RUBBER.shear_modulus)
    sticks = StickSlip(contact, MU)
    problem = Problem(sheet, Solid(), [Elasticity(RUBBER), contact, sticks], supports=[FixedEdges(("bottom",))])
    advance(problem, {"ball approach [mm]": 0.3}, STEPS)
    assert abs(sticks.force()[0]) < 0.02 * MU * contact.force()[2] * -1
    shares = []
    for travel in (0.05, 0.5):
        advance(problem, {"ball travel [mm]": travel}, STEPS)
        shares.append(sticks.force()[0] / (MU * -contact.force()[2]))
    assert 0.1 < shares[0] < 0.9, "partly stuck"
    assert shares[1] == pytest.approx(1.0, abs=0.03), "all of it slides, on a slope of a few degrees"
    assert abs(sticks.force()[1]) < 0.02 * sticks.force()[0]


def test_negative_coefficient_is_refused():
    with pytest.raises(SceneError, match=r"lid\.friction.*-0\.1.*at least 0"):
        StickSlip(OutlineContact("lid", ("top",), Plane(point=(0, 0), normal_vector=(0, 1)), modulus=1.0), -0.1)
