import csv
import errno
import io
import itertools
import json
import logging
import os
import re
import signal
import subprocess
import sys
import time
from dataclasses import replace

import pytest
from conftest import FINE

from ngwear.cli import main
from ngwear.equilibrium.newton import Outcome, Report
from ngwear.errors import ConvergenceError, GeometryError, NgwearError, ResultError, SceneError
from ngwear.files.result_folder import CHECKPOINT, FIELDS, SERIES, SUMMARY
from ngwear.loop import stroke_solve
from ngwear.loop.checkpoint import load
from ngwear.loop.run import COMPLETED, GAVE_UP, run
from ngwear.loop.stepper import Stepper
from ngwear.loop.wear_step import WearStep
from ngwear.results.recorder import Folder
from ngwear.scene.options import Save
from ngwear.scene.read_scene import read_scene

FILES = {SERIES, FIELDS, SUMMARY, CHECKPOINT}
CONTRACT = {
    "status",
    "solves",
    "retries",
    "error estimates",
    "wall time [s]",
    "CPU time [s]",
    "maximum depth [mm]",
    "peak pressure [MPa]",
}
NOT_REPEATABLE = {"wall time [s]", "CPU time [s]", "peak memory [MB]"}
CLI = "import sys; from ngwear.cli import main; sys.exit(main(sys.argv[1:]))"


def summary_of(folder):
    return json.loads((folder / SUMMARY).read_text())


def rows_of(folder):
    return list(csv.DictReader(io.StringIO((folder / SERIES).read_text())))


def numbers(summary):
    """All numbers of a summary, flat, but for times and memory."""
    flat = {}
    for key, value in summary.items():
        if key in NOT_REPEATABLE:
            continue
        if isinstance(value, dict):
            flat |= {f"{key}/{k}": v for k, v in value.items()}
        else:
            flat[key] = value
    return flat


def assert_same(found, expected):
    found, expected = numbers(found), numbers(expected)
    assert set(found) == set(expected)
    for key, value in expected.items():
        if isinstance(value, float):
            assert found[key] == pytest.approx(value, rel=1e-9, abs=1e-11), key
        else:
            assert found[key] == value, key


def assert_same_rows(found, expected):
    assert len(found) == len(expected)
    for mine, theirs in zip(found, expected, strict=True):
        for key in set(theirs) - {"wall time [s]", "kind [-]"}:
            assert float(mine[key]) == pytest.approx(float(theirs[key]), rel=1e-9, abs=1e-12), key


def test_run_leaves_the_files_of_the_contract(finished):
    assert {p.name for p in finished.iterdir()} >= FILES | {"history.png", "profiles.png"}
    assert not list(finished.glob(".*")), "no temporary file is left"
    summary = summary_of(finished)
    assert set(summary) >= CONTRACT
    assert summary["status"] == COMPLETED
    assert summary["strokes"] == 4
    assert summary["wall time [s]"] > 0
    assert summary["CPU time [s]"] > 0


def test_every_column_has_its_unit(finished):
    rows = rows_of(finished)
    assert rows
    for column in rows[0]:
        assert re.fullmatch(r".* \[.*\]", column), column
    assert [int(row["stroke [-]"]) for row in rows] == [0, 1, 2, 3, 4]
    assert [float(row["sliding distance [mm]"]) for row in rows] == [0, 10, 20, 30, 40]


def test_worn_area_is_archards(finished):
    """k F s / J: 1e-3 mm²/N x 0.5 N/mm x 10 mm a stroke; J within p / K = 0.6 % to first order of 1, times 2."""
    worn = [float(row["worn area by the law [mm^2]"]) for row in rows_of(finished)]
    steps = [b - a for a, b in itertools.pairwise(worn)]
    assert steps == pytest.approx([5e-3] * 4, rel=0.02)
    summary = summary_of(finished)
    assert summary["worn area [mm^2]"] == pytest.approx(summary["worn area by the law [mm^2]"], rel=1e-6)
    assert summary["error estimates"]["area against the law [-]"] < 1e-6


def test_wear_lowers_the_pressure_and_deepens_steadily(finished):
    rows = rows_of(finished)
    peak = [float(row["roller peak pressure [MPa]"]) for row in rows]
    depth = [float(row["maximum depth [mm]"]) for row in rows]
    assert peak == sorted(peak, reverse=True), "a wider track carries the same force"
    assert depth == sorted(depth)
    assert depth[0] == 0.0
    assert depth[-1] > 0.01


def test_force_and_friction_obey_coulomb(fine_sheet):
    for row in run(fine_sheet).recorder.rows:
        normal = float(row["roller force y [N/mm]"]) + float(row["roller friction force y [N/mm]"])
        along = float(row["roller force x [N/mm]"]) + float(row["roller friction force x [N/mm]"])
        assert normal == pytest.approx(-0.5, rel=1e-6), "pressure and friction together, however worn the outline is"
        assert abs(along) == pytest.approx(0.1 * 0.5, rel=0.05)
        heat = float(row["roller friction heat of the stroke [mJ/mm]"])
        assert heat == pytest.approx(0.1 * 0.5 * 10.0, rel=0.05), "mu F over 10 mm"


def test_wearless_run_wears_nothing(tmp_path, write_sheet):
    scene = read_scene(write_sheet(tmp_path, ("1.0e-3", "0.0"), ("friction = 0.1", "refine = true")))
    result = run(scene, figures=False)
    assert result.status == COMPLETED
    assert result.summary["maximum depth [mm]"] == 0.0
    assert result.summary["worn area [mm^2]"] == 0.0


def test_run_without_a_folder_writes_nothing(tmp_path, sheet, monkeypatch):
    monkeypatch.chdir(tmp_path)
    before = sorted(tmp_path.rglob("*"))
    assert run(sheet).summary["strokes"] == 4
    assert sorted(tmp_path.rglob("*")) == before


def test_no_strokes_is_only_mounted(tmp_path, write_sheet):
    scene = read_scene(write_sheet(tmp_path, ("strokes = 4", "strokes = 0")))
    result = run(scene, out=tmp_path / "out")
    assert result.status == COMPLETED
    assert result.summary["maximum depth [mm]"] == 0.0
    assert result.summary["peak pressure [MPa]"] > 0.3


@pytest.mark.parametrize("centre", [3.99, 4.0, 4.2])
def test_roller_under_force_finds_the_sheet_from_where_it_is(tmp_path, write_sheet, centre):
    """A surface under force may start inside the part, just touching it, or away from it: the rest is the same."""
    scene = read_scene(write_sheet(tmp_path, *FINE, ("3.99", str(centre)), ("strokes = 4", "strokes = 1")))
    result = run(scene, figures=False)
    assert result.summary["peak pressure [MPa]"] == pytest.approx(0.591, rel=0.02)


def test_folder_that_holds_a_run_is_not_overwritten(finished, sheet):
    before = {p.name: p.read_bytes() for p in finished.iterdir()}
    with pytest.raises(ResultError, match=r"already holds a run: continue it with --resume, or give another folder"):
        run(sheet, out=finished)
    assert {p.name: p.read_bytes() for p in finished.iterdir()} == before


def test_resume_of_a_finished_run_changes_nothing(finished, sheet):
    before, rows = summary_of(finished), rows_of(finished)
    result = run(sheet, out=finished, resume=True)
    assert result.status == COMPLETED
    assert_same(summary_of(finished), before)
    assert_same_rows(rows_of(finished), rows)


def test_resume_writes_a_series_that_a_kill_has_left_behind(finished, sheet):
    """The checkpoint is written before the series: a kill between the last two leaves the series a step behind."""
    series = finished / SERIES
    complete = rows_of(finished)
    series.write_text("\n".join(series.read_text().splitlines()[:-1]) + "\n")
    run(sheet, out=finished, resume=True, figures=False)
    assert_same_rows(rows_of(finished), complete)


def test_resume_with_a_changed_scene_is_refused(tmp_path, finished, write_sheet):
    scene = read_scene(write_sheet(tmp_path / "other", ("shear = 1.0", "shear = 1.1")))
    before = (finished / CHECKPOINT).read_bytes()
    with pytest.raises(ResultError, match=r"another scene, or the scene was changed: give another folder"):
        run(scene, out=finished, resume=True)
    assert (finished / CHECKPOINT).read_bytes() == before


def test_resume_with_a_damaged_checkpoint_is_refused(finished, sheet):
    (finished / CHECKPOINT).write_bytes((finished / CHECKPOINT).read_bytes()[:3000])
    with pytest.raises(ResultError, match=r"checkpoint\.npz cannot be read.*remove the folder"):
        run(sheet, out=finished, resume=True)


def test_resume_of_nothing_starts(tmp_path, sheet, finished):
    run(sheet, out=tmp_path / "new", resume=True, figures=False)
    assert_same(summary_of(tmp_path / "new"), summary_of(finished))


def stop_after(monkeypatch, strokes, error):
    """Let ``advance`` raise once that many strokes are done."""
    real = Stepper.advance

    def advance(self, state):
        if state.strokes >= strokes:
            raise error
        return real(self, state)

    monkeypatch.setattr(Stepper, "advance", advance)


@pytest.mark.parametrize("strokes", [0, 2])
def test_interrupted_and_resumed_is_the_same_as_uninterrupted(tmp_path, sheet, finished, monkeypatch, strokes):
    out = tmp_path / "out"
    with monkeypatch.context() as patch:
        stop_after(patch, strokes, KeyboardInterrupt)
        with pytest.raises(KeyboardInterrupt):
            run(sheet, out=out, figures=False)
    assert {p.name for p in out.iterdir()} == {CHECKPOINT, SERIES}
    assert len(rows_of(out)) == strokes + 1
    run(sheet, out=out, resume=True, figures=False)
    assert_same(summary_of(out), summary_of(finished))
    assert_same_rows(rows_of(out), rows_of(finished))


def jumping(folder, write_sheet):
    """A scene with a cycle of two strokes that jumps and remeshes."""
    back = 'travel = 10.0\n[[program.stroke]]\nname = "back"\ntravel = 5.0\ndirection = -1'
    return write_sheet(
        folder,
        ("strokes = 4", "strokes = 16"),
        ("travel = 10.0", back),
        ('step = "each"', 'step = "jump"'),
        ("patch = 0.2", "patch = 0.2\nwear_error = 0.05"),
    )


@pytest.fixture(scope="module")
def jumped(tmp_path_factory, write_sheet):
    """The whole of it, and where."""
    folder = tmp_path_factory.mktemp("jumping")
    return folder / "whole", run(read_scene(jumping(folder, write_sheet)), out=folder / "whole", figures=False)


@pytest.mark.parametrize("stop", [2, 6])
def test_resume_of_jumps_over_a_cycle_of_two_strokes(tmp_path, write_sheet, monkeypatch, jumped, stop):
    scene = read_scene(jumping(tmp_path, write_sheet))
    folder, whole = jumped
    assert whole.summary["strokes"] == 16
    assert whole.summary["solves"] < 60
    with monkeypatch.context() as patch:
        stop_after(patch, stop, KeyboardInterrupt)
        with pytest.raises(KeyboardInterrupt):
            run(scene, out=tmp_path / "parts", figures=False)
    run(scene, out=tmp_path / "parts", resume=True, figures=False)
    assert_same(summary_of(tmp_path / "parts"), summary_of(folder))
    assert_same_rows(rows_of(tmp_path / "parts"), rows_of(folder))


RING = """
[[edge]]
name = "inside"
points = [[0, 10], [0.5, 9.95], [1, 9.9], [1.5, 9.95]]
[[edge]]
name = "sealed"
points = [[2, 10], [2, 10.5]]
[[edge]]
name = "outside"
points = [[2, 11], [1, 11]]
[[edge]]
name = "back"
points = [[0, 11], [0, 10.5]]
"""
RING_SCENE = """
[scene]
name = "ring"
kind = "axisymmetric"
[contour]
file = "ring.toml"
[material]
model = "neo-hooke"
shear = 1.0
bulk_modulus = 100.0
[[contact]]
name = "rod"
edges = ["inside"]
surface = { type = "rod", diameter = 20.0 }
friction = 0.1
specific_wear_rate = 1e-3
[[support]]
edges = ["back"]
y = false
[[support]]
edges = ["outside"]
x = false
[fluid]
edges = ["inside", "sealed"]
inlet = ["sealed"]
[program]
strokes = 6
[[program.stroke]]
name = "out"
travel = 10.0
direction = -1
[[program.stroke]]
name = "in"
travel = 10.0
pressure = 0.1
[accuracy]
patch = 0.05
coarse = 0.3
mounting = 0.1
"""


def test_state_saved_under_fluid_pressure_goes_on_the_same(tmp_path, from_checkpoint):
    """Axisymmetric, friction, wear and a fluid front: all of it is in the checkpoint."""
    (tmp_path / "ring.toml").write_text(RING)
    (tmp_path / "scene.toml").write_text(RING_SCENE)
    scene = read_scene(tmp_path / "scene.toml")
    stepper = Stepper(scene)
    state = stepper.advance(stepper.start())
    assert 0 < state.strokes < scene.program.strokes
    ends = []
    for going_on in (from_checkpoint(state, scene), state):
        while not stepper.finished(going_on):
            going_on = stepper.advance(going_on)
        ends.append((going_on.ledger, going_on.work, going_on.reports[-1].forces))
    (resumed, work, forces), (whole, work_whole, forces_whole) = ends
    assert whole.worn > 0
    assert resumed.worn == pytest.approx(whole.worn, rel=1e-9)
    assert resumed.removed == pytest.approx(whole.removed, rel=1e-9)
    assert resumed.area_error == pytest.approx(whole.area_error, rel=1e-9)
    assert work == work_whole
    assert forces["fluid"][0] < -6.0, "0.1 MPa on a ring face of 1 mm by 2 pi 10.5 mm"
    for name, force in forces_whole.items():
        assert forces[name] == pytest.approx(force, rel=1e-7, abs=1e-9), name


def test_strokes_to_be_kept_are_not_passed_over(tmp_path, write_sheet):
    file = jumping(tmp_path, write_sheet)
    file.write_text(file.read_text() + "[save]\nstrokes = [6]\n")
    result = run(read_scene(file), figures=False)
    assert 6 in [row["stroke [-]"] for row in result.recorder.rows]
    assert result.summary["strokes"] == 16


def test_killed_and_resumed_is_the_same_as_uninterrupted(tmp_path, write_sheet):
    """A kill at a moment that nobody chose."""
    file = write_sheet(tmp_path, ("strokes = 4", "strokes = 20"))
    scene = read_scene(file)
    run(scene, out=tmp_path / "whole", figures=False)
    out = tmp_path / "killed"
    process = subprocess.Popen([sys.executable, "-c", CLI, "run", str(file), "--out", str(out), "--quiet", "--alone"])
    try:
        deadline = time.monotonic() + 30
        while not (out / CHECKPOINT).exists():
            assert time.monotonic() < deadline, "no checkpoint within 30 s"
            assert process.poll() is None, "ended before its first checkpoint"
            time.sleep(0.002)
        time.sleep((time.time_ns() // 1000 % 200) / 1000)
    finally:
        process.send_signal(signal.SIGKILL)
        assert process.wait() == -signal.SIGKILL
    assert not (out / SUMMARY).exists()
    left = load(Folder(out, scene, resume=True), scene)
    assert left is not None
    assert left[0].strokes < 20
    run(scene, out=out, resume=True, figures=False)
    assert_same(summary_of(out), summary_of(tmp_path / "whole"))
    assert_same_rows(rows_of(out), rows_of(tmp_path / "whole"))
    assert not list(out.glob(".*")), "what the kill left half-written is cleared away"


@pytest.mark.parametrize("fails", [1, *(pytest.param(n, marks=pytest.mark.slow) for n in (2, 3)), 6])
def test_full_disk_keeps_the_last_state_and_says_what_to_do(tmp_path, sheet, finished, monkeypatch, fails):
    out, calls, real = tmp_path / "out", [], os.fsync

    def fsync(handle):
        calls.append(handle)
        if len(calls) == fails:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        real(handle)

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", fsync)
        with pytest.raises(ResultError, match=r"cannot be written: No space left.*free some disk space.*--resume"):
            run(sheet, out=out, figures=False)
    assert not list(out.glob(".*")), "no temporary file is left"
    assert (out / CHECKPOINT).exists() == (fails > 1)
    result = run(sheet, out=out, resume=True, figures=False)
    assert result.status == COMPLETED
    assert_same(summary_of(out), summary_of(finished))
    assert_same_rows(rows_of(out), rows_of(finished))


def test_force_far_too_high_gives_up_while_mounting_and_says_so(tmp_path, write_sheet):
    scene = read_scene(write_sheet(tmp_path, ("force = 0.5", "force = 500.0")))
    result = run(scene, out=tmp_path / "out", throw=False)
    assert result.status == GAVE_UP
    assert isinstance(result.error, ConvergenceError)
    assert result.state is None
    assert re.search(r"mount|after stroke 0\b", result.message), result.message
    assert "roller force" in result.message
    assert "no equilibrium found under the mounting load; lower force" in result.message
    summary = summary_of(tmp_path / "out")
    assert summary["status"] == GAVE_UP
    assert summary["strokes"] == 0
    assert summary["message"] == result.message
    assert {"wall time [s]", "CPU time [s]"} <= set(summary), "what it cost is known"


def test_a_part_that_nothing_holds_is_told_so_and_not_to_lower_its_force(tmp_path, write_sheet):
    scene = read_scene(write_sheet(tmp_path, ('[[support]]\nedges = ["bottom"]', "")))
    message = run(scene, throw=False).message
    assert "nothing holds the part along y: add a support" in message
    assert "lower force" not in message
    assert message.count("last displacement corrections") == 1


@pytest.fixture
def through(tmp_path, write_sheet):
    """A sheet of 0.3 mm that the roller wears through after some strokes."""
    outline = (
        "[[edge]]\nname = 'bottom'\npoints = [[0, 0]]\n[[edge]]\nname = 'right'\npoints = [[2, 0]]\n"
        "[[edge]]\nname = 'top'\npoints = [[2, 0.3], [1.75, 0.3], [1.5, 0.3], [1.25, 0.3], [1, 0.3], [0.75, 0.3], "
        "[0.5, 0.3], [0.25, 0.3]]\n[[edge]]\nname = 'left'\npoints = [[0, 0.3]]\n"
    )
    return write_sheet(
        tmp_path,
        ("centre = [2.0, 3.99], radius = 2.0", "centre = [1.0, 0.79], radius = 0.5"),
        ("1.0e-3", "1.0e-2"),
        ("strokes = 4", "strokes = 100"),
        ("coarse = 0.5", "coarse = 0.1"),
        ("mounting = 0.2", "mounting = 0.1"),
        ("patch = 0.2", "patch = 0.05"),
        outline=outline,
    )


def test_worn_through_gives_up_with_place_stroke_and_what_it_had(tmp_path, through):
    scene = read_scene(through)
    result = run(scene, out=tmp_path / "out", throw=False)
    assert result.status == GAVE_UP
    assert isinstance(result.error, NgwearError)
    done = result.summary["strokes"]
    assert 0 < done < 100
    rows = rows_of(tmp_path / "out")
    assert int(rows[-1]["stroke [-]"]) == done, "what it had is saved"
    depth = result.summary["maximum depth [mm]"]
    assert 0.1 < depth < 0.3
    assert summary_of(tmp_path / "out")["status"] == GAVE_UP
    assert {p.name for p in (tmp_path / "out").iterdir()} >= FILES | {"history.png"}
    assert re.search(rf"after stroke {done}\b", result.message), result.message


def test_giving_up_raises_if_asked_to_and_saves_before(tmp_path, sheet, monkeypatch):
    stop_after(monkeypatch, 2, GeometryError("the section is worn through near [1, 2]"))
    with pytest.raises(GeometryError, match="worn through near"):
        run(sheet, out=tmp_path / "out", figures=False)
    summary = summary_of(tmp_path / "out")
    assert summary["status"] == GAVE_UP
    assert summary["strokes"] == 2
    assert "worn through near" in summary["message"]


def test_failed_jump_is_taken_back_and_halved(tmp_path, write_sheet, monkeypatch, caplog):
    """A step that fails once leaves no trace but a retry."""
    scene = read_scene(jumping(tmp_path, write_sheet))
    real, failed = WearStep.apply, []

    def take(self):
        if self.sliding.distance > 10 and not failed:
            failed.append(self.state.strokes)
            real(self)
            raise GeometryError("made to fail")
        return real(self)

    monkeypatch.setattr(WearStep, "apply", take)
    with caplog.at_level(logging.INFO):
        result = run(scene, figures=False)
    assert failed
    assert "made to fail" in caplog.text
    assert result.status == COMPLETED
    assert result.summary["retries"] >= 1
    strokes = [row["stroke [-]"] for row in result.recorder.rows]
    assert strokes == sorted(strokes)
    worn = result.summary["worn area by the law [mm^2]"]
    assert worn == pytest.approx(1e-3 * 0.5 * (8 * 10 + 8 * 5), rel=0.02)


def test_checkpoint_holds_state_and_records(finished, sheet):
    state, recorder = load(Folder(finished, sheet, resume=True), sheet)
    assert state.strokes == 4
    assert [row["stroke [-]"] for row in recorder.rows] == [0, 1, 2, 3, 4]


def test_vtk_on_request(tmp_path, sheet):
    program = replace(sheet.program, cycle=(replace(sheet.program.cycle[0], name="to/fro: 1"),))
    scene = replace(sheet, save=Save(vtk=True), program=program)
    run(scene, out=tmp_path / "out", figures=False)
    (file,) = (tmp_path / "out").glob("stroke_*.vtu")
    assert file.name.startswith("stroke_4_to_fro_ 1"), "a name that every platform allows"
    content = file.read_bytes()
    assert b"displacement" in content
    assert b"volumetric_stress" in content


def worn_deep(folder, write_sheet, remesh):
    """The small scene worn to half its thickness, with the nodes that follow it."""
    changes = [("1.0e-3", "3.2e-2"), ("coarse = 0.5", "coarse = 0.3"), ("patch = 0.2", "patch = 0.15")]
    choice = ('step = "each"', f'step = "each"\nremesh = "{remesh}"')
    return write_sheet(folder, ("strokes = 4", "strokes = 12"), *changes, choice)


def test_nodes_move_to_their_limit_and_hand_over_to_a_new_mesh(tmp_path, write_sheet):
    meshes, depths = {}, {}
    for remesh in ("due", "limit"):
        result = run(read_scene(worn_deep(tmp_path, write_sheet, remesh)), figures=False)
        assert result.status == COMPLETED
        assert result.summary["error estimates"]["area against the law [-]"] < 1e-6
        first, last = result.recorder.rows[0], result.recorder.rows[-1]
        meshes[remesh] = last["remeshes [-]"] - first["remeshes [-]"]
        depths[remesh] = result.summary["maximum depth [mm]"]
    assert meshes["limit"] == 1
    assert meshes["due"] > 1
    assert depths["limit"] == pytest.approx(depths["due"], rel=0.01)


def test_used_up_elements_end_the_run_if_no_new_mesh_is_wanted(tmp_path, write_sheet, capsys):
    out = tmp_path / "out"
    assert main(["run", str(worn_deep(tmp_path, write_sheet, "never")), "--out", str(out), "--quiet", "--alone"]) == 3
    summary = summary_of(out)
    assert summary["status"] == GAVE_UP
    assert 0 < summary["strokes"] < 12
    found = re.search(r"the top layer of elements is used up at a depth of ([\d.]+) mm", summary["message"])
    assert float(found[1]) == pytest.approx(summary["maximum depth [mm]"], rel=0.02)
    assert "wear.remesh = 'limit' or 'due'" in summary["message"]
    assert "top layer" in capsys.readouterr().err
    assert {p.name for p in out.iterdir()} >= FILES | {"history.png"}
    assert int(rows_of(out)[-1]["stroke [-]"]) == summary["strokes"]


def test_a_mesh_that_stays_is_fine_wherever_the_contact_may_come(tmp_path, write_sheet):
    """Half width of the contact at the end: the outline's elements there are as short as in the first contact."""
    scene = read_scene(worn_deep(tmp_path, write_sheet, "never"))
    state = Stepper(scene).start()
    lengths = state.contour.lengths[state.contour.on(("top",))]
    points = state.contour.points[state.contour.on(("top",))]
    assert lengths[abs(points[:, 0] - 2.0) < 1.5].max() < 1.5 * scene.accuracy.patch


def test_surface_that_never_touches_is_refused(tmp_path, write_sheet):
    scene = read_scene(write_sheet(tmp_path, ("force = 0.5\n", ""), ("3.99", "4.1")))
    with pytest.raises(SceneError, match=r"'roller'.*touches its edges in no stroke.*move it closer"):
        run(scene, figures=False)


def test_jumps_of_a_fixed_length(sheet):
    """Seven cycles in threes, whatever the error; the last is what is left."""
    wear = replace(sheet.wear, step="fixed", max_jump=3)
    result = run(replace(sheet, wear=wear, program=replace(sheet.program, strokes=7)), figures=False)
    assert [row["strokes in one solve [-]"] for row in result.recorder.rows] == [0, 3, 3, 1]


def test_a_jump_of_a_fixed_length_that_fails_is_halved(sheet, monkeypatch):
    """Whatever takes more than two strokes at once fails."""
    real = Stepper._step

    def step(self, state, cycles):
        if cycles > 2:
            raise ConvergenceError("no equilibrium")
        return real(self, state, cycles)

    monkeypatch.setattr(Stepper, "_step", step)
    wear = replace(sheet.wear, step="fixed", max_jump=4)
    result = run(replace(sheet, wear=wear, program=replace(sheet.program, strokes=5)), figures=False)
    assert [row["strokes in one solve [-]"] for row in result.recorder.rows] == [0, 2, 1, 2]
    assert result.summary["retries"] >= 2


@pytest.mark.parametrize(("most", "hardest"), [(1, 1 / 512), (4, 1 / 16)])
def test_hard_ways_are_for_single_strokes(sheet, monkeypatch, most, hardest):
    """A jump is cut instead."""
    walks, real = [], stroke_solve.relax
    monkeypatch.setattr(stroke_solve, "settle", lambda *_: Report(Outcome.STALLED))

    def relax(problem, options):
        walks.append(options.smallest)
        return real(problem, options)

    monkeypatch.setattr(stroke_solve, "relax", relax)
    wear = replace(sheet.wear, step="fixed", max_jump=most)
    scene = replace(sheet, wear=wear, program=replace(sheet.program, strokes=4))
    hand = Stepper(scene)
    hand.advance(hand.start())
    assert walks[-1] == hardest
