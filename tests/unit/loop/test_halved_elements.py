"""The error by the mesh, from elements of half the edges."""

from dataclasses import replace

import numpy as np
import pytest

import ngwear as nw
from ngwear.error_estimates.stated_errors import LARGE, state_errors, with_parts
from ngwear.errors import ConvergenceError
from ngwear.loop import halved_elements
from ngwear.loop.cycle_quantities import read_cycle
from ngwear.loop.halved_elements import NEAR, REMAINS, add_mesh_errors, faded
from ngwear.loop.run import run
from ngwear.loop.stepper import Stepper
from ngwear.results.quantities_of_interest import AREA, BY_HALVED, DEPTH, PEAK
from ngwear.scene.accuracy import Accuracy

BY_DEPTH, BY_PEAK = (f"{name[:-4]} {BY_HALVED}" for name in (DEPTH, PEAK))


@pytest.fixture
def mounted(ring):
    return Stepper(ring).start()


def worn(state):
    """Largest load per length times travel of the cycle, and largest pressure."""
    read = read_cycle(state)
    return max(read[DEPTH].values()), max(read[PEAK].values())


def test_it_tells_what_four_times_as_many_elements_across_change(ring, mounted):
    add_mesh_errors(mounted)
    finer = Stepper(replace(ring, accuracy=Accuracy(across=24.0))).start()
    for name, mine, exact in zip((BY_DEPTH, BY_PEAK), worn(mounted), worn(finer), strict=True):
        off = abs(mine / exact - 1)
        assert off / 3 <= mounted.mesh_errors[name] < 0.1


def test_the_same_from_twelve_elements_across(ring):
    coarse, finest = (Stepper(replace(ring, accuracy=Accuracy(across=across))).start() for across in (12.0, 48.0))
    add_mesh_errors(coarse)
    for name, mine, exact in zip((BY_DEPTH, BY_PEAK), worn(coarse), worn(finest), strict=True):
        assert abs(mine / exact - 1) / 3 <= coarse.mesh_errors[name] < 0.1


def test_the_state_stays_as_it_is(mounted):
    before, elements, solves = mounted.phases[-1].vector.copy(), mounted.stage.body.mesh.ne, mounted.work.solves
    add_mesh_errors(mounted)
    assert mounted.stage.body.mesh.ne == elements
    assert mounted.work.solves == solves
    assert (mounted.phases[-1].vector == before).all()
    assert (mounted.stage.problem.state.vec.FV().NumPy() == before).all()


def test_errors_fade_as_the_wear_does(mounted):
    add_mesh_errors(mounted)
    whole = faded(mounted)
    mounted.first_wear *= 2
    assert faded(mounted)[BY_DEPTH] == pytest.approx(0.5 * mounted.mesh_errors[BY_DEPTH])
    assert faded(mounted)[BY_PEAK] == whole[BY_PEAK]
    mounted.first_wear *= 0.1  # wear that grows does not make them larger
    assert faded(mounted) == whole
    assert {name: error for name, error in whole.items() if name != BY_PEAK} == {
        name: error for name, error in mounted.mesh_errors.items() if name != BY_PEAK
    }


def test_the_depth_has_the_error_of_the_place_that_is_the_deepest_at_the_end(mounted):
    add_mesh_errors(mounted)
    before = faded(mounted)[BY_DEPTH]
    places, wear = mounted.wear_changes[:, :2], mounted.wear_changes[:, 2]
    here = int(wear.argsort()[len(wear) // 2])  # where it wears less at first
    mounted.wear_changes[here, 3] = 0.4 * wear.max()
    depths = np.zeros((2, len(mounted.contour)))
    depths[0, np.linalg.norm(mounted.contour.points - places[wear.argmax()], axis=1).argmin()] = 1.0
    mounted.depths = depths
    assert faded(mounted)[BY_DEPTH] == before
    depths[0] = 0.0
    depths[0, np.linalg.norm(mounted.contour.points - places[here], axis=1).argmin()] = 1.0
    assert faded(mounted)[BY_DEPTH] == pytest.approx(REMAINS * 0.4 / NEAR), "the places beside it agree"


def test_what_the_nodes_do_not_show_of_the_peak_is_added(mounted):
    add_mesh_errors(mounted)
    profiles = [report.contacts["rod"] for report in mounted.reports]
    added = faded(mounted)[BY_PEAK] - mounted.mesh_errors[BY_PEAK]
    missed = max(profile.missed_at_peak for profile in profiles)
    assert added == pytest.approx(missed / max(profile.pressure.max() for profile in profiles))
    assert 0 < added < 0.1


def test_of_strokes_on_two_meshes_all_loads_count_once(ring, mounted):
    """The outline may need a new mesh between the strokes of a cycle; a kept state reports one stroke once more."""
    finer = Stepper(replace(ring, accuracy=Accuracy(across=24.0))).start()
    (first, _), (again, last), exact = mounted.reports, finer.reports, worn(finer)
    assert len(first.contacts["rod"].t) != len(last.contacts["rod"].t)
    finer.reports = [first, again, last]
    assert worn(finer) == exact
    finer.reports = [first, last]
    assert worn(finer)[0] == pytest.approx(exact[0], rel=0.05)


def test_a_part_that_is_held_has_none():
    state = Stepper(replace(nw.read_scene("geometries/rod_seal/scene.toml"), accuracy=Accuracy(across=1.0))).start()
    add_mesh_errors(state)
    assert state.mesh_errors == {}


def test_without_an_equilibrium_on_them_they_are_tried_again_at_the_end(ring, monkeypatch):
    tries, on_halved = [], halved_elements._on_halved

    def fails_first(state):
        tries.append(state.strokes)
        if len(tries) == 1:
            raise ConvergenceError("no equilibrium")
        return on_halved(state)

    monkeypatch.setattr(halved_elements, "_on_halved", fails_first)
    summary = run(ring, progress=False, errors=lambda recorder, summary: None).summary
    assert tries == [0, 2]
    assert summary["error estimates"][BY_DEPTH] > 0


def test_without_any_equilibrium_on_them_the_run_warns(ring, monkeypatch):
    def fails(state):
        raise ConvergenceError("no equilibrium")

    monkeypatch.setattr(halved_elements, "_on_halved", fails)
    summary = run(ring, progress=False, errors=lambda recorder, summary: None).summary
    assert BY_DEPTH not in summary["error estimates"]
    assert [w for w in summary["warnings"] if w.startswith("elements of half the edges do not tell")]


def test_a_run_that_states_no_errors_does_not_look(ring, monkeypatch):
    monkeypatch.setattr(halved_elements, "_on_halved", None)
    assert BY_DEPTH not in run(ring, progress=False).summary["error estimates"]


def test_totals_are_at_least_the_part():
    errors = {DEPTH: 0.01, PEAK: 0.05, BY_DEPTH: 0.02, BY_PEAK: 0.03, f"{AREA[:-4]} {BY_HALVED}": 0.04}
    assert with_parts(errors) == {DEPTH: 0.02, PEAK: 0.05, AREA: 0.04}


def test_a_large_error_is_a_warning():
    summary = {"warnings": []}
    state_errors(summary, {DEPTH: 1.1 * LARGE, PEAK: 0.9 * LARGE})
    assert summary["error estimates"] == {DEPTH: 1.1 * LARGE, PEAK: 0.9 * LARGE}
    (warning,) = summary["warnings"]
    assert warning.startswith("the stated error of the maximum depth is 28 %")


def test_a_part_that_nothing_wears_has_those_of_its_pressures_and_pictures(ring, tmp_path):
    still = tuple(replace(contact, specific_wear_rate=0.0) for contact in ring.contacts)
    result = run(replace(ring, contacts=still), out=tmp_path / "out", progress=False, errors=lambda *_: None)
    assert BY_DEPTH not in result.summary["error estimates"]
    assert 0 < result.summary["error estimates"][BY_PEAK] < 0.1
    assert result.summary["last inward air wall peak pressure [MPa]"] > 5.0  # all contacts are looked at
    assert {path.stem for path in (tmp_path / "out").glob("*.png")} >= {"section", "profiles", "peak_pressure"}
