"""What ``ngwear explain`` says of whole scenes."""

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
from conftest import REMEMBERS

from ngwear.cli import BAD_INPUT, OK, main
from ngwear.explanation import heat
from ngwear.explanation.assumptions import Assumed
from ngwear.explanation.contact_pressures import press
from ngwear.explanation.explain import explain
from ngwear.explanation.neglected_effects_pin import left_out as left_out_of_pin
from ngwear.explanation.text import lines
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.read_scene import read_scene

GEOMETRIES = Path(__file__).parents[3] / "geometries"
ONSET = "speed from which the flash temperature exceeds 10 K [mm/s]"


def with_speed(speed, back=False):
    extra = f"\nspeed = {speed}" + (
        f'\n\n[[program.stroke]]\nname = "back"\ndirection = -1\ntravel = 10.0\nspeed = {speed}' if back else ""
    )
    return ("travel = 10.0", f"travel = 10.0{extra}")


@pytest.fixture
def told(tmp_path, write_sheet):
    """``told((old, new), ...)``: what is said of the small scene with changes."""

    def tell(*changes):
        return explain(read_scene(write_sheet(tmp_path, *changes)))

    return tell


def test_every_absent_effect_has_numbers_and_a_verdict(told):
    found = told()
    assert found["left out"][:5] == ["viscosity", "stick-slip", "heat", "adhesion", "inertia"]
    assert list(found["absent"]) == found["left out"]
    for name, verdict in found["absent"].items():
        assert verdict["verdict"], name
        assert verdict["matters"] in (True, False, None)
        numbers = [value for key, value in verdict.items() if key not in ("verdict", "matters")]
        assert all(math.isfinite(value) for value in numbers), name
        assert numbers or name == "stick-slip"
    assert json.loads(json.dumps(dict(found), allow_nan=False)) == found


def test_unknowns_and_entries_are_the_problems_own(told, sheet):
    from ngwear.loop.mounting import unworn_body
    from ngwear.loop.stage import Stage

    found, problem = told(), Stage(sheet, unworn_body(sheet)).problem
    assert sum(found["unknowns"].values()) == problem.space.ndof
    assert sum(found["matrix entries"].values()) == problem.assemble().nze
    assert found["unknowns"]["contact 'roller'"] == found["unknowns on the mounting mesh"]["roller pressure"] + 1
    assert found["unknowns"]["friction at 'roller'"] == 0
    assert found["memory [MB]"]["hyperelasticity"] > 12 * found["matrix entries"]["hyperelasticity"] / 2**20
    assert set(found["effects"]) == set(found["memory [MB]"])


def test_solver_names_what_made_the_matrix_unsymmetric(told):
    assert "unsymmetric: friction at 'roller';" in told()["solver"]
    assert told(("friction = 0.1\n", ""))["solver"].startswith("LDLT")


def test_memory_brings_six_doubles_less_two_for_each_arm_and_stroke(told):
    found = told(*REMEMBERS)
    assert "viscosity" not in found["absent"]
    assert found["unknowns"]["memory"] == 0
    bytes_ = found["memory [MB]"]["memory"] * 2**20
    arms = sum(fate.endswith("kept") for fate in found["arms of the memory"].values())
    assert bytes_ % (8 * 4 * 12 * (arms + 1)) == 0, "twelve points in each triangle"


def test_without_a_speed_the_speed_that_would_matter_is_told(told):
    absent = told()["absent"]
    for name in ("heat", "inertia", "fluid film", "viscosity"):
        assert absent[name]["matters"] is None
        assert "no speed" in absent[name]["verdict"]
        assert any(key.startswith("speed ") for key in absent[name])


def test_flash_temperature_is_that_of_the_strips_of_one_mounting(tmp_path, write_sheet):
    scene = read_scene(write_sheet(tmp_path, with_speed(200.0)))
    (strip,) = press(scene).strips
    assert strip.load == pytest.approx(0.5, rel=0.1), "the roller's force, less friction's share"
    steel = Assumed(counter_conductivity=40.0)
    rise = heat.band_rise(0.1 * strip.pressure * 200.0, strip.width / 2, 200.0, 40.0, steel.counter_heat_capacity)
    found = explain(scene, assumed=steel)["absent"]["heat"]
    assert found["flash temperature [K]"] == pytest.approx(rise, rel=1e-6)
    assert found["frictional power [W/mm]"] == pytest.approx(0.1 * strip.load * 0.2, rel=1e-6)


def test_flash_temperature_matters_from_its_onset_on(told):
    onset = told()["absent"]["heat"][ONSET]
    below, above = (told(with_speed(round(f * onset, 1)))["absent"]["heat"] for f in (0.9, 1.1))
    assert above["matters"] is True
    assert "above 10 K" in above["verdict"]
    assert below["matters"] is not True
    assert below["flash temperature [K]"] < 10 < above["flash temperature [K]"]


def test_a_roller_that_nothing_cools_warms_as_a_whole(told):
    """0.1 of some 0.5 N/mm over 4e6 mm is 2e5 mJ/mm; the roller of 2 mm has 3.4 pi 4 = 42.7 mJ/(mm K)."""
    found = told(with_speed(10.0), ("strokes = 4", "strokes = 400000"))["absent"]["heat"]
    warm = found["warming of the counter-surface over the program if nothing cools it [K]"]
    assert warm == pytest.approx(2e5 / 42.7, rel=0.1)
    assert found["matters"] is None
    assert "this depends on the cooling" in found["verdict"]


def test_sticking_that_the_scene_forbids_matters(told):
    short = (
        with_speed(20.0, back=True),
        ("travel = 10.0", "travel = 0.1"),
        ("force = 0.5", "force = 0.5\nsticks = false"),
    )
    found = told(*short)["absent"]["stick-slip"]
    assert found["matters"] is True
    assert found["elastic slip at most over shortest stroke [-]"] == pytest.approx(2 * 0.1 * 2.0 / 0.1)
    assert told(with_speed(20.0, back=True))["absent"]["stick-slip"]["matters"] is False


def test_friction_and_wear_are_weighed_where_they_are_absent(told):
    found = told(("friction = 0.1\n", ""), ("specific_wear_rate = 1.0e-3\n", ""))
    assert found["left out"][-3:] == ["friction", "wear", "fluid pressure"]
    assert found["absent"]["heat"]["matters"] is False
    assert "no frictional heat" in found["absent"]["heat"]["verdict"]
    assert found["absent"]["wear"]["wear rate from which it counts [mm²/N]"] > 0


def test_a_part_that_cannot_be_mounted_is_still_explained(told):
    found = told(('[[support]]\nedges = ["bottom"]\n', ""))
    assert "the contact pressure is not known" in found["absent"]["adhesion"]["verdict"]
    assert found["absent"]["adhesion"]["matters"] is None
    assert found["unknowns"]["hyperelasticity"] > 0


def test_shipped_seals_text(seal):
    found = explain(replace(seal, accuracy=Accuracy.draft()))
    text = "\n".join(lines(found))
    assert "left out: viscosity, stick-slip, heat" in text
    assert "heat cannot be judged from the scene: the strokes have no speed" in text
    assert "friction at 'rod', fluid pressure" in text
    assert found["absent"]["adhesion"]["matters"] is False
    assert max(map(len, text.splitlines())) < 130


def test_pin_is_weighed_without_a_solve():
    scene = read_scene(GEOMETRIES / "pin_on_plate" / "scene.toml")
    verdicts = left_out_of_pin(scene, Assumed())
    assert list(verdicts) == ["wear", "stick-slip", "heat", "adhesion", "inertia", "fluid film"]
    assert verdicts["heat"].matters is None
    assert verdicts["heat"].numbers["frictional power at the fastest [W]"] == pytest.approx(0.06 * 100 * 1.036)
    slow = left_out_of_pin(replace(scene, speeds=(3.0,)), Assumed())
    assert slow["heat"].matters is False
    assert slow["fluid film"].matters is False
    fast = left_out_of_pin(replace(scene, speeds=(5000.0,)), Assumed())
    assert (fast["heat"].matters, fast["inertia"].matters) == (True, True)


def test_constants_are_told_and_taken_from_the_command_line(sheet_file, capsys):
    assert main(["explain", str(sheet_file), "--json", "--assume", "work_of_adhesion=1.0"]) == OK
    found = json.loads(capsys.readouterr().out)
    assert found["assumed"]["work of adhesion, clean and dry [J/m²]"] == 1000.0
    assert found["absent"]["adhesion"]["matters"] is None
    assert main(["explain", str(sheet_file), "--assume", "stickiness=1"]) == BAD_INPUT
    assert "known: ['counter_conductivity'" in capsys.readouterr().err
