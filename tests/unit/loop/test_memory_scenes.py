"""Scenes with memory: from TOML to a run, and back from a checkpoint."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from conftest import ARMS, REMEMBERS, edited

from ngwear.cli import OK, main
from ngwear.equilibrium.linear import has_pardiso
from ngwear.errors import ConvergenceError, SceneError
from ngwear.geometry.outline import Outline
from ngwear.loop.run import run
from ngwear.loop.stepper import Stepper
from ngwear.loop.wear_step import WearStep
from ngwear.materials import WLF, NeoHooke, PronySeries, Stiffened
from ngwear.materials.library import filled_rubber
from ngwear.scene.boundary import Support
from ngwear.scene.read_scene import read_scene
from ngwear.surfaces import bore

SHIFT = 'shift = { law = "wlf", c1 = 17.44, c2 = 51.6, reference = 296.15 }'
WARMER = "temperature = 303.15\n"
BARE = ((SHIFT + "\n", ""), (WARMER, ""))


def arms_text(*changes):
    return edited(ARMS, changes)


def lifted(contour, height):
    return Outline(contour.points + np.array([0.0, height]), contour.names, contour.corners)


@pytest.fixture
def remembering(tmp_path, write_sheet):
    """The small scene with memory."""
    return read_scene(write_sheet(tmp_path, *REMEMBERS))


@pytest.fixture
def read_arms(tmp_path, write_sheet):
    """``read_arms(text)``: the scene with this text for its arms."""

    def read(text):
        (arms, speed) = REMEMBERS
        return read_scene(write_sheet(tmp_path, (arms[0], "bulk_modulus = 100.0" + text), speed))

    return read


def test_arms_are_read_and_shifted(remembering):
    factor = WLF(17.44, 51.6, 296.15).factor(303.15)
    assert remembering.part.prony.ratios == (0.5, 0.4, 0.3)
    assert remembering.part.prony.times == pytest.approx([0.1 * factor, factor, 10 * factor])
    assert remembering.program.cycle[0].duration == pytest.approx(0.5)
    assert remembering.program.duration == pytest.approx(2.0)


def test_moduli_relative_to_the_instantaneous_stiffness_or_absolute(read_arms):
    shares = read_arms(arms_text(*BARE, ('"long-term"', '"instantaneous"'), ("[0.5, 0.4, 0.3]", "[0.3, 0.2, 0.1]")))
    assert shares.part.prony.ratios == pytest.approx((0.75, 0.5, 0.25))
    absolute = read_arms(arms_text(*BARE, ('"long-term"', '"absolute"\nlong_term = 2.0')))
    assert absolute.part.prony.ratios == pytest.approx((0.25, 0.2, 0.15))


@pytest.mark.parametrize("compound", ["filled rubber", "NBR"])
def test_compound_of_the_library(read_arms, compound):
    scene = read_arms(f'\n[material.prony]\ncompound = "{compound}"\n')
    assert scene.part.prony == filled_rubber().prony
    cold = read_arms(f'\n[material.prony]\ncompound = "{compound}"\ntemperature = 283.15\n')
    assert cold.part.prony.times[0] > 2 * scene.part.prony.times[0]


def test_smoothed_arms_are_three_a_decade(read_arms):
    scene = read_arms('\n[material.prony]\ncompound = "NBR"\nsmoothing = 0.05\n')
    assert len(scene.part.prony.times) == 27


BAD = {
    "negative modulus": ([("0.4", "-0.4")], "material.prony.moduli[1]", -0.4, "greater than 0"),
    "modulus nan": ([("0.4", "nan")], "material.prony.moduli[1]", None, "finite"),
    "zero time": ([("1.0,", "0,")], "material.prony.times[1]", 0.0, "greater than 0"),
    "time twice": ([("1.0,", "0.1,")], "material.prony.times", 0.1, "given twice"),
    "unsorted": ([("10.0", "0.5")], "material.prony.times", 0.5, "sort"),
    "a time missing": ([("0.1, ", "")], "material.prony", (3, 2), "one modulus for each time"),
    "no times": ([("[0.1, 1.0, 10.0]", "[]")], "material.prony.times", [], "list of numbers"),
    "moduli text": ([("[0.5, 0.4, 0.3]", '"soft"')], "material.prony.moduli", "soft", "list of numbers"),
    "modulus text": ([("0.4", '"soft"')], "material.prony.moduli[1]", "soft", "must be a number"),
    "no moduli": ([("moduli", "modulus")], "material.prony.modulus", None, "unknown key.*'moduli'"),
    "no reference": ([('reference = "long-term"\n', "")], "material.prony.reference", None, "is missing"),
    "reference": ([("long-term", "short")], "material.prony.reference", "short", "long-term.*instantaneous.*absolute"),
    "no long-term modulus": ([("long-term", "absolute")], "material.prony.long_term", None, "is missing"),
    "long-term modulus": (
        [('"long-term"', '"absolute"\nlong_term = 0')],
        "material.prony.long_term",
        0.0,
        "greater than 0 MPa",
    ),
    "needless long-term modulus": (
        [('"long-term"', '"long-term"\nlong_term = 1')],
        "material.prony.long_term",
        1,
        "absolute",
    ),
    "shares": ([("long-term", "instantaneous")], "material.prony.moduli", [0.5, 0.4, 0.3], "below 1"),
    "at the pole": ([("303.15", "244.55")], "material.prony.temperature", 244.55, "glass.*in K"),
    "below the pole": ([("303.15", "30")], "material.prony.temperature", 30.0, "glass.*in K"),
    "just above the pole": ([("303.15", "244.6")], "material.prony.temperature", 244.6, "glass.*in K"),
    "no shift": ([(SHIFT, "")], "material.prony.temperature", 303.15, "needs a .material.prony.shift. table"),
    "shift without temperature": ([(WARMER, "")], "material.prony.temperature", None, "is missing"),
    "shift text": ([(SHIFT, 'shift = "wlf"')], "material.prony.shift", "wlf", "must be a table"),
    "law": ([('"wlf"', '"vft"')], "material.prony.shift.law", "vft", "wlf.*arrhenius"),
    "law's key": ([("c2", "c3")], "material.prony.shift.c3", 51.6, "unknown key.*'c2'"),
    "law's value": ([("17.44", "-17.44")], "material.shift.c1", -17.44, "greater than 0"),
    "smoothing": ([(WARMER, WARMER + "smoothing = 0.9\n")], "material.prony.smoothing", 0.9, "must lie between"),
    "hot as absolute zero": (
        [(SHIFT, 'shift = { law = "arrhenius", activation_energy = 5e4, reference = 296 }'), ("303.15", "0")],
        "material.prony.temperature",
        0.0,
        "greater than 0 K",
    ),
    "degrees Celsius": (
        [(SHIFT, 'shift = { law = "arrhenius", activation_energy = 5e4, reference = 296 }'), ("303.15", "23")],
        "material.prony.temperature",
        23.0,
        "in K",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_mistaken_arms_are_refused_with_place_value_and_remedy(read_arms, case):
    changes, place, value, remedy = BAD[case]
    with pytest.raises(SceneError, match=remedy) as found:
        read_arms(arms_text(*changes))
    assert found.value.place == place
    if value is not None:
        assert found.value.value == value


@pytest.mark.parametrize(
    ("text", "place", "remedy"),
    [
        ('\n[material.prony]\ncompound = "gum"\n', "material.prony.compound", "known: 'filled rubber', EPDM"),
        ("\n[material.prony]\ncompound = 3\n", "material.prony.compound", "text in quotes"),
        ('\n[material.prony]\ncompound = "NBR"\nmoduli = [1]\n', "material.prony.moduli", "unknown key"),
        ('\n[material.prony]\ncompound = "NBR"\ntemperature = 20\n', "material.prony.temperature", "in K"),
        ("\nprony = 5\n", "material.prony", "must be a table"),
    ],
)
def test_mistaken_compound_is_refused(read_arms, text, place, remedy):
    with pytest.raises(SceneError, match=remedy) as found:
        read_arms(text)
    assert found.value.place == place


def test_memory_asks_for_the_speed_of_every_stroke(tmp_path, write_sheet):
    with pytest.raises(SceneError, match=r"stroke'.speed = None: rubber with memory needs the stroke's speed"):
        read_scene(write_sheet(tmp_path, REMEMBERS[0]))
    with pytest.raises(SceneError, match=r"speed = -2.0: must be greater than 0 mm/s"):
        read_scene(write_sheet(tmp_path, ("travel = 10.0", "travel = 10.0\nspeed = -2")))
    with pytest.raises(SceneError, match=r"program.rest = 0.0: must be greater than 0 s"):
        read_scene(write_sheet(tmp_path, ("strokes = 4", "strokes = 4\nrest = 0")))


def test_arms_outside_of_the_window_are_folded_within_the_bound(remembering):
    arms = PronySeries((0.5, 0.5, 0.5, 0.5), (1e-6, 0.2, 2.0, 1e9))
    scene = replace(
        remembering, part=replace(remembering.part, prony=arms), program=replace(remembering.program, rest=1e3)
    )
    assert scene.folding.fast == (1e-6,)
    assert scene.folding.slow == (1e9,)
    assert scene.folding.bound < 1e-3
    assert isinstance(scene.rubber, Stiffened)
    assert scene.rubber.shear_modulus == pytest.approx(1.5 * scene.part.material.shear_modulus)
    assert scene.arms.ratios == pytest.approx((0.5 / 1.5, 0.5 / 1.5))
    relaxed = replace(scene, program=replace(scene.program, rest=math.inf))
    assert relaxed.folding.slow == (), "a part that has relaxed for ever holds no spring of the slow arms"
    assert relaxed.rubber is scene.part.material
    exact = replace(scene, accuracy=replace(scene.accuracy, folding_error=0.0))
    assert exact.arms == arms


def test_memory_that_folds_away_altogether_is_no_memory(remembering):
    scene = replace(remembering, part=replace(remembering.part, prony=PronySeries((0.5,), (1e-6,))))
    assert scene.arms is None
    assert Stepper(scene).start().memory is None


def test_stiffened_material_is_a_multiple():
    soft = NeoHooke(shear=1.5, bulk_modulus=1000.0)
    hard = Stiffened(material=soft, factor=3.0, bulk_modulus=1000.0)
    assert hard.isochoric_energy(3.5, 3.6) == pytest.approx(3 * soft.isochoric_energy(3.5, 3.6))
    assert np.array(hard.isochoric_slopes(3.5, 3.6)) == pytest.approx(3 * np.array(soft.isochoric_slopes(3.5, 3.6)))
    assert (hard.shear_modulus, hard.bulk_modulus) == (4.5, 1000.0)
    with pytest.raises(SceneError, match="greater than 0"):
        Stiffened(material=soft, factor=0.0, bulk_modulus=1000.0)


@pytest.fixture(scope="module")
def ends(tmp_path_factory, write_sheet):
    """Runs of the small scene without and with memory."""
    folder = tmp_path_factory.mktemp("ends")
    scenes = [read_scene(write_sheet(folder / name, *how)) for name, how in (("elastic", ()), ("memory", REMEMBERS))]
    return [run(scene, figures=False) for scene in scenes]


def test_arms_too_weak_to_matter_change_nothing(remembering, ends):
    """The memory's own machinery adds no error of its own."""
    weak = replace(remembering, part=replace(remembering.part, prony=PronySeries((1e-9, 1e-9), (0.3, 3.0))))
    weak = replace(weak, accuracy=replace(weak.accuracy, folding_error=0.0))
    with_arms, without = run(weak, figures=False).summary, ends[0].summary
    assert with_arms["worn area [mm^2]"] == pytest.approx(without["worn area [mm^2]"], rel=1e-7)


def test_under_a_constant_force_memory_hardly_changes_the_worn_area(ends):
    """Under a given force the worn area is the law's, whatever the rubber; its depth and width are not."""
    without, with_arms = (end.summary for end in ends)
    assert with_arms["worn area [mm^2]"] == pytest.approx(without["worn area [mm^2]"], rel=5e-3)
    assert with_arms["maximum depth [mm]"] != pytest.approx(without["maximum depth [mm]"], rel=1e-4)


def test_forces_of_a_ring_with_memory_are_in_balance(remembering):
    """The hoop tension is that of all effects; what the held edge carries acts along the axis."""
    ring = replace(
        remembering,
        axisymmetric=True,
        contacts=(replace(remembering.contacts[0], surface=bore(9.9), force=None),),
        supports=(Support(edges=("left",), y=False),),
        part=replace(remembering.part, outline=lifted(remembering.part.outline, 3.0)),
    )
    stepper = Stepper(ring)
    state = stepper.advance(stepper.start())
    forces = state.reports[0].forces
    assert abs(forces["hoop"][1]) > 1.0
    total = sum(force[1] for force in forces.values())
    assert total == pytest.approx(0.0, abs=1e-6 * abs(forces["hoop"][1]))


@pytest.mark.skipif(not has_pardiso(), reason="only PARDISO (the extra 'fast') repeats itself bit for bit")
def test_stopped_and_resumed_memory_is_the_same_to_the_last_bit(tmp_path, remembering, ends):
    whole = ends[1]

    def stop(state):
        if state.strokes == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(remembering, out=tmp_path / "out", on_step=stop, figures=False)
    resumed = run(remembering, out=tmp_path / "out", resume=True, figures=False)
    assert (resumed.state.memory.relaxed == whole.state.memory.relaxed).all()
    assert (resumed.state.contour.points == whole.state.contour.points).all()


def test_rejected_step_leaves_the_memory_alone(remembering, monkeypatch):
    stepper = Stepper(remembering)
    state = stepper.advance(stepper.start())
    relaxed, stresses = state.memory.relaxed.copy(), [s.copy() for s in state.memory.stresses]

    def fail(*_, **__):
        raise ConvergenceError("for the test")

    monkeypatch.setattr(WearStep, "apply", fail)
    with pytest.raises(ConvergenceError):
        stepper.advance(state)
    assert (state.memory.relaxed == relaxed).all()
    assert all((a == b).all() for a, b in zip(state.memory.stresses, stresses, strict=True))


def test_explain_lists_arms_and_what_became_of_them(tmp_path, write_sheet, capsys):
    changes = (("[0.5, 0.4, 0.3]", "[0.5, 0.4, 0.3, 0.2]"), ("[0.1,", "[1e-6, 0.1,"))
    (arms, speed) = REMEMBERS
    file = write_sheet(tmp_path, (arms[0], "bulk_modulus = 100.0" + arms_text(*BARE, *changes)), speed)
    assert main(["explain", str(file), "--json"]) == OK
    told = json.loads(capsys.readouterr().out)
    assert "viscosity" not in told["left out"]
    assert "3 arms kept; 1 left out as always relaxed" in told["effects"]["memory"]
    assert "tau/D = 2: kept" in told["arms of the memory"]["1 s"]
    assert "relaxes at once" in told["arms of the memory"]["1e-06 s"]
    assert 0 < told["numbers"]["largest error of stress by arms left out [-]"] < 1e-3
    assert main(["explain", str(file)]) == OK
    assert "arms of the memory:" in capsys.readouterr().out
