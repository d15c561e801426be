import math
from dataclasses import replace

import numpy as np
import pytest

from ngwear.effects.base import DISPLACEMENT, VOLUMETRIC_STRESS
from ngwear.errors import SceneError
from ngwear.geometry.cells import Fate
from ngwear.laws.damage import (
    CRITERIA,
    Fatigue,
    MaximumPrincipalStress,
    StrainEnergyDensity,
    Stresses,
    TensileNormalStress,
)
from ngwear.loop import lost_elements
from ngwear.loop.stepper import Stepper
from ngwear.materials import NeoHooke
from ngwear.scene.boundary import Support
from ngwear.scene.deactivation import DistortionFilter
from ngwear.scene.options import Wear
from ngwear.scene.program import Program
from ngwear.scene.read_deactivation import read_deactivation
from ngwear.verify import no_loss
from ngwear.verify.cell_blocks import grid, held, on_edge, pull

# Cauchy stresses xx, yy, xy [MPa] and the principal stress by hand.
STATES = {
    "pulled along x": ((3.0, 1.0, 0.0), 3.0),
    "pulled along y": ((-2.0, 5.0, 0.0), 5.0),
    "sheared": ((0.0, 0.0, 2.0), 2.0),
    "pulled and sheared": ((4.0, -2.0, 4.0), 6.0),
    "pressed": ((-1.0, -3.0, 0.0), -1.0),
    "pressed and sheared": ((-5.0, -5.0, -3.0), -2.0),
}
RUBBER = NeoHooke(shear=1.5, bulk_modulus=20.0)


def scene(scheme, **deactivation):
    """The block under its cylinder, of elements of twice the size."""
    block = no_loss.scene(scheme, **deactivation)
    return replace(block, accuracy=replace(block.accuracy, patch=0.2, mounting=0.2))


@pytest.mark.parametrize(("cauchy", "principal"), STATES.values(), ids=STATES)
def test_criteria_by_hand(cauchy, principal):
    stresses = Stresses(np.array([cauchy]), np.array([0.3]))
    assert TensileNormalStress(critical=2.0).exhaustion(stresses) == pytest.approx([max(cauchy[:2]) / 2])
    assert MaximumPrincipalStress(critical=4.0).exhaustion(stresses) == pytest.approx([principal / 4])
    assert StrainEnergyDensity(critical=0.2).exhaustion(stresses) == pytest.approx([1.5])
    used = Fatigue(critical=8.0, exponent=3.0).exhaustion(stresses)
    assert used == pytest.approx([max(principal / 8, 0.0) ** 3])


def test_means_over_a_length_by_hand():
    """Four elements in a row, 1 apart, the last of three times the area: neighbours count within a length of 2."""
    centres, areas = np.array([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0)]), np.array([1.0, 1.0, 1.0, 3.0])
    stresses = Stresses(
        np.array([[4.0, 0, 0], [1.0, 0, 3.0], [1.0, 0, 0], [5.0, 2.0, 0]]), np.array([1.0, 3.0, 2.0, 6.0])
    )
    wide = stresses.averaged(centres, areas, 2.0)
    np.testing.assert_allclose(wide.cauchy[:, 0], [5 / 2, 6 / 3, 17 / 5, 16 / 4])
    np.testing.assert_allclose(wide.cauchy[:, 2], [3 / 2, 3 / 3, 3 / 5, 0.0])
    np.testing.assert_allclose(wide.energy, [2.0, 2.0, 23 / 5, 5.0])
    np.testing.assert_array_equal(stresses.averaged(centres, areas, 1.9).cauchy, stresses.cauchy)


def test_each_criterion_has_its_name_and_only_fatigue_adds_up():
    assert {name: kind.accumulates for name, kind in CRITERIA.items()} == {
        "tensile normal stress": False,
        "maximum principal stress": False,
        "strain energy density": False,
        "fatigue": True,
    }
    for name, asked in (("fatigue", {"exponent": 2.0}), ("maximum principal stress", {})):
        table = {"criterion": name, "critical": 3.0} | asked
        assert read_deactivation({"depth": 1.0, "damage": table}).damage == CRITERIA[name](critical=3.0, **asked)


def test_unknown_criteria_and_impossible_values_are_refused():
    with pytest.raises(SceneError, match=r"deactivation\.damage\.criterion = 'hoop stress': must be one of \['tensile"):
        read_deactivation({"depth": 1.0, "damage": {"criterion": "hoop stress", "critical": 1.0}})
    with pytest.raises(SceneError, match=r"deactivation\.damage\.critical = 0\.0: must be greater than 0"):
        StrainEnergyDensity(critical=0.0)
    with pytest.raises(SceneError, match=r"deactivation\.damage\.length = 0\.0: must be greater than 0 mm, or"):
        StrainEnergyDensity(critical=1.0, length=0.0)
    with pytest.raises(SceneError, match=r"deactivation\.damage\.exponent = -1\.0: must be greater than 0"):
        Fatigue(critical=1.0, exponent=-1.0)


def block(damage, cells=None):
    cells = grid(np.linspace(0, 3, 7), np.linspace(0, 2, 5)) if cells is None else cells
    return held(cells, RUBBER, (Support(edges=("bottom", "top")),), damage)


def test_stresses_of_a_homogeneous_deformation_are_cauchys():
    state = block(MaximumPrincipalStress(critical=1.0))
    stage = state.stage
    f = np.array([[1.2, 0.3], [0.1, 0.95]])
    j = np.linalg.det(f)
    stage.body.set_nodal(stage.problem.fields[DISPLACEMENT], stage.body.node_places() @ (f - np.eye(2)).T)
    stage.problem.fields[VOLUMETRIC_STRESS].vec[:] = stage.elasticity.split[1] * (j - 1)
    found = lost_elements.stresses(stage)
    b, i1 = f @ f.T, np.sum(f * f) + 1
    by_hand = 1.5 * j ** (-5 / 3) * (b - i1 / 3 * np.eye(2)) + 20.0 * (j - 1) * np.eye(2)
    expected = [by_hand[0, 0], by_hand[1, 1], by_hand[0, 1]]
    np.testing.assert_allclose(found.cauchy, np.tile(expected, (24, 1)), rtol=1e-10)
    energy = 0.75 * (j ** (-2 / 3) * i1 - 3) + 10.0 * (j - 1) ** 2
    np.testing.assert_allclose(found.energy, energy, rtol=1e-10)
    highest = np.linalg.eigvalsh(by_hand)[-1]
    np.testing.assert_allclose(lost_elements.exhaustion(state, 1), highest, rtol=1e-10)


def merged():
    """A block in whose middle a surface point has been merged: two of its elements have become triangles."""
    cells = grid(np.linspace(0, 3, 7), np.linspace(0, 2, 5))
    top = np.flatnonzero((cells.points == (1.5, 2.0)).all(axis=1))
    points = cells.points[cells.rim].copy()
    points[cells.rim == top, 1] = 1.5
    return cells.moved(points).merged(top)


def test_what_tires_an_element_is_its_own_stress():
    """Also where elements have become triangles, which the mesh has last."""
    damage = Fatigue(critical=5.0, exponent=2.0)
    state = block(damage, merged())
    cells, body = state.stage.body.cells, state.stage.body
    assert not (np.sort(body.numbers) == body.numbers).all(), "otherwise nothing is tested"
    pull(state, "top", 0.1)
    state.fatigue, state.strained = np.zeros(len(cells.fate)), np.zeros(len(cells.fate))
    lost_elements.add_fatigue(state, 1, last=False)
    stress = lost_elements.loaded(state.stage)["stress xx, yy, xy [MPa]"]
    np.testing.assert_allclose(state.strained, damage.exhaustion(Stresses(stress, np.zeros(len(stress)))), rtol=1e-12)
    assert not state.fatigue.any()
    lost_elements.add_fatigue(state, 3, last=True)
    np.testing.assert_allclose(
        state.fatigue, 3 * damage.exhaustion(Stresses(stress, np.zeros(len(stress)))), rtol=1e-12
    )
    assert not state.strained.any()


def test_triangles_that_wear_has_left_of_the_layers_are_torn_others_are_not():
    cells = merged()
    others = replace(cells, layers=cells.quads)
    for made, torn in ((cells, np.ones(24, dtype=bool)), (others, cells.quads)):
        state = block(MaximumPrincipalStress(critical=1e-3), made)
        pull(state, "top", 0.1)
        used = lost_elements.exhaustion(state, 1)
        stress = lost_elements.loaded(state.stage)["stress xx, yy, xy [MPa]"]
        principal = Stresses(stress, np.zeros(len(stress))).principal
        np.testing.assert_allclose(used, np.where(torn, 1e3 * principal, 0.0), rtol=1e-12)


def test_the_highest_stress_of_a_cycle_counts_as_often_as_it_is_repeated():
    state = block(Fatigue(critical=5.0, exponent=2.0))
    pull(state, "top", 0.1)
    state.fatigue, state.strained = np.full(24, 0.25), np.zeros(24)
    present = lost_elements.exhaustion(state, 1) - 0.25
    assert (present > 0).all()
    np.testing.assert_allclose(lost_elements.exhaustion(state, 3), 0.25 + 3 * present, rtol=1e-12)
    state.strained = np.where(np.arange(24) < 12, 2.0, 0.5) * present
    expected = 0.25 + 3 * np.where(np.arange(24) < 12, 2.0, 1.0) * present
    np.testing.assert_allclose(lost_elements.exhaustion(state, 3), expected, rtol=1e-12)


def test_nothing_is_torn_below_the_criterion_and_the_state_is_left_alone():
    state = block(MaximumPrincipalStress(critical=1e3))
    pull(state, "top", 0.1)
    stage, vector = state.stage, state.phases[0].vector.copy()
    assert not lost_elements.tear(state, state.contour, 1)
    assert state.stage is stage
    np.testing.assert_array_equal(state.phases[0].vector, vector)
    assert state.ledger.lost[Fate.TORN] == 0.0


def test_what_is_left_keeps_its_state():
    """Displacements of every vertex that is left, and they are near to the equilibrium without the lost element."""
    state = block(MaximumPrincipalStress(critical=1e3))
    pull(state, "top", 0.1)

    def displaced():
        stage = state.stage
        u = state.phases[0].vector[stage.problem.part(DISPLACEMENT)].reshape(2, -1)[:, : stage.body.mesh.nv].T
        return dict(zip(stage.body.vertices.tolist(), u.tolist(), strict=True))

    before = displaced()
    dead = np.arange(24) == 12  # at the left side, in the third row
    lost_elements.deactivate(state, state.stage.body.now, dead, Fate.TORN)
    after = displaced()
    assert len(after) == len(before)
    assert all(after[point] == before[point] for point in after)
    assert state.ledger.lost[Fate.TORN] == pytest.approx(0.25)
    assert len(on_edge(state.stage.body, "top")) == 7


def tired(strokes, **options):
    """The small block under its cylinder, hardly worn, and what each cycle has left of it."""
    base = scene("implicit", damage=Fatigue(exponent=2.0, **options))
    (spec,) = base.contacts
    contacts = (replace(spec, specific_wear_rate=1e-12),)
    base = replace(base, contacts=contacts, program=Program(cycle=base.program.cycle, strokes=strokes))
    stepper = Stepper(base)
    state, found = stepper.start(), []
    while not stepper.finished(state):
        state = stepper.advance(state)
        stresses = [report.loaded["stress xx, yy, xy [MPa]"] for report in state.reports[-2:]]
        found.append((state.fatigue.copy(), stresses, state.cells))
    return found


def test_fatigue_adds_up_over_cycles_by_the_highest_stress_of_each():
    cycles = tired(6, critical=2.0)
    for number, (fatigue, stresses, cells) in enumerate(cycles, start=1):
        each = [Fatigue(critical=2.0, exponent=2.0).exhaustion(Stresses(s, np.zeros(len(s)))) for s in stresses]
        assert (each[0] > 1.1 * each[1]).any(), "forth and back strain different elements"
        assert (each[1] > 1.1 * each[0]).any()
        np.testing.assert_allclose(fatigue, number * np.maximum(*each), rtol=1e-6, atol=1e-9)
        assert cells.living.all()


def test_fatigue_tears_in_the_cycle_in_which_life_is_used_up():
    fatigue, _, cells = tired(2, critical=2.0)[0]
    used = fatigue[cells.quads].max()
    critical = 2.0 * math.sqrt(used / 0.4)  # now 0.4 a cycle: 0.8 after two, torn in the third
    cycles = tired(6, critical=critical)
    torn = [np.flatnonzero(after.fate == Fate.TORN) for _, _, after in cycles]
    assert cycles[1][0][cells.quads].max() == pytest.approx(0.8, rel=1e-6)
    assert [len(those) > 0 for those in torn] == [False, False, True]
    assert np.argmax(np.where(cells.quads, fatigue, 0.0)) in torn[2]


def test_the_filter_finds_living_elements_whose_corners_are_too_sharp():
    cells = merged()
    cells = replace(cells, fate=np.where(np.arange(24) == 21, Fate.TORN, cells.fate).astype(np.int8))
    sharp = cells.corner_cosines()
    assert np.flatnonzero(sharp > 0.7).tolist() == [20, 21]
    assert np.flatnonzero(DistortionFilter(corner_cosine=0.7).finds(cells)).tolist() == [20]
    assert not DistortionFilter(corner_cosine=float(sharp.max())).finds(cells).any()


@pytest.mark.slow
def test_jumps_tear_what_single_cycles_tear():
    fatigue, _, cells = tired(2, critical=2.0)[0]
    critical = 2.0 * math.sqrt(fatigue[cells.quads].max() / 0.15)  # 0.15 a cycle: torn in the seventh
    base = scene("implicit", damage=Fatigue(exponent=2.0, critical=critical))
    (spec,) = base.contacts
    contacts, program = (replace(spec, specific_wear_rate=1e-12),), Program(cycle=base.program.cycle, strokes=16)
    found = []
    for step in ("each", "jump"):
        accuracy, wear = replace(base.accuracy, longest_jump=1.0), replace(base.wear, step=step)
        one = replace(base, contacts=contacts, program=program, accuracy=accuracy, wear=wear)
        stepper = Stepper(one)
        state, steps = stepper.start(), 0
        while not stepper.finished(state):
            state, steps = stepper.advance(state), steps + 1
        found.append((state.cells.fate, steps))
    assert (found[0][0] == Fate.TORN).any()
    np.testing.assert_array_equal(found[0][0], found[1][0])
    assert found[1][1] < found[0][1] == 8


@pytest.mark.parametrize(
    "wear",
    [
        Wear(step="jump", remesh="never"),
        pytest.param(Wear(step="fixed", max_jump=50, remesh="never"), marks=pytest.mark.slow),
    ],
)
def test_in_a_jump_an_element_is_torn_at_most_one_hundredth_of_the_program_too_late(wear):
    """Hardly any wear: what a cycle uses up of the most strained element stays as it is."""
    usage, cycles = 1 / 210.5, 400
    tiring = replace(scene("implicit", damage=Fatigue(critical=1.0, exponent=2.0)), wear=wear)
    (spec,) = tiring.contacts
    tiring = replace(tiring, contacts=(replace(spec, specific_wear_rate=1e-9),))
    once = Stepper(replace(tiring, program=replace(tiring.program, strokes=2)))
    most = once.advance(once.start()).fatigue.max()
    damage = Fatigue(critical=math.sqrt(most / usage), exponent=2.0)
    tiring = replace(tiring, deactivation=replace(tiring.deactivation, damage=damage))
    stepper = Stepper(replace(tiring, program=replace(tiring.program, strokes=2 * cycles)))
    state = stepper.start()
    while not stepper.finished(state) and state.cells.living.all():
        whole = state.strokes // 2
        state = stepper.advance(state)
    first = state.strokes // 2
    assert whole < 211 <= first <= 211 + cycles // 100
    assert first - whole - 1 == state.ledger.late <= cycles // 100
