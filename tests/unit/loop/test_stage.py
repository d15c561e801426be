"""What a scene becomes on a mesh."""

import numpy as np
import pytest

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.body import Body
from ngwear.geometry.outline import Outline
from ngwear.loop.element_sizes import coarse_for_mounting, with_mounting_lengths
from ngwear.loop.first_cycle import first_cycle
from ngwear.loop.mounting import unworn_body
from ngwear.loop.refinement import mounting_field
from ngwear.loop.stage import Stage
from ngwear.loop.state import State
from ngwear.loop.stepper import Stepper
from ngwear.materials import NeoHooke
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Support
from ngwear.scene.contact import Contact
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.read_scene import read_scene
from ngwear.scene.scene import Scene
from ngwear.surfaces import Plane
from ngwear.wear.jump_control import JumpControl


def test_surface_under_force_finds_several_ridges_of_one_height():
    """The three nearest points of the outline are then three tips, not one tip and what is beside it."""
    top = [(x, 1.05 if k % 2 else 1.0) for k, x in enumerate(np.linspace(1.8, 0.2, 7))]
    outline = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), *top, (0.0, 1.0)]
    names = ("bottom", "right", *(("top",) * 8), "left")
    plane = Plane(point=(0.0, 1.05), normal_vector=(0.0, -1.0))
    scene = Scene(
        name="three ridges",
        part=Part(
            Outline(np.array(outline), names, np.ones(len(outline), dtype=bool)),
            material=NeoHooke(shear=1.0, bulk_modulus=100.0),
        ),
        contacts=(Contact(name="lid", edges=("top",), surface=plane, force=0.2, refine=True),),
        supports=(Support(edges=("bottom",)),),
        program=Program(cycle=(Stroke(name="stroke", travel=1.0),), strokes=1),
        accuracy=Accuracy(patch=0.05, coarse=0.3, mounting=0.05),
        axisymmetric=False,
    )
    state = Stepper(scene).start()
    contact = state.stage.contacts["lid"]
    assert abs(contact.force()[1] + 0.2) < 1e-8
    assert len(contact.profile().zones()) == 3


def test_scene_without_friction_has_the_unknowns_and_the_solver_of_elasticity_and_contact(tmp_path, write_sheet):
    scene = read_scene(write_sheet(tmp_path, ("friction = 0.1", "friction = 0.0")))
    (spec,) = scene.contacts
    body = Body(scene.part.outline, mounting_field(scene))
    contact = OutlineContact(
        spec.name, spec.edges, spec.surface, force_controlled=True, modulus=scene.rubber.shear_modulus
    )
    terms = [Elasticity(scene.rubber), contact]
    by_hand = Problem(body, PlaneStrain(), terms, supports=[FixedEdges(("bottom",))])
    made = Stage(scene, body)
    assert made.frictions == {}
    assert made.problem.names == by_hand.names
    assert made.problem.space.ndof == by_hand.space.ndof
    assert made.problem.symmetric
    assert by_hand.symmetric
    made.first_touch()
    by_hand.state.vec.data = made.problem.state.vec
    assert made.problem.tangent().flags == by_hand.tangent().flags
    assert made.problem.solver.name == by_hand.solver.name


def test_a_part_mounted_anew_ends_where_it_ended_when_it_was_mounted_first():
    """Slip, fluid and loads of what was solved on the mesh before do not count."""
    scene = coarse_for_mounting(with_mounting_lengths(read_scene("geometries/o_ring/scene.toml")))
    state = State(Stage(scene, unworn_body(scene, 6.0)), [], JumpControl(0.01, cycles=1))
    first = first_cycle(state, lambda fraction: None, None)
    vectors = [phase.vector for phase in state.phases]
    stage = state.stage
    stage.begin(2.0 * vectors[-1])
    stage.let_fluid_pass(np.full((1, 2, 2), 1.0))
    again = first_cycle(state, lambda fraction: None, None)
    for forces, before in zip(again, first, strict=True):
        for name, force in before.items():
            assert forces[name] == pytest.approx(force, rel=1e-6, abs=1e-6)
    for phase, vector in zip(state.phases, vectors, strict=True):
        assert phase.vector == pytest.approx(vector, abs=1e-7)
