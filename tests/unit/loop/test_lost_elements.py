import re
from dataclasses import replace

import numpy as np
import pytest
from conftest import REMEMBERS

from ngwear.errors import GeometryError, MeshError, SceneError
from ngwear.explanation.explain import explain
from ngwear.geometry.cells import Fate
from ngwear.geometry.outline import polygon_area
from ngwear.laws.damage import Fatigue, MaximumPrincipalStress, Stresses, TensileNormalStress
from ngwear.loop import lost_elements
from ngwear.loop.run import GAVE_UP, run
from ngwear.loop.stepper import Stepper
from ngwear.loop.wear_step import WearStep
from ngwear.materials import NeoHooke
from ngwear.scene.boundary import Support
from ngwear.scene.deactivation import Deactivation, DistortionFilter
from ngwear.scene.program import Program
from ngwear.scene.read_scene import read_scene
from ngwear.verify.cell_blocks import grid, held
from ngwear.verify.material_book import torn_scene
from ngwear.verify.no_loss import scene

NOT_REPEATABLE = {"wall time [s]", "CPU time [s]", "peak memory [MB]"}
TABLE = """
[deactivation]
depth = 0.3
distortion = { corner_cosine = 0.95 }
damage = { criterion = "fatigue", critical = 5.0, exponent = 3.0 }
"""


@pytest.fixture
def read(tmp_path, write_sheet):
    """``read((old, new), ...)``: the sheet with a table [deactivation], pieces of the text replaced."""

    def read(*changes):
        file = write_sheet(tmp_path, ('step = "each"', 'step = "each"\nremesh = "never"\n' + TABLE), *changes)
        return read_scene(file)

    return read


def test_a_scene_file_says_what_is_lost_and_how(read):
    assert read().deactivation == Deactivation(
        depth=0.3,
        distortion=DistortionFilter(corner_cosine=0.95),
        damage=Fatigue(critical=5.0, exponent=3.0),
    )


def test_what_the_table_leaves_out_does_not_happen(read):
    bare = read(*[(line + "\n", "") for line in TABLE.splitlines()[3:]])
    assert bare.deactivation == Deactivation(depth=0.3)
    damage = 'damage = { criterion = "fatigue", critical = 5.0, exponent = 3.0 }'
    plain = read((damage, 'damage = { criterion = "tensile normal stress", critical = 4 }'))
    assert plain.deactivation.damage == TensileNormalStress(critical=4.0)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("depth = 0.3\n", "", "deactivation.depth = None: is missing"),
        ("depth = 0.3", 'depth = "thick"', "deactivation.depth = 'thick': must be a number"),
        ("depth = 0.3", "depth = -0.3", "deactivation.depth = -0.3: must be greater than 0 mm"),
        (
            "depth = 0.3",
            "depth = 0.05",
            "deactivation.depth = 0.05: must be at least one element thick (accuracy.patch",
        ),
        ("depth = 0.3", "depth = 0.3\nlayers = 2", "deactivation.layers = 2: unknown key; known here: ['damage', 'dep"),
        (
            "corner_cosine = 0.95",
            "corner_cosine = 1.0",
            "deactivation.distortion.corner_cosine = 1.0: must lie between",
        ),
        ("{ corner_cosine = 0.95 }", "0.95", "deactivation.distortion = 0.95: must be a table"),
        (
            "corner_cosine",
            "cosine",
            "deactivation.distortion.cosine = 0.95: unknown key; known here: ['corner_cosine']",
        ),
        ('"fatigue"', '"hoop"', "deactivation.damage.criterion = 'hoop': must be one of ['tensile normal stress', "),
        (
            'criterion = "fatigue", ',
            "",
            "deactivation.damage.criterion = None: must be one of ['tensile normal stress'",
        ),
        ('"fatigue"', "3", "deactivation.damage.criterion = 3: must be one of ['tensile normal stress', "),
        (", exponent = 3.0", "", "deactivation.damage.exponent = None: is missing"),
        ('"fatigue"', '"strain energy density"', "deactivation.damage.exponent = 3.0: unknown key; known here: ['crit"),
        ("critical = 5.0", "critical = 0", "deactivation.damage.critical = 0.0: must be greater than 0"),
        ("critical = 5.0", "critical = nan", "deactivation.damage.critical = nan: must be a finite number"),
        (
            'remesh = "never"',
            'remesh = "due"',
            "wear.remesh = 'due': must be 'never' in a scene that deactivates elements",
        ),
        ("1.0e-3", "0.0", "contact.specific_wear_rate = 0.0: at least one contact must wear: the layers"),
    ],
)
def test_a_mistake_in_the_file_is_told_with_place_value_and_remedy(read, old, new, told):
    with pytest.raises(SceneError, match=re.escape(told)):
        read((old, new))


def test_damage_that_is_no_table_is_told_by_example(read):
    with pytest.raises(SceneError, match=r"deactivation\.damage = 19\.0: must be a table, such as \{ criterion = "):
        read(('{ criterion = "fatigue", critical = 5.0, exponent = 3.0 }', "19.0"))


def test_a_deactivation_that_is_no_table_is_refused(read, tmp_path, write_sheet):
    with pytest.raises(SceneError, match=r"deactivation = True: must be a table \[deactivation\]"):
        read_scene(write_sheet(tmp_path, ("[scene]", "deactivation = true\n[scene]")))


def test_rubber_with_memory_is_refused(read):
    with pytest.raises(SceneError, match=r"material\.prony = .*rubber without memory: remove"):
        read(*REMEMBERS)


def test_rubber_that_would_tear_while_it_is_fitted_is_refused_with_the_place():
    weak = scene("implicit", damage=MaximumPrincipalStress(critical=0.01))
    with pytest.raises(SceneError, match=r"deactivation\.damage\.critical = 0\.01: the part would tear") as told:
        run(weak, figures=False)
    x, y = map(float, re.search(r"at \(([\d.]+), ([\d.]+)\) mm", str(told.value)).groups())
    assert 1.7 < y < 2.0, "in the layers"
    assert 2.0 < abs(x - 2.0) + 2.0 < 3.5
    assert "maximum principal stress" in str(told.value)
    reached = float(re.search(r"reaches ([\d.]+) of the critical value", str(told.value)).group(1))
    just = scene("implicit", damage=MaximumPrincipalStress(critical=0.0102 * reached))
    assert run(replace(just, program=Program(cycle=just.program.cycle, strokes=0)), figures=False).status == "completed"


NOTHING = MaximumPrincipalStress(critical=1e9)
BLOCK = grid(np.linspace(0, 3, 7), np.linspace(0, 2, 5))


def test_a_part_torn_off_its_support_is_reported():
    damage = MaximumPrincipalStress(critical=1.0)
    state = held(BLOCK, NeoHooke(shear=1.0, bulk_modulus=20.0), (Support(edges=("bottom",)),), damage)
    with pytest.raises(GeometryError, match=r"no support or no load: nothing of the edges \['bottom'\] is left"):
        lost_elements.deactivate(state, BLOCK, np.arange(24) < 6, Fate.TORN)


def test_a_support_of_which_something_is_left_holds_only_there():
    damage = MaximumPrincipalStress(critical=1.0)
    state = held(BLOCK, NeoHooke(shear=1.0, bulk_modulus=20.0), (Support(edges=("bottom",)),), damage)
    lost_elements.deactivate(state, BLOCK, np.arange(24) < 4, Fate.TORN)
    contour = state.contour
    on = contour.on(("bottom",))
    assert contour.lengths[on].sum() == pytest.approx(1.0)
    assert (contour.points[on, 1] == 0).all()


@pytest.mark.parametrize(
    ("tears", "told"),
    [
        (lambda x, y: np.abs(x - 1.5) < 0.4, "after stroke 2: the section is cut in two"),
        (lambda x, y: y < 0.6, "after stroke 2: the remaining section has no support or no load"),
    ],
    ids=["cut in two", "torn off"],
)
def test_a_run_that_loses_too_much_gives_up_with_the_state_before(monkeypatch, tears, told):
    """In the second stroke of its second cycle; its first one has torn something, too."""
    real = lost_elements.exhaustion

    def exhaustion(state, repeats):
        cells = state.stage.body.cells
        corners = np.where(cells.corners < 0, cells.corners[:, :1], cells.corners)
        x, y = cells.points[corners].mean(axis=1).T
        if state.strokes < 2:
            return real(state, repeats)
        torn = tears(x, y) if state.strokes == 3 else np.hypot(x - 0.55, y - 1.95) < 0.06
        seen.append(state.strokes)
        return np.where(cells.living & torn, 2.0, 0.0)

    seen = []
    monkeypatch.setattr(lost_elements, "exhaustion", exhaustion)
    result = run(scene("implicit", damage=MaximumPrincipalStress(critical=9.0)), throw=False, figures=False)
    assert result.status == GAVE_UP
    assert seen == [2, 2, 3], "torn, solved again, then too much"
    assert result.message.startswith(told)
    assert result.state.strokes == 2
    assert result.state.cells.living.all()
    assert result.state.ledger.removed == pytest.approx(result.state.ledger.worn, rel=1e-9)
    assert set(result.state.ledger.lost.values()) == {0.0}
    assert result.summary["area lost by tearing [mm^2]"] == 0.0


@pytest.mark.parametrize("sinks", [0.2, 0.45])
def test_what_a_wall_gains_or_loses_as_its_ends_are_merged_is_in_the_book(sinks):
    """Surface points beside a pit sink along its wall; beneath them there is its floor."""
    pit = BLOCK.without(np.arange(24) == 20, Fate.TORN)
    state = held(pit, NeoHooke(shear=1.0, bulk_modulus=20.0), (Support(edges=("bottom",)),), NOTHING)
    outline, points = state.contour, state.contour.points.copy()
    points[(points[:, 1] == 2.0) & np.isin(points[:, 0], (1.0, 1.5)), 1] -= sinks
    lost_elements.move_surface(state, outline, points)
    lost = sum(state.ledger.lost.values())
    merged = len(state.contour) < len(outline)
    assert merged == (sinks > 0.4)
    assert pit.area - state.cells.area == pytest.approx(outline.area - polygon_area(points) + lost, rel=1e-12)
    assert (lost != 0) == merged
    assert state.contour.area == pytest.approx(state.cells.area, rel=1e-12)


@pytest.mark.parametrize("places", [(1.0,), (1.0, 1.5)])
def test_wear_that_reaches_a_hole_opens_it(places):
    """A hole lies in the second layer, and the surface above it sinks to one of its corners, or to both."""
    holed = BLOCK.without(np.arange(24) == 14, Fate.TORN)
    assert len(holed.holes()) == 4
    state = held(holed, NeoHooke(shear=1.0, bulk_modulus=20.0), (Support(edges=("bottom",)),), NOTHING)
    outline, points = state.contour, state.contour.points.copy()
    points[(points[:, 1] == 2.0) & np.isin(points[:, 0], places), 1] -= 0.45
    lost_elements.move_surface(state, outline, points)
    lost = sum(state.ledger.lost.values())
    assert len(state.cells.holes()) == 0
    assert holed.area - state.cells.area == pytest.approx(outline.area - polygon_area(points) + lost, rel=1e-12)
    assert state.contour.area == pytest.approx(state.cells.area, rel=1e-12)


def close(first, second):
    for row, other in zip(first, second, strict=True):
        assert row.keys() == other.keys()
        for name in row.keys() - NOT_REPEATABLE:
            if isinstance(row[name], float):
                assert row[name] == pytest.approx(other[name], rel=1e-9, abs=1e-12), name
            else:
                assert row[name] == other[name], name


@pytest.fixture(scope="module")
def torn_whole():
    return run(torn_scene(), figures=False)


@pytest.mark.slow
@pytest.mark.parametrize("stop", [0, 3])
def test_interrupted_and_resumed_it_ends_as_uninterrupted(tmp_path, torn_whole, stop):
    """Before and after elements are lost by every cause."""
    torn, whole = torn_scene(), torn_whole
    assert min(whole.state.ledger.lost[fate] for fate in (Fate.TORN, Fate.DISTORTED, Fate.LOOSE)) > 0

    def interrupt(state):
        if state.strokes >= stop:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(torn, out=tmp_path / "out", figures=False, on_step=interrupt)
    parts = run(torn, out=tmp_path / "out", resume=True, figures=False)
    close(parts.recorder.rows, whole.recorder.rows)
    np.testing.assert_array_equal(parts.state.cells.fate, whole.state.cells.fate)
    np.testing.assert_allclose(parts.state.contour.points, whole.state.contour.points, rtol=0, atol=1e-9)


def on_large_elements(scene):
    """Elements of twice the size do where it does not matter which they are."""
    return replace(scene, accuracy=replace(scene.accuracy, patch=0.2, mounting=0.2))


def test_resumed_fatigue_goes_on_where_it_was(tmp_path):
    tiring = on_large_elements(scene("implicit", damage=Fatigue(critical=2.0, exponent=2.0)))
    tiring = replace(tiring, program=replace(tiring.program, strokes=4))
    whole = run(tiring, figures=False)

    def interrupt(state):
        if state.strokes >= 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(tiring, out=tmp_path / "out", figures=False, on_step=interrupt)
    parts = run(tiring, out=tmp_path / "out", resume=True, figures=False)
    assert whole.state.fatigue.max() > 0
    np.testing.assert_allclose(parts.state.fatigue, whole.state.fatigue, rtol=1e-9)


@pytest.mark.parametrize("stroke", [3, 4])
def test_a_cycle_that_is_taken_back_has_tired_nothing(monkeypatch, stroke):
    tiring = on_large_elements(scene("implicit", damage=Fatigue(critical=2.0, exponent=2.0)))
    real = WearStep.apply

    def take(self):
        if self.state.strokes == stroke:
            raise MeshError("too much")
        return real(self)

    monkeypatch.setattr(WearStep, "apply", take)
    result = run(tiring, throw=False, figures=False)
    assert result.status == GAVE_UP
    assert result.state.strokes == 2
    last = [report.loaded["stress xx, yy, xy [MPa]"] for report in result.state.reports]
    each = [tiring.deactivation.damage.exhaustion(Stresses(s, np.zeros(len(s)))) for s in last]
    np.testing.assert_allclose(result.state.fatigue, np.maximum(*each), rtol=1e-9)
    assert not result.state.strained.any()


def test_what_friction_tears_lies_near_the_contact():
    weak = MaximumPrincipalStress(critical=1e-3)
    near, everywhere = (scene("implicit", damage=replace(weak, critical=1e3), reach=reach) for reach in (0.15, None))
    used = []
    for one in (near, everywhere):
        state = Stepper(one).start()
        used.append(lost_elements.exhaustion(state, 1))
    profile = state.stage.contacts["cylinder"].profile()
    places, centres = profile.reference[profile.nominal_pressure > 0], state.cells.centres()
    distance = np.linalg.norm(centres[:, None] - places, axis=2).min(axis=1)
    np.testing.assert_allclose(used[0], np.where(distance <= 0.15, used[1], 0.0), rtol=1e-9)
    assert (used[1][distance > 0.15] > 0).any()


def test_a_reach_of_nothing_is_refused():
    with pytest.raises(SceneError, match=r"deactivation\.reach = 0\.0: must be greater than 0 mm, or be removed"):
        Deactivation(depth=0.3, reach=0.0)


def test_explain_says_what_may_be_lost():
    lost = explain(scene("implicit", damage=TensileNormalStress(critical=2.0), distortion=DistortionFilter()))
    told = lost["effects"]["elements that may be lost"]
    assert "0.3 mm deep" in told
    assert "corner cosine of 0.99" in told
    assert "the tensile normal stress exceeds 2" in told
    assert "elements that may be lost" not in explain(replace(scene(), deactivation=None))["effects"]


@pytest.mark.slow
def test_wear_passes_through_layers_and_loses_no_area():
    """Nodes that reach those beneath become one with them: the outline and the contact stay, the area is the law's."""
    base = scene("implicit")
    (spec,) = base.contacts
    deep = replace(
        base,
        contacts=(replace(spec, specific_wear_rate=60 * spec.specific_wear_rate),),
        wear=replace(base.wear, step="jump"),
    )
    whole = Stepper(deep).start().cells
    state = run(deep, figures=False).state
    assert np.bincount(state.cells.fate, minlength=5)[Fate.WORN] > 5
    assert len(state.contour) == len(whole.contour)
    assert whole.area - state.cells.area == pytest.approx(state.ledger.worn, rel=1e-9)
    assert (whole.contour.points - state.contour.points)[:, 1].max() > 0.12


@pytest.mark.parametrize(("depth", "told"), [(2.0, "more than the edge"), (5.0, "more than the edge")])
def test_layers_that_do_not_fit_are_a_mistake_in_the_scene(depth, told):
    thick = replace(scene(), deactivation=Deactivation(depth=depth))
    with pytest.raises(SceneError, match=rf"deactivation\.depth = {depth}: no such layers fit the section: .*{told}"):
        Stepper(thick).start()


def test_first_guesses_fold_no_element_that_wear_has_made_thin():
    """Half a side is worn in each step; it once ended with folded first guesses after six strokes."""
    base = scene("implicit", distortion=DistortionFilter())
    (spec,) = base.contacts
    fast = replace(
        base,
        contacts=(replace(spec, specific_wear_rate=1e-2),),
        program=Program(cycle=base.program.cycle, strokes=10),
    )
    result = run(fast, figures=False)
    assert result.state.work.retries == 0
    assert result.summary["maximum depth [mm]"] > 0.25
