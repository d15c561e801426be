"""Scenes whose friction may stick: which are, and what that does to wear and heat."""

import csv

import numpy as np
import pytest

from ngwear.errors import SceneError
from ngwear.explanation.explain import explain
from ngwear.loop.run import COMPLETED, run
from ngwear.loop.stepper import Stepper
from ngwear.scene.read_scene import read_scene

MU, FORCE, RATE = 0.3, 0.5, 1e-3
ONCE = 'name = "stroke"\ntravel = 10.0\n'


def to_and_fro(travel):
    strokes = [f'name = "{name}"\ntravel = {travel}\ndirection = {sign}\n' for name, sign in (("out", 1), ("back", -1))]
    return ONCE, "\n[[program.stroke]]\n".join(strokes)


def scene(folder, write_sheet, *changes):
    return read_scene(write_sheet(folder, ("friction = 0.1", f"friction = {MU}"), *changes))


@pytest.mark.parametrize(
    ("changes", "sticks", "why"),
    [
        ((), False, "direction of sliding never changes"),
        ((to_and_fro(10.0),), False, "the shortest stroke is 10 mm, an elastic slip about 1.2 mm at most"),
        ((to_and_fro(0.1),), True, "the shortest stroke is 0.1 mm"),
        ((to_and_fro(10.0), ("force = 0.5", "force = 0.5\nsticks = true")), True, "as the scene asks"),
        ((to_and_fro(0.1), ("force = 0.5", "force = 0.5\nsticks = false")), False, "as the scene asks"),
        ((("specific_wear_rate = 1.0e-3", "slides = false\nrefine = true"),), True, "does not slide"),
    ],
)
def test_which_friction_sticks_and_why(tmp_path, write_sheet, changes, sticks, why):
    told = explain(scene(tmp_path, write_sheet, *changes))
    words = told["effects"]["friction at 'roller'"]
    assert words.startswith("stick and slip" if sticks else "full sliding")
    assert why in words
    assert ("stick-slip" in told["left out"]) is not sticks
    assert any("traction" in name for name in told["unknowns on the mounting mesh"]) is sticks


def rows(folder):
    with (folder / "out" / "series.csv").open(encoding="utf-8") as file:
        return [float(row["roller friction heat of the stroke [mJ/mm]"]) for row in csv.DictReader(file)]


def worn(folder, write_sheet, travel):
    sticks = ("force = 0.5", "force = 0.5\nsticks = true")
    sticking = scene(folder, write_sheet, to_and_fro(travel), sticks, ("strokes = 4", "strokes = 2"))
    result = run(sticking, out=folder / "out", figures=False)
    assert result.status == COMPLETED
    return result


@pytest.mark.slow
def test_short_strokes_wear_what_slips_only_and_long_ones_nearly_all(tmp_path, write_sheet):
    shares, heats = [], []
    for k, travel in enumerate((0.02, 5.0)):
        (tmp_path / str(k)).mkdir()
        result = worn(tmp_path / str(k), write_sheet, travel)
        shares.append(result.summary["worn area [mm^2]"] / (RATE * FORCE * 2 * travel))
        heats.append(rows(tmp_path / str(k))[-1] / (MU * FORCE * travel))
    assert 0 <= shares[0] < 0.5, "the middle sticks"
    assert 0.9 < shares[1] < 1.01, "but for the elastic deflection of a few hundredths of a millimetre"
    assert 0 <= heats[0] < 0.5
    assert 0.9 < heats[1] < 1.01


def test_surface_that_stands_still_holds_what_touches_it(tmp_path, write_sheet):
    """A plate below: by its friction the bottom hardly moves along it, and the friction stays below its limit."""
    moved = []
    for k, friction in enumerate((1.0, 0.0)):
        plate = (
            '[[support]]\nedges = ["bottom"]\n',
            f'[[contact]]\nname = "plate"\nedges = ["bottom"]\nslides = false\nfriction = {friction}\n'
            'surface = { type = "plane", point = [0.0, 0.0], normal = [0.0, 1.0] }\n'
            '[[support]]\nedges = ["left", "right"]\n',
        )
        (tmp_path / str(k)).mkdir()
        stage = Stepper(scene(tmp_path / str(k), write_sheet, plate)).start().stage
        profile = stage.contacts["plate"].profile()
        moved.append(np.abs(profile.place - profile.reference)[:, 0].max())
        if friction > 0:
            traction = stage.contacts["plate"].edge_values(stage.problem.fields["plate traction 1"])
            limit = stage.contacts["plate"].end_pressures().mean(axis=1)
            assert (np.abs(traction) < limit).all(), "it sticks everywhere"
    assert moved[0] < 0.2 * moved[1]


@pytest.mark.parametrize(
    ("change", "place"),
    [
        (("force = 0.5", "force = 0.5\nslides = false"), "specific_wear_rate.*does not slide"),
        (("specific_wear_rate = 1.0e-3", "slides = false\nsticks = false"), "sticks.*does not slide"),
        (("force = 0.5", 'force = 0.5\nsticks = "yes"'), "sticks.*true or false"),
    ],
)
def test_contradictions_are_refused(tmp_path, write_sheet, change, place):
    with pytest.raises(SceneError, match=place):
        scene(tmp_path, write_sheet, change)
