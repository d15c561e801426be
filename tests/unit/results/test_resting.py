"""Where a part with room to move rests, and that it does not come back."""

from dataclasses import replace

import numpy as np
import pytest

import ngwear as nw
from ngwear.loop.run import run
from ngwear.results.resting import TURNED, elsewhere, resting, rests

SIDE = "rests along x on [-]"


@pytest.fixture(scope="module")
def scene():
    """A ring between a rod and two walls; its size is 3.53 mm."""
    return nw.read_scene("geometries/o_ring/scene.toml")


def rows(scene, *cycles):
    """Rows of the series: for each cycle the wall and angle in both kinds of stroke, and the depth."""
    kinds = [stroke.name for stroke in scene.program.cycle]
    return [
        {
            "stroke [-]": 2 * k,
            "kind [-]": kind,
            SIDE: wall,
            TURNED: turned,
            "maximum depth [mm]": depth,
        }
        for k, (depth, *states) in enumerate(cycles)
        for kind, (wall, turned) in zip(kinds, states, strict=True)
    ]


def test_the_wall_that_pushes_most_is_where_it_rests(scene):
    forces = {contact.name: np.zeros(2) for contact in scene.contacts} | {"hoop": np.array([0.0, 5.0])}
    assert resting(scene, forces, 1.5) == {SIDE: "nothing", TURNED: 1.5}
    forces["air wall"] = np.array([2.0, 0.0])
    assert resting(scene, forces, 0.0)[SIDE] == "air wall"


def test_a_part_that_is_held_rests_nowhere():
    assert resting(nw.read_scene("geometries/rod_seal/scene.toml"), {}, 0.0) == {}


def test_a_part_may_move_over_in_each_cycle(scene):
    there = rows(scene, *[(d, ("air wall", 3.0), ("sealed wall", -3.0)) for d in (0.0, 0.01, 0.02)])
    assert rests(scene, there) == {
        "outward, rests along x on": "air wall",
        "inward, rests along x on": "sealed wall",
        "first stroke that moves the part along x": 0,
    }
    assert elsewhere(scene, there) == []


def test_one_that_is_at_another_wall_in_the_same_stroke_has_snapped(scene):
    there = rows(
        scene,
        (0.0, ("air wall", 0.0), ("air wall", 0.0)),
        (0.01, ("air wall", 0.5), ("sealed wall", 0.5)),
        (0.02, ("air wall", 0.6), ("air wall", 0.6)),
    )
    (told,) = elsewhere(scene, there)
    assert told.startswith("stroke 'inward': from stroke 0 to 2 the part moves from 'air wall' to 'sealed wall', which")


def test_the_largest_turn_that_wear_does_not_explain_is_told(scene):
    ways = [(0.0, 0.0), (0.01, 1.9), (0.02, 4.9), (0.03, 12.0), (0.04, 12.5)]
    (told,) = elsewhere(scene, rows(scene, *[(d, ("air wall", 0.0), ("air wall", turn)) for d, turn in ways]))
    assert told.startswith("stroke 'inward': from stroke 4 to 6 the part turns by 7.1 degrees, which so little wear")
    worn = [(10 * depth, ("air wall", 0.0), ("air wall", turn)) for depth, turn in ways]
    assert elsewhere(scene, rows(scene, *worn)) == []


def test_a_ring_that_stays_has_no_such_warning(ring):
    result = run(replace(ring, program=replace(ring.program, strokes=4)), progress=False, figures=False)
    assert not [warning for warning in result.summary["warnings"] if "does not explain" in warning]
