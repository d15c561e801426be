"""A part with room to move finds the wall that stops it; the forces balance; a part that nothing stops is refused."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import ngwear as nw
from ngwear.equilibrium import attempts
from ngwear.errors import ConvergenceError
from ngwear.geometry.outline import Outline
from ngwear.loop import stepper, stroke_solve
from ngwear.loop.run import run
from ngwear.loop.stepper import Stepper
from ngwear.scene.holding import free_directions
from ngwear.surfaces import Plane

ROOM, PRESSURE, HEIGHT = 0.2, 0.3, 1.0  # mm, MPa, mm


def block(*, walls=("left", "right"), strokes=2, pressures=(PRESSURE, PRESSURE)):
    """A block on a slippery table with room to two walls; the fluid presses on its right side."""
    outline = Outline.rectangle((0.0, 2.0), (0.0, HEIGHT))
    places = {"left": Plane(point=(-ROOM, 0.0), normal_vector=(1.0, 0.0))}
    places["right"] = Plane(point=(2.0 + ROOM, 0.0), normal_vector=(-1.0, 0.0))
    contacts = [nw.Contact(f"{w} wall", edges=[w], surface=places[w], slides=False, refine=True) for w in walls]
    cycle = [
        nw.Stroke(name, direction=way, travel=1.0, pressure=p)
        for name, way, p in zip(("out", "in"), (-1, 1), pressures, strict=True)
    ]
    return nw.Scene(
        "block",
        nw.Part(outline, material=nw.NeoHooke(shear=1.0, bulk_modulus=100.0)),
        contacts=contacts,
        axisymmetric=False,
        supports=[nw.Support(edges=["bottom"], x=False)],
        fluid=nw.Fluid(edges=["right"], inlet=["right"]) if "right" not in walls else None,
        program=nw.Program(strokes=strokes, cycle=cycle),
        accuracy=nw.Accuracy(patch=0.2, coarse=0.5, mounting=0.2),
    )


def test_the_fluid_moves_the_block_to_the_wall_which_carries_all_of_it():
    scene = block(walls=("left",))
    assert free_directions(scene) == (0,)
    result = run(scene, figures=False)
    last = result.records.rows[-1]
    assert last["rests along x on [-]"] == "left wall"
    # The dead end of a straight side: p times its height, which the pressure itself compresses in y (no support there).
    assert last["left wall force x [N/mm]"] == pytest.approx(-last["fluid force x [N/mm]"], rel=1e-6)
    assert last["left wall force x [N/mm]"] > 0.9 * PRESSURE * HEIGHT
    assert result.summary["out, rests along x on"] == "left wall"
    assert all("no contact stops it" in warning for warning in result.summary["warnings"]), "it is free above and below"


def test_it_stays_where_it_is_if_nothing_drives_it():
    scene = block(walls=("left",), pressures=(0.0, 0.0))
    result = run(scene, figures=False)
    assert result.records.rows[-1]["rests along x on [-]"] == "nothing"
    assert np.abs(result.state.stage.problem.state.vec.FV().NumPy()).max() < 1e-9


def test_springs_are_no_force():
    """The residual has no share of the springs, wherever the part is."""
    stepper = Stepper(block(walls=("left",)))
    problem = stepper.start().stage.problem
    term = problem.terms[-1]
    problem.state.vec.FV().NumPy()[:] += 1e-3 * np.random.default_rng(0).standard_normal(problem.space.ndof)
    with_springs, without = problem.state.vec.CreateVector(), problem.state.vec.CreateVector()
    problem.residual(with_springs)
    term.strength.Set(0.0)
    problem.residual(without)
    rounding = 1e-14 * np.abs(without.FV().NumPy()).max()
    assert np.abs(with_springs.FV().NumPy() - without.FV().NumPy()).max() <= rounding


def test_what_nothing_stops_is_refused():
    scene = block(walls=("left",))
    away = nw.Fluid(edges=["left"], inlet=["left"])  # drives the block to the right, where no wall is
    with pytest.raises(ConvergenceError, match="nothing holds the part along x"):
        Stepper(replace(scene, fluid=away)).start()


def walls_at(scene, left, right):
    """The scene with its walls at these places."""
    ones, others = scene.contacts
    places = (ones, left), (others, right)
    return replace(scene, contacts=[replace(wall, surface=replace(wall.surface, point=(x, 0.0))) for wall, x in places])


def test_a_part_is_held_by_walls_that_squeeze_it():
    """Walls that only touch it may lose it when it deforms."""
    scene = block(strokes=2, pressures=(0.0, 0.0))
    assert free_directions(scene) == free_directions(walls_at(scene, 0.0, 2.0)) == (0,)
    assert free_directions(walls_at(scene, 0.01, 1.99)) == free_directions(walls_at(scene, 0.0, 1.99)) == ()


def test_a_cylinder_is_pressed_by_a_force_between_two_plates():
    """Hertz: p0 = sqrt(F E* / (pi R)). A surface under force holds nothing where it is drawn."""
    force, radius, rubber = 0.3, 1.0, nw.NeoHooke(shear=1.0, bulk_modulus=1000.0)
    angle = np.linspace(0.0, 2 * np.pi, 65)[:-1]
    points = np.column_stack([radius * np.cos(angle), radius * (1 + np.sin(angle))])
    plates = (
        nw.Contact("low", surface=nw.Plane(point=(0.0, 0.0), normal_vector=(0.0, 1.0)), slides=False),
        nw.Contact("high", surface=nw.Plane(point=(0.0, 1.7), normal_vector=(0.0, -1.0)), slides=False, force=force),
    )
    scene = nw.Scene(
        "cylinder between plates",
        nw.Part(nw.Outline(points, ["skin"] * 64, [False] * 64), material=rubber),
        contacts=plates,
        axisymmetric=False,
        program=nw.Program(strokes=1, cycle=[nw.Stroke("rest", direction=0, travel=1.0)]),
        accuracy=nw.Accuracy.preset("engineering"),
    )
    assert free_directions(scene) == (0, 1)
    summary = run(scene, figures=False).summary
    exact = np.sqrt(force * rubber.plane_strain_modulus / (np.pi * radius))
    for name in ("low", "high"):
        assert summary[f"last rest {name} peak pressure [MPa]"] == pytest.approx(exact, rel=0.02)
    assert summary["warnings"] == []


@pytest.mark.parametrize("folder", ["rod_seal", "shaft_on_plate", "starving_lubrication", "torn_seal"])
def test_shipped_parts_are_held(folder):
    assert free_directions(nw.read_scene(f"geometries/{folder}/scene.toml")) == ()


def fails(state):
    raise ConvergenceError("no equilibrium")


@pytest.mark.slow
def test_a_ring_follows_the_load_steps_of_its_last_cycle(monkeypatch):
    """Where one step to the pressed ring fails, later cycles find it without a search of their own."""
    monkeypatch.setattr(attempts, "_round_off", lambda problem, relative: False)  # with rounded laws it does not fail
    monkeypatch.setattr(stepper, "settle_carried", fails)  # nor from states carried over
    monkeypatch.setattr(stroke_solve, "_stays", lambda state, index, work: False)  # nor from its end in the last cycle
    scene = nw.read_scene("geometries/o_ring/scene.toml")
    ring = Stepper(replace(scene, accuracy=nw.Accuracy.preset("engineering")))
    state = ring.start()
    for phase in state.phases:
        fractions = [fraction for fraction, _ in phase.path]
        assert fractions == sorted(fractions)
        assert fractions[-1] == 1.0
        np.testing.assert_array_equal(phase.path[-1][1], phase.vector)


def test_a_file_without_accuracy_takes_the_preset_if_the_part_has_room_to_move(tmp_path):
    text = Path("geometries/o_ring/scene.toml").read_text(encoding="utf-8")
    bare = text[: text.index("[accuracy]")].replace(
        '"contour.toml"', f"'{Path('geometries/o_ring/contour.toml').resolve()}'"
    )
    (tmp_path / "bare.toml").write_text(bare, encoding="utf-8")
    assert nw.read_scene(tmp_path / "bare.toml").accuracy == nw.Accuracy.preset("engineering")
    (tmp_path / "given.toml").write_text(bare + "[accuracy]\npatch = 0.02\n", encoding="utf-8")
    assert nw.read_scene(tmp_path / "given.toml").accuracy == nw.Accuracy(patch=0.02)
