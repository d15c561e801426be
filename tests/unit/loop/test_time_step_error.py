"""Strokes in parts, and what a run with memory states of its time step."""

import csv
import json
import math
from dataclasses import replace

import h5py
import numpy as np
import pytest
from conftest import REMEMBERS, _write_sheet

from ngwear.error_estimates import run_to_error as module
from ngwear.error_estimates.coarser_runs import combined_errors
from ngwear.error_estimates.run_to_error import ACROSS, PARTS, next_level, next_parts, run_to_error
from ngwear.error_estimates.settings import changes, parameters, with_setting
from ngwear.errors import ConvergenceError, SceneError
from ngwear.explanation.explain import explain
from ngwear.loop import time_step_error
from ngwear.loop.run import run
from ngwear.loop.stepper import Stepper
from ngwear.loop.time_step_error import in_halves, next_cycle, time_step_errors
from ngwear.results.quantities_of_interest import AREA, BY_TIME_STEP, DEPTH, FRICTION, PEAK, quantities
from ngwear.results.result_file import read_result
from ngwear.results.richardson import relative_errors
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.options import Save
from ngwear.scene.program import Program, Stroke, whole_name
from ngwear.scene.read_scene import read_scene

FORTH = Stroke(name="forth", travel=18.0, speed=20.0)
BACK = Stroke(name="back", travel=6.0, direction=-1.0, speed=20.0, pressure=0.5)
TO_AND_FRO = (
    ('name = "stroke"\n', 'name = "forth"\n'),
    (
        "\n[accuracy]",
        '\n[[program.stroke]]\nname = "back"\ntravel = 10.0\nspeed = 20.0\ndirection = -1\n\n[accuracy]',
    ),
)
SEEN = (DEPTH, AREA, PEAK)


def in_parts(scene, parts):
    return replace(scene, accuracy=replace(scene.accuracy, parts=parts))


def by_time(name):
    return f"{name[:-4]} {BY_TIME_STEP}"


def creeping_in(folder):
    """A sheet of rubber with memory under a roller that goes to and fro with much friction."""
    much = ("friction = 0.1", "friction = 0.6\nsticks = false")
    return read_scene(_write_sheet(folder, *REMEMBERS, *TO_AND_FRO, much))


@pytest.fixture
def creeping(tmp_path):
    return creeping_in(tmp_path)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """Its run."""
    return run(creeping_in(tmp_path_factory.mktemp("creep")), figures=False)


@pytest.fixture(scope="module")
def in_sixteenths(finished):
    """What is read of the next cycle, its strokes whole and in sixteen parts."""
    finer = finished.state
    for _ in range(4):
        finer = in_halves(finer)
    whole, exact = next_cycle(finished.state), next_cycle(finer)
    Stepper(finished.state.stage.scene).restore_last_stroke(finished.state)
    deepest = time_step_error._deepest(whole)
    return [time_step_error._read(seen, deepest) for seen in (whole, exact)]


@pytest.fixture
def elastic(tmp_path, write_sheet):
    return read_scene(write_sheet(tmp_path))


@pytest.mark.parametrize("parts", [1, 2, 3, 8])
def test_a_divided_program_takes_the_same_way_in_the_same_time(parts):
    whole = Program(cycle=(FORTH, BACK), strokes=5, rest=7.0)
    program = whole.divided(parts)
    assert (len(program.cycle), program.strokes, program.rest) == (2 * parts, 5 * parts, 7.0)
    for done in range(6):
        assert program.slid(parts * done) == pytest.approx(whole.slid(done))
        assert program.elapsed(parts * done) == pytest.approx(whole.elapsed(done))
        assert program.counted(parts * done) == done
        assert isinstance(program.counted(parts * done), int)
    assert [whole_name(stroke.name) for stroke in program.cycle] == ["forth"] * parts + ["back"] * parts
    assert len({stroke.name for stroke in program.cycle}) == 2 * parts
    assert {(s.direction, s.pressure, s.speed) for s in program.cycle[parts:]} == {(-1.0, 0.5, 20.0)}
    assert program.shortest_way == pytest.approx(6.0)
    assert program.divided(4).cycle == whole.divided(4).cycle
    assert program.divided(1).strokes == 5
    assert [s.name for s in program.divided(1).cycle] == ["forth", "back"]


def test_within_a_stroke_fractions_are_counted():
    assert Program(cycle=(FORTH,), strokes=2).divided(4).counted(5) == 1.25


def test_a_scene_divides_its_strokes_whenever_its_parts_change(creeping):
    twice = in_parts(creeping, 2)
    assert [stroke.duration for stroke in twice.program.cycle] == [0.25] * 4
    assert in_parts(twice, 4).program == in_parts(creeping, 4).program
    assert in_parts(twice, 1).program == creeping.program
    assert replace(twice, program=Program(cycle=(FORTH,), strokes=3)).program.strokes == 6
    assert replace(twice, save=Save(strokes=(1, 3))).marks == (2, 6)
    assert set(twice.folding.kept.times) > set(creeping.folding.kept.times), "shorter times see a faster arm"


@pytest.mark.parametrize("parts", [0, -1])
def test_no_part_at_all_is_refused(elastic, parts):
    with pytest.raises(SceneError, match=rf"accuracy.parts = {parts}: must be at least 1"):
        in_parts(elastic, parts)


def test_half_a_part_is_refused(tmp_path, write_sheet):
    with pytest.raises(SceneError, match=r"accuracy.parts = 1.5: must be a whole number"):
        read_scene(write_sheet(tmp_path, ("patch = 0.2", "patch = 0.2\nparts = 1.5")))


def test_what_sticks_and_wears_has_whole_strokes(creeping):
    sticky = replace(creeping, contacts=(replace(creeping.contacts[0], sticks=True),))
    with pytest.raises(SceneError, match=r"accuracy.parts = 2: contact 'roller' wears and may stick"):
        in_parts(sticky, 2)


def test_shorter_parts_do_not_stick(creeping):
    (contact,) = creeping.contacts
    free = replace(creeping, contacts=(replace(contact, sticks=None),))
    assert not free.may_stick(free.contacts[0])
    assert not in_parts(free, 16).may_stick(free.contacts[0])


def test_files_count_strokes_as_they_were_given(tmp_path, creeping):
    scene = replace(in_parts(creeping, 2), save=Save(strokes=(3,)))
    result = run(scene, out=tmp_path, figures=False)
    assert result.summary["strokes"] == 4
    rows = result.recorder.rows
    assert {0, 0.5, 1, 1.5, 3, 3.5, 4} <= {row["stroke [-]"] for row in rows}
    assert rows[-1]["stroke [-]"] == 4
    assert rows[-1]["sliding distance [mm]"] == pytest.approx(40.0)
    assert {row["kind [-]"] for row in rows} == {f"{k}, part {n} of 2" for k in ("forth", "back") for n in (1, 2)}
    with (tmp_path / "series.csv").open(newline="") as file:
        assert [row["stroke [-]"] for row in csv.DictReader(file)][-2:] == ["4", "4"]
    found = read_result(tmp_path)
    assert found.snapshots[-1].stroke == 4
    assert found.snapshots[-1].time == pytest.approx(2.0)
    assert any(snapshot.stroke == 0.5 for snapshot in found.snapshots)
    with h5py.File(tmp_path / "result.h5") as h5:
        assert max(group.attrs["stroke"] for group in h5["strokes"].values()) == 4


def test_readings_of_parts_are_their_means(creeping, finished):
    rows = run(in_parts(creeping, 2), figures=False).recorder.rows
    read = quantities(rows)
    (column, mean), *_ = read[PEAK].items()
    assert column == "forth: roller peak pressure [MPa]"
    last = [row for row in rows if row["kind [-]"].startswith("forth") and row["strokes in one solve [-]"]][-2:]
    assert mean[-1] == pytest.approx(np.mean([row["roller peak pressure [MPa]"] for row in last]), rel=1e-2)
    assert read.keys() == quantities(finished.recorder.rows).keys()


def test_an_elastic_scene_in_parts_wears_as_much(elastic):
    whole, parts = (run(in_parts(elastic, n), figures=False).summary for n in (1, 2))
    assert parts["worn area [mm^2]"] == pytest.approx(whole["worn area [mm^2]"], rel=1e-3)
    assert parts["solves"] > whole["solves"]
    assert not any(BY_TIME_STEP in name for name in (*whole["error estimates"], *parts["error estimates"]))


def test_halves_relax_what_a_whole_stroke_does(finished):
    halves = in_halves(finished.state)
    assert halves.memory.durations == (0.25,) * 4
    assert len(halves.memory.stresses) == len(halves.phases) == 4
    assert halves.memory.relaxed is finished.state.memory.relaxed
    assert halves.stage.scene.program.parts == 2


@pytest.mark.parametrize("name", [AREA, PEAK, FRICTION])
def test_what_is_stated_is_what_much_finer_steps_show(finished, in_sixteenths, name):
    true = relative_errors(*in_sixteenths)[name]
    assert true > 3e-4, "else there is nothing to see"
    assert 0.5 < finished.summary["error estimates"][by_time(name)] / true < 3.0


@pytest.mark.slow
def test_finer_time_steps_state_less(creeping, finished):
    finer = run(in_parts(creeping, 4), figures=False).summary["error estimates"]
    for name in (AREA, PEAK, FRICTION):
        assert finer[by_time(name)] < 0.5 * finished.summary["error estimates"][by_time(name)]


def test_a_look_that_fails_loses_nothing(tmp_path, creeping, monkeypatch):
    def fail(self, state):
        raise ConvergenceError("no equilibrium")

    monkeypatch.setattr(Stepper, "solve_next_cycle", fail)
    summary = run(creeping, out=tmp_path, figures=False).summary
    assert (summary["status"], summary["strokes"]) == ("completed", 4)
    assert "the error of the time step is not known" in summary["warnings"][-1]
    assert not any(BY_TIME_STEP in name for name in summary["error estimates"])


def test_looking_for_the_error_changes_nothing(finished):
    state, problem = finished.state, finished.state.stage.problem
    before = problem.state.vec.FV().NumPy().copy()
    kept = (state.strokes, state.memory.relaxed.copy(), state.work.solves, state.ledger.worn, problem.get_loads())
    Stepper(state.stage.scene).restore_last_stroke(state)
    again = time_step_errors(state)
    assert problem.state.vec.FV().NumPy() == pytest.approx(before, abs=0)
    assert state.strokes == kept[0]
    assert np.array_equal(state.memory.relaxed, kept[1])
    assert (state.work.solves, state.ledger.worn, problem.get_loads()) == kept[2:]
    assert again == {name: finished.summary["error estimates"][name] for name in again}


def test_the_part_of_the_time_step_is_added(creeping, finished):
    embedded, read = finished.summary["error estimates"], quantities(finished.recorder.rows)
    alike = {error: {name: values for name, values in columns.items()} for error, columns in read.items()}
    folded = creeping.folding.bound
    said = combined_errors(creeping, embedded, read, alike)
    for name in SEEN:
        steps = embedded.get(name, 0.0)  # the scene prescribes its steps
        assert said[name] == pytest.approx(embedded[by_time(name)] + folded + steps)
        assert said[by_time(name)] == embedded[by_time(name)]


@pytest.mark.parametrize(
    ("parts", "by_time_step", "error", "found"),
    [
        (1, 0.0, 0.01, 1),
        (1, 0.005, 0.01, 1),
        (1, 0.006, 0.01, 2),
        (1, 0.011, 0.01, 4),
        (1, 0.5, 0.01, 4),
        (8, 0.5, 0.01, 16),
        (16, 0.5, 0.01, 16),
        (32, 0.5, 0.01, 32),
    ],
)
def test_the_next_parts_by_what_the_time_step_errs_by(parts, by_time_step, error, found):
    assert next_parts(parts, by_time_step, error) == found


@pytest.mark.parametrize(
    ("level", "stated", "by_time_step", "found"),
    [
        ((4.0, 1), 0.010, 0.009, None),
        ((4.0, 1), 0.012, 0.001, (8.0, 1)),
        ((4.0, 1), 0.012, 0.008, (4.0, 2)),
        ((4.0, 1), 0.030, 0.010, (16.0, 2)),
        ((4.0, 2), None, 0.010, (8.0, 2)),
        ((200.0, 16), 0.030, 0.010, None),
        ((200.0, 1), None, 0.0, None),
    ],
)
def test_a_level_refines_what_errs(level, stated, by_time_step, found):
    assert next_level(level, stated, by_time_step, 0.01) == found


@pytest.mark.slow
def test_a_run_to_an_error_takes_the_parts_that_it_needs(tmp_path, creeping, monkeypatch):
    """The time step's error here is too small to matter: it is told to be 3 % with one part, and half with two."""

    def told(state):
        return {by_time(DEPTH): 0.03 / state.stage.scene.program.parts}

    monkeypatch.setattr(time_step_error, "time_step_errors", told)
    monkeypatch.setattr(module, "first_across", lambda error, peak_error=None: 3.0)
    monkeypatch.setattr(module, "next_across", lambda across, stated, error: None)
    asked = replace(creeping, accuracy=Accuracy(error=0.02))
    summary = run_to_error(asked, out=tmp_path).summary
    assert [level[PARTS] for level in summary["levels"]] == [1, 4]
    assert [level[ACROSS] for level in summary["levels"]] == [3.0, 3.0]
    assert summary["strokes"] == 4
    earlier = json.loads((tmp_path / "levels" / "3" / "summary.json").read_text())
    assert earlier["error estimates"][by_time(DEPTH)] == 0.03


def test_the_time_step_is_a_knob_of_memory_alone(creeping, elastic):
    ladders = {parameter.ladder.name: parameter for parameter in parameters(creeping)}
    assert "time step" not in {parameter.ladder.name for parameter in parameters(elastic)}
    ladder = ladders["time step"].ladder
    assert (ladder.values, ladder.own) == ((1.0, 0.5, 0.25, 0.125), 0)
    assert ladder.labels[:2] == ("1 part a stroke", "2 parts a stroke")
    chosen = parameters(creeping)
    setting = tuple(2 if parameter.ladder.name == "time step" else parameter.ladder.own for parameter in chosen)
    finer = with_setting(creeping, chosen, setting)
    assert finer.program.parts == 4
    assert changes(creeping, finer) == {"accuracy.parts": 4}
    thirds = {parameter.ladder.name: parameter.ladder for parameter in parameters(in_parts(creeping, 3))}["time step"]
    assert (thirds.values[1:3], thirds.own) == ((0.5, 1 / 3), 2)


def test_explain_says_how_long_a_step_is(creeping):
    numbers = explain(in_parts(creeping, 2))["numbers"]
    assert numbers["shortest stroke [s]"] == pytest.approx(0.5)
    assert numbers["shortest time step [s]"] == pytest.approx(0.25)
    assert math.isfinite(numbers["largest error of stress by arms left out [-]"])
