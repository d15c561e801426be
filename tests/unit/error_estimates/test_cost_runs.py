"""Cost studies of real, tiny scenes: parameters, files, resumption, the command line."""

import csv
import io
import json
import math
import os
import signal
import time
from concurrent.futures import Executor, Future
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import FINE, REMEMBERS

from ngwear.cli import BAD_INPUT, GAVE_UP, OK, main
from ngwear.error_estimates import settings as settings_module
from ngwear.error_estimates.cost import CSV, JSON, PNG, RUNS, cost
from ngwear.error_estimates.cost_runs import NO_TIME, Limited, Point, _clock, _timed, measure
from ngwear.error_estimates.ladder import STOPPED, Measurement
from ngwear.error_estimates.settings import parameters, with_setting
from ngwear.errors import ConvergenceError, SceneError
from ngwear.loop import first_cycle, stroke_solve
from ngwear.loop.stepper import Stepper
from ngwear.parallel.sweep import sweep
from ngwear.parallel.workers import one_thread_pool
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.read_scene import read_scene
from ngwear.verify.rod_seal import shipped_scene

JUMPS = (("strokes = 4", "strokes = 6"), ('step = "each"', 'step = "jump"'))
PIN = """
[scene]
kind = "pin on plate"
[material]
model = "mooney-rivlin"
c10 = 0.6
c01 = 0.15
bulk_modulus = 1500.0
[material.prony]
moduli = [0.5, 1.0]
times = [1e-5, 1e-3]
reference = "long-term"
[pin]
load = 10.0
[program]
speeds = [100.0]
[accuracy]
patch = 1.0
column = 0.5
reach = 2.5
beside = 2.0
"""
AMPLE = 300.0  # seconds, some ten times what the few levels take


@pytest.fixture
def seal(seal):
    """The shipped seal with the default element edges; its own accuracy.error is not a parameter of a study."""
    return replace(seal, accuracy=Accuracy())


def names(scene):
    return [parameter.ladder.name for parameter in parameters(scene)]


def few_levels(patch):
    patch.setattr(settings_module, "MESH", (2.0, 1.0))
    patch.setattr(settings_module, "JUMPS", (1.0,))
    patch.setattr(settings_module, "STRESS", (2.0, 1.0))


def study_in(folder, file):
    with pytest.MonkeyPatch.context() as patch:
        few_levels(patch)
        return cost(read_scene(file), budget=AMPLE, folder=folder / "out")


@pytest.fixture(scope="module")
def studied(tmp_path_factory, write_sheet):
    """A study of a few levels, and its scene's file."""
    folder = tmp_path_factory.mktemp("cost")
    file = write_sheet(folder, *JUMPS)
    return study_in(folder, file), folder / "out", file


def test_only_knobs_that_the_scene_calls_for(sheet, seal, tmp_path, write_sheet):
    elastic = ["element edge", "jumps over strokes", "stress criterion", "element order"]
    assert names(sheet) == elastic
    assert names(seal) == elastic
    filled = read_scene(write_sheet(tmp_path / "filled", *REMEMBERS))
    assert names(filled) == [*elastic, "time step", "arms of the memory"]
    (contact,) = sheet.contacts
    unworn = replace(sheet, contacts=(replace(contact, specific_wear_rate=0.0),))
    assert "jumps over strokes" not in names(unworn)
    short = replace(sheet, program=replace(sheet.program, strokes=2))
    assert "jumps over strokes" not in names(short)


@pytest.mark.slow
def test_increments_of_the_load_are_no_knob(monkeypatch):
    """Of the torn seal, whose clamps stick: what they carry, and the peak, after strokes in increments of a quarter."""

    def first(state, stroke, loads, options, real=first_cycle.advance_while_sliding, **how):
        return real(state, stroke, loads, replace(options, first=0.25 * options.first, easy=2), **how)

    def later(problem, target, options, real=stroke_solve.advance, **how):
        return real(problem, target, replace(options, first=0.25 * options.first, easy=2), **how)

    scene, work, seen = shipped_scene(folder="torn_seal"), [], []
    for own, others in ((first_cycle.advance_while_sliding, stroke_solve.advance), (first, later)):
        monkeypatch.setattr(first_cycle, "advance_while_sliding", own)
        monkeypatch.setattr(stroke_solve, "advance", others)
        state = Stepper(scene).start()
        work.append(state.work.solves)
        forces = [np.concatenate([*report.forces.values()]) for report in state.reports]
        seen.append((forces, [report.contacts["rod"].pressure.max() for report in state.reports]))
    assert work[1] > 1.5 * work[0]
    (forces, peaks), (others, other_peaks) = seen
    assert np.abs(np.subtract(others, forces)).max() < 1e-5 * np.abs(forces).max()
    assert other_peaks == pytest.approx(peaks, rel=1e-6)


def test_rungs_change_their_knob_and_nothing_else(seal):
    mesh, jump, stress, order = parameters(seal)
    for parameter in (mesh, jump, stress, order):
        values = parameter.ladder.values
        assert list(values) == sorted(values, reverse=True)
        assert with_setting(seal, [parameter], (parameter.ladder.own,)) is seal
    fine = with_setting(seal, [mesh], (mesh.ladder.own + 1,))
    assert fine.accuracy == replace(seal.accuracy, patch=0.005, coarse=0.1)
    coarse = with_setting(seal, [mesh], (mesh.ladder.own - 2,))
    assert coarse.accuracy == replace(seal.accuracy, patch=0.04, coarse=0.8, mounting=0.04)
    each = with_setting(seal, [jump], (len(jump.ladder.values) - 1,))
    assert (each.wear.step, each.accuracy) == ("each", seal.accuracy)
    assert with_setting(each, [parameters(each)[1]], (0,)).wear.step == "jump"


def test_orders_are_told_by_their_names_and_keep_the_elements(seal, tmp_path, write_sheet):
    order = parameters(seal)[-1]
    assert order.ladder.labels == ("order 1", "order 2", "order 3")
    linear, cubic = (with_setting(seal, [order], (i,)).accuracy for i in (0, 2))
    assert (linear.order, linear.stress_error) == (1, pytest.approx(seal.accuracy.stress_error**0.5))
    assert (cubic.order, cubic.stress_error) == (3, pytest.approx(seal.accuracy.stress_error**1.5))
    sticking = read_scene(write_sheet(tmp_path, ("force = 0.5", "force = 0.5\nsticks = true")))
    assert parameters(sticking)[-1].ladder.labels == ("order 2", "order 3")


def test_arms_are_told_apart_by_what_is_kept(tmp_path, write_sheet):
    scene = read_scene(write_sheet(tmp_path, *REMEMBERS))
    arms = parameters(scene)[-1]
    kept = [with_setting(scene, [arms], (i,)).folding.kept.times for i in range(len(arms.ladder.values))]
    assert len(set(kept)) == len(kept)
    assert [len(k) for k in kept] == sorted(len(k) for k in kept)
    assert len(kept[-1]) == len(scene.part.prony.times)


def test_knobs_of_a_pin(tmp_path):
    file = tmp_path / "scene.toml"
    file.write_text(PIN, encoding="utf-8")
    scene = read_scene(file)
    mesh, column, block, arms = parameters(scene)
    assert with_setting(scene, [mesh], (0,)).mesh == replace(scene.mesh, patch=2.0, coarse=6.0)
    assert with_setting(scene, [column], (len(column.ladder.values) - 1,)).mesh == replace(scene.mesh, column=0.125)
    large = with_setting(scene, [block], (len(block.ladder.values) - 1,)).mesh
    assert large.reach / scene.mesh.reach == pytest.approx(large.beside / scene.mesh.beside)
    assert large.beside * scene.pin.thickness < scene.pin.track_radius, "the block ends before the track's centre"
    assert arms.ladder.labels == ("1 arm", "2 arms"), "steady sliding needs one"


def test_files_of_a_study(studied):
    found, out, _ = studied
    rows = list(csv.DictReader(io.StringIO((out / CSV).read_text(encoding="utf-8"))))
    assert len(rows) == len(found.study.runs)
    assert all("[" in column for column in rows[0])
    assert float(rows[0]["CPU time [s]"]) > 0
    assert float(rows[0]["peak memory [MB]"]) > 10
    told = json.loads((out / JSON).read_text(encoding="utf-8"))
    assert told == json.loads(json.dumps(found.as_dict()))
    assert (out / PNG).read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert {q.split(" [")[0] for q in found.study.quantities} == {
        *("maximum depth", "worn area", "peak pressure", "roller contact width", "roller friction force")
    }


@pytest.mark.slow
def test_friction_of_each_level_is_coulombs(tmp_path, write_sheet):
    study = study_in(tmp_path, write_sheet(tmp_path, *FINE, *JUMPS)).study
    levels = [run for k in range(len(study.ladders)) for run in study.levels(k).values()]
    force = [run.values["roller friction force [N/mm]"] for run in levels]  # choices, too, are run: which, seconds tell
    assert force == pytest.approx([0.05] * len(force), rel=1e-3), "mu F"


def test_errors_are_against_each_ladders_finest_run(studied):
    study = studied[0].study
    for k, ladder in enumerate(study.ladders):
        levels = study.levels(k)
        finest = levels[max(levels)].values[study.main]
        for i, run in levels.items():
            assert study.level_error(k, i, study.main) == abs(run.values[study.main] - finest) / finest
        assert max(levels) == len(ladder.values) - 1, "the budget is ample"
    assert study.own_error(1, study.main) == 0.0, "each stroke solved"


def test_second_call_runs_nothing_and_finds_the_same(studied, monkeypatch):
    found, out, file = studied
    few_levels(monkeypatch)
    before = {p.name: p.stat().st_mtime_ns for p in (out / RUNS).iterdir()}
    monkeypatch.setattr(Limited, "submit", lambda *_: pytest.fail("a run was begun"))
    again = cost(read_scene(file), budget=AMPLE, folder=out, figures=False)
    assert again.as_dict() == found.as_dict()
    assert {p.name: p.stat().st_mtime_ns for p in (out / RUNS).iterdir()} == before


def test_a_study_that_was_killed_goes_on(studied, monkeypatch, tmp_path):
    """The lost run is made again; its seconds may differ, and call for another one to confirm a choice."""
    import shutil

    found, out, file = studied
    few_levels(monkeypatch)
    folder = tmp_path / "out"
    shutil.copytree(out, folder)
    lost = sorted((folder / RUNS).glob("*.npz"))[0]
    lost.unlink()
    kept = {path.name: path.stat().st_mtime_ns for path in (folder / RUNS).iterdir()}
    again = cost(read_scene(file), budget=AMPLE, folder=folder, figures=False)
    assert lost.exists()
    assert {name: (folder / RUNS / name).stat().st_mtime_ns for name in kept} == kept, "none is run again"
    for k in range(len(found.study.ladders)):
        before, after = ({n: run.values for n, run in s.levels(k).items()} for s in (found.study, again.study))
        assert before == after


def test_a_run_out_of_time_is_stopped_and_says_what_it_would_take(sheet):
    long = replace(sheet, program=replace(sheet.program, strokes=100_000))
    with one_thread_pool(1) as workers:
        (outcome,) = sweep(measure, [Point(long)], executor=Limited(workers, 4.0))
    assert outcome.result.status == STOPPED
    assert 3.0 < outcome.result.wall < 20.0
    assert outcome.result.needed > 100.0


@pytest.mark.parametrize(("function", "point"), [(time.sleep, 120.0), (sum, range(10**12))], ids=["asleep", "in C"])
def test_a_call_that_takes_no_notice_is_ended_with_its_process(tmp_path, function, point):
    """One lets nothing else of Python run: no thread and no signal reaches it."""
    begun = time.monotonic()
    how = {"folder": tmp_path, "classes": (Measurement,)}
    with one_thread_pool(1) as workers:
        (outcome,) = sweep(function, [point], executor=Limited(workers, 2.0, grace=2.0), **how)
    assert (outcome.result.status, outcome.result.message) == (STOPPED, NO_TIME)
    assert 2.0 < outcome.result.wall <= time.monotonic() - begun < 30.0
    (again,) = sweep(function, [point], executor=Limited(Here(), 2.0), resume=True, **how)
    assert again.restored, "a call of the same study does not try once more"


def test_a_process_that_dies_before_its_time_is_a_failure(sheet):
    with one_thread_pool(1) as workers:
        (outcome,) = sweep(os._exit, [3], executor=Limited(workers, 60.0))
    assert outcome.failure.kind == "BrokenProcessPool"


def test_the_keyboard_interrupts_a_run_that_has_time_left():
    def interrupted():
        signal.raise_signal(signal.SIGINT)
        time.sleep(1.0)

    with pytest.raises(KeyboardInterrupt):
        _timed(time.time(), 30.0, 30.0, interrupted)
    assert math.isnan(_clock.sent)


def test_a_run_that_ends_as_its_time_is_over_is_either_there_or_stopped():
    """Nothing of the clock is left for whatever comes next."""
    for k in range(60):
        until = time.monotonic() + 0.02 + 2e-4 * (k % 11 - 5)

        def short(until=until):
            while time.monotonic() < until:
                pass
            return "there"

        found = _timed(time.time(), 0.02, 30.0, short)
        assert found == "there" or found.status == STOPPED
        assert not _clock.over


class Here(Executor):
    """Calls at once, in this process."""

    def submit(self, function, /, *args, **kwargs):
        future = Future()
        future.set_result(function(*args, **kwargs))
        return future


@pytest.mark.parametrize("made_of_it", ["another error", "nothing"])
def test_an_alarm_that_is_swallowed_stops_the_run_all_the_same(sheet, monkeypatch, made_of_it):
    """Compiled libraries call Python, too, and what they make of its errors is theirs."""

    def swallows(scene, *, on_step, **_):
        try:
            until = time.monotonic() + 30.0
            while time.monotonic() < until:
                time.sleep(0.01)
        except Exception as error:
            if made_of_it == "another error":
                raise ConvergenceError("the solver failed") from error
        on_step(SimpleNamespace(strokes=1))
        pytest.fail("the run went on")

    monkeypatch.setattr("ngwear.loop.run.run", swallows)
    found = Limited(Here(), 0.2).submit(measure, Point(sheet)).result()
    assert found.status == STOPPED
    assert found.message == "no time was left"


def test_an_alarm_that_nothing_catches_stops_the_run_all_the_same():
    """Where the time is over before the run has begun: it was told as one that gave up, and a study went on."""

    def slow():
        until = time.time() + 5.0
        while time.time() < until:
            _clock.check()

    before = signal.getsignal(signal.SIGINT)
    found = _timed(time.time() - 1.0, 0.01, 30.0, slow)
    assert signal.getsignal(signal.SIGINT) is before
    assert (found.status, found.message) == (STOPPED, NO_TIME)
    assert 1.0 < found.wall < 3.0
    assert math.isnan(found.needed)
    assert math.isnan(_clock.sent)
    assert not _clock.over


def test_a_run_that_gives_up_says_why(tmp_path, write_sheet):
    scene = read_scene(write_sheet(tmp_path, ("force = 0.5", "force = 500")))
    found = measure(Point(scene))
    assert found.status == "gave up"
    assert "no equilibrium" in found.message


@pytest.mark.parametrize("budget", [0.0, -3.0, math.nan, math.inf])
def test_budget_must_be_positive(sheet, budget):
    with pytest.raises(SceneError, match=r"cost\.budget"):
        cost(sheet, budget=budget)


def test_command_line_refuses_in_one_line(sheet_file, capsys, tmp_path):
    assert main(["cost", str(sheet_file), "--budget", "-1"]) == BAD_INPUT
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.startswith("ngwear: cost.budget = -1.0: must be")
    assert main(["cost", str(sheet_file), "--budget", "0.05"]) == BAD_INPUT
    assert "is too small for one run" in capsys.readouterr().err
    assert main(["cost", str(tmp_path / "nowhere.toml"), "--budget", "10"]) == BAD_INPUT
    with pytest.raises(SystemExit):
        main(["cost", str(sheet_file)])


def test_command_line_when_every_rung_gives_up(tmp_path, write_sheet, monkeypatch, capsys):
    few_levels(monkeypatch)
    monkeypatch.setattr(settings_module, "STRESS", (1.0,))
    file = write_sheet(tmp_path, ("force = 0.5", "force = 500"), ("strokes = 4", "strokes = 1"))
    assert main(["cost", str(file), "--budget", str(AMPLE), "--quiet"]) == GAVE_UP
    assert "no equilibrium" in capsys.readouterr().err


def test_json_on_the_command_line(studied, monkeypatch, capsys):
    found, out, file = studied
    few_levels(monkeypatch)
    assert main(["cost", str(file), "--budget", str(AMPLE), "--out", str(out), "--json", "--quiet"]) == OK
    told = json.loads(capsys.readouterr().out)
    assert told == json.loads(json.dumps(found.as_dict()))
    keys = {"scene", "budget [s]", "in words", "main quantity", "ladders", "runs", "front", "recommended", "not run"}
    assert keys <= set(told)
    assert {"name", "reference", "errors against the reference [-]", "observed order [-]"} <= set(told["ladders"][0])
    assert {"setting", "status", "CPU time [s]", "wall time [s]", "peak memory [MB]"} <= set(told["runs"][0])
    assert main(["cost", str(file), "--budget", str(AMPLE), "--out", str(out), "--quiet"]) == OK
    shown = capsys.readouterr().out
    assert found.paragraph in shown
