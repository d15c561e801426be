from dataclasses import replace

import numpy as np
import pytest

from ngwear.error_estimates.coarser_runs import scaled
from ngwear.errors import SceneError
from ngwear.loop.element_sizes import with_contact_lengths, with_mounting_lengths
from ngwear.loop.run import run
from ngwear.loop.stepper import Stepper
from ngwear.scene.accuracy import ALIKE, PRESETS, Accuracy
from ngwear.scene.options import Wear
from ngwear.scene.read_scene import read_scene
from ngwear.verify.no_loss import scene

GIVEN = replace(scene("implicit"), deactivation=None, wear=Wear())


def of(across, **more):
    return replace(GIVEN, accuracy=Accuracy(across=across, **more))


def test_lengths_are_given_unless_something_else_is():
    plain = Accuracy()
    assert (plain.patch, plain.coarse, plain.mounting) == (0.01, 0.2, 0.03)
    assert (plain.stress_error, plain.wear_error, plain.longest_jump) == (0.05, 0.02, 0.1)
    assert Accuracy(across=6).patch is None
    assert Accuracy(error=0.01).wear_error is None


def test_tolerances_go_along_with_the_elements_across():
    default, across = Accuracy(), Accuracy(across=ALIKE)
    assert across.wear_error == default.wear_error
    assert default.depth_error == 1.0, "lengths say nothing of it"
    half = Accuracy(across=ALIKE / 2)
    assert half.stress_error == 4 * across.stress_error
    assert half.depth_error == 2 * across.depth_error
    assert half.wear_error == 2 * across.wear_error
    assert half.longest_jump == 2 * across.longest_jump
    assert Accuracy(across=3).wear_error == Accuracy(across=1).wear_error == 0.05
    given = Accuracy(across=6, wear_error=0.1)
    assert (given.wear_error, given.longest_jump) == (0.1, 0.5)
    assert replace(half, order=3) == Accuracy(across=ALIKE / 2, order=3)


def test_elements_grow_faster_from_fewer_elements_across_unless_it_is_said_how():
    gradings = [Accuracy(across=across).grading for across in (24, 12, 6, 2, 1)]
    assert gradings == [pytest.approx(0.30, abs=0.01), 0.4, 0.5, 0.5, 0.5]
    assert Accuracy().grading == 0.25
    assert Accuracy(across=6).with_tolerances_of(Accuracy()).grading == 0.25
    assert Accuracy().with_across(6) == Accuracy(across=6)
    assert Accuracy(grading=0.3).with_across(6).grading == 0.3
    assert Accuracy(error=0.01).with_across(2) == Accuracy(across=2)


@pytest.mark.parametrize("across", [48.0, 16.0, 8.0, 2.0])
def test_a_companion_has_fewer_elements_across(across):
    fine = of(across)
    coarse = scaled(fine, 2.0)
    tolerance = coarse.accuracy.wear_error
    assert coarse == of(across / 2, wear_error=tolerance, longest_jump=5 * tolerance)
    assert tolerance == 2 * fine.accuracy.wear_error  # also where a run of its own has no looser one
    assert scaled(scaled(fine, 2.0), 2.0) == scaled(fine, 4.0)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"across": 0.1}, "must lie between 0.5 and 200 elements"),
        ({"across": 300.0}, "must lie between 0.5 and 200 elements"),
        ({"across": 6.0, "patch": 0.1}, r"sets \['patch'\] too: give only one"),
        ({"error": 0.01, "across": 6.0, "wear_error": 0.1}, r"lets the run choose \['wear_error', 'across'\]"),
        ({"error": 0.01, "patch": 0.1}, r"lets the run choose \['patch'\]: give only one"),
        ({"error": 1.0}, "must be below 1; 0.01 is one per cent"),
        ({"error": 1e-5}, "is below 0.001, the smallest error"),
        ({"error": -0.01}, "is below 0.001"),
        ({"error": float("nan")}, "must be below 1"),
        ({"longest_jump": 0.0}, "must lie between 0 and 1"),
        ({"depth_error": 0.0}, "accuracy.depth_error = 0.0: must lie between 0 and 1"),
        ({"error": 0.01, "depth_error": 0.1}, r"lets the run choose \['depth_error'\]"),
    ],
)
def test_what_contradicts_itself_is_refused(given, told):
    with pytest.raises(SceneError, match=told):
        Accuracy(**given)


def test_presets_have_names():
    found = [Accuracy.draft(), Accuracy.engineering(), Accuracy.reference()]
    assert found == [Accuracy.preset(name) for name in PRESETS]
    assert sorted(a.across for a in found) == [a.across for a in found]
    with pytest.raises(SceneError, match=r"accuracy.preset = 'rough': must be one of \['draft', 'engineering'"):
        Accuracy.preset("rough")


@pytest.mark.parametrize(
    ("table", "told"),
    [
        ('preset = "draft"', None),
        ('preset = "fine"', r"accuracy.preset = 'fine': must be one of"),
        ("preset = 3", "accuracy.preset = 3: must be a text"),
        ('preset = "draft"\npatch = 0.1', "accuracy.patch = 0.1: is set by the preset 'draft': give only one"),
        ('preset = "draft"\nerror = 0.01', "accuracy.error = 0.01: is set by the preset 'draft': give only one"),
        ('preset = "draft"\nfine = 1', "accuracy.fine = 1: unknown key; known here"),
        ("across = 6", None),
        ('across = "six"', "accuracy.across = 'six': must be a number"),
        ("error = 0.02", None),
        ("error = 1e-9", "is below 0.001"),
    ],
)
def test_a_scene_file_says_it(sheet_file, table, told):
    path = sheet_file
    lines = path.read_text().split("[accuracy]")
    rest = lines[1].partition("\n[")
    path.write_text(f"{lines[0]}[accuracy]\n{table}\n{rest[1]}{rest[2]}")
    if told is None:
        assert read_scene(path).accuracy.patch is None
        return
    with pytest.raises(SceneError, match=told):
        read_scene(path)


def test_a_scene_with_lengths_is_laid_out_as_it_is():
    assert with_mounting_lengths(GIVEN) is GIVEN
    out = with_mounting_lengths(of(6.0)).accuracy
    height = np.ptp(GIVEN.part.outline.points, axis=0).min()
    assert out.across is None
    assert out.patch == out.mounting == pytest.approx(0.04 * height)
    assert out.coarse > out.mounting


@pytest.mark.parametrize("across", [8.0, 16.0])
def test_the_contacts_are_so_many_elements_across(across):
    """Also after wear has spread them; a mesh that is finer, as the mounting's, is kept."""
    stepper = Stepper(of(across))
    state = stepper.start()
    while True:
        contact = state.stage.contacts[state.stage.scene.followed[0].name]
        zones = contact.profile().zones()
        (widest,) = [zone.nodes for zone in zones]
        elements = len(widest) - 1
        assert across / 1.6 <= elements
        if state.ledger.remeshes:
            assert elements <= 1.6 * across + 1
        if stepper.finished(state):
            break
        state = stepper.advance(state)


def test_chosen_leaves_alone_what_bears_nothing():
    state = Stepper(of(4.0)).start()
    stage = state.stage
    nothing = np.zeros_like(state.phases[0].vector)
    assert with_contact_lengths(stage, [nothing], 4.0) is stage.scene
    vectors = [state.phases[0].vector]
    found = with_contact_lengths(stage, vectors, 10.0).accuracy.patch
    assert with_contact_lengths(stage, vectors, 20.0).accuracy.patch == pytest.approx(found / 2)
    few = with_contact_lengths(stage, vectors, 0.5).accuracy
    assert few.coarse == few.mounting == few.patch == pytest.approx(20 * found), (
        "elsewhere no finer than in the contact"
    )


@pytest.mark.slow
def test_presets_agree_within_what_they_are_for():
    """Worn depth of a draft within 5 %, of engineering within 2 % of sixteen elements across, over 40 strokes."""
    many = replace(GIVEN.program, strokes=40)
    found = {
        across: run(replace(of(across), program=many), figures=False).summary["maximum depth [mm]"]
        for across in (PRESETS["draft"], PRESETS["engineering"], 16.0)
    }
    assert found[PRESETS["draft"]] == pytest.approx(found[16.0], rel=0.05)
    assert found[PRESETS["engineering"]] == pytest.approx(found[16.0], rel=0.02)


def test_lost_elements_need_a_length():
    from ngwear.scene.deactivation import Deactivation

    given = scene("implicit")
    losing = {"deactivation": Deactivation(depth=0.2), "wear": replace(given.wear, remesh="never")}
    for accuracy in (Accuracy(across=6.0), Accuracy(error=0.01)):
        with pytest.raises(SceneError, match=r"give accuracy\.patch in mm"):
            replace(given, accuracy=accuracy, **losing)
