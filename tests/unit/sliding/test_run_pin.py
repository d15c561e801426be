"""Runs of a pin on a plate from the command line: files, resumption, pictures, and what is refused."""

import csv
import io
import json
from dataclasses import replace

import h5py
import numpy as np
import pytest

from ngwear.cli import BAD_INPUT, GAVE_UP, OK, main
from ngwear.errors import SceneError
from ngwear.materials import PronySeries
from ngwear.scene.read_scene import read_scene
from ngwear.sliding.pin import COARSER, slide_pin

SCENE = """
[scene]
kind = "pin on plate"
[material]
model = "mooney-rivlin"
c10 = 0.6
c01 = 0.15
bulk_modulus = 1500.0
[material.prony]
moduli = [1.0]
times = [1e-3]
reference = "long-term"
[pin]
load = 10.0
friction = 0.06
[program]
speeds = [100.0, 3000.0]
[accuracy]
patch = 1.6
column = 0.8
reach = 2.5
beside = 2.0
"""


def write(folder, text=SCENE):
    file = folder / "scene.toml"
    file.write_text(text, encoding="utf-8")
    return str(file)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pin")
    assert main(["run", write(folder), "--out", str(folder / "out"), "--quiet"]) == OK
    return folder


def test_files_of_a_run(finished):
    out = finished / "out"
    rows = list(csv.DictReader(io.StringIO((out / "series.csv").read_text(encoding="utf-8"))))
    assert [float(row["speed [mm/s]"]) for row in rows] == [100.0, 3000.0]
    assert all("[" in column for column in rows[0])
    summary = json.loads((out / "summary.json").read_text())
    assert summary["status"] == "completed"
    assert summary["maximum depth [mm]"] == pytest.approx(float(rows[0]["penetration [mm]"]))
    assert {"peak pressure [MPa]", "solves", "retries", "error estimates", "CPU time [s]"} <= set(summary)
    with h5py.File(out / "result.h5") as h5:
        assert h5["speeds/000/faces/pressure [MPa]"].shape == h5["speeds/000/faces/centres, undeformed [mm]"].shape[:1]
    assert {"friction.png", "contact.png", "sheet_slowest.png", "sheet_fastest.png"} <= {p.name for p in out.iterdir()}


def test_a_run_states_its_errors_and_draws_them(finished):
    from ngwear.plots.pin import friction_figure, read_pin

    read = read_pin(finished / "out")
    errors, series = read.errors, read.series
    assert errors == json.loads((finished / "out" / "summary.json").read_text())["error estimates"]
    fine, coarse = series["penetration [mm]"], series["penetration on the coarse mesh [mm]"]
    second_order = np.linalg.norm(fine - coarse) / (COARSER**2 - 1) / np.linalg.norm(fine)
    assert errors["maximum depth by mesh and time steps [-]"] == pytest.approx(second_order)
    folded = errors["stress by arms folded away [-]"]
    assert 0 <= folded <= 1e-3
    for name in ("maximum depth", "friction coefficient", "contact area", "peak pressure"):
        assert errors[f"{name} [-]"] == pytest.approx(errors[f"{name} by mesh and time steps [-]"] + folded)
        assert 0 < errors[f"{name} [-]"] < 1, name
    (band,) = friction_figure(read).axes[0].collections
    top = (1 + errors["friction coefficient [-]"]) * series["friction coefficient [-]"].max()
    assert band.get_paths()[0].vertices[:, 1].max() == pytest.approx(top)


@pytest.mark.rendered
def test_figures_are_drawn_again(finished, capsys):
    (finished / "out" / "friction.png").unlink()
    assert main(["plot", str(finished / "out")]) == OK
    assert "friction.png" in capsys.readouterr().out
    assert (finished / "out" / "friction.png").stat().st_size > 10_000


def test_folder_of_a_run_is_not_overwritten(finished, capsys):
    assert main(["run", write(finished), "--out", str(finished / "out"), "--quiet"]) == BAD_INPUT
    assert "--resume" in capsys.readouterr().err


def test_resumed_run_does_only_what_is_missing(finished):
    points = finished / "out" / "points"
    before = {p.name: p.stat().st_mtime_ns for p in points.iterdir()}
    next(points.iterdir()).unlink()
    assert main(["run", write(finished), "--out", str(finished / "out"), "--quiet", "--resume"]) == OK
    after = {p.name: p.stat().st_mtime_ns for p in points.iterdir()}
    assert set(after) == set(before)
    assert sum(after[name] != before[name] for name in before) == 1


def test_run_that_loses_a_speed_keeps_the_others(finished, tmp_path, capsys, monkeypatch):
    from ngwear.parallel.sweep import Failure, Outcome
    from ngwear.sliding import run_pin as module

    real = module.sweep

    def loses_one(*args, **kwargs):
        first, second = real(*args, **kwargs)
        return [first, Outcome(second.point, failure=Failure("ConvergenceError", "no steady state", ""))]

    monkeypatch.setattr(module, "sweep", loses_one)
    out = str(finished / "out")
    assert main(["run", write(finished), "--out", out, "--quiet", "--resume"]) == GAVE_UP
    assert "3000 mm/s: no steady state" in capsys.readouterr().err
    assert json.loads((finished / "out" / "summary.json").read_text())["speeds done [-]"] == 1


def test_explain_tells_the_arms(tmp_path, capsys):
    assert main(["explain", write(tmp_path), "--json"]) == OK
    found = json.loads(capsys.readouterr().out)
    assert found["kind"] == "pin on plate"
    assert list(found["arms of the memory"]) == ["0.001 s"]


def test_arms_that_relax_within_a_column_are_folded_and_told(tmp_path, capsys):
    two = SCENE.replace("times = [1e-3]", "times = [1e-8, 1e-3]").replace("moduli = [1.0]", "moduli = [1.0, 1.0]")
    assert two != SCENE
    assert main(["explain", write(tmp_path, two), "--json"]) == OK
    found = json.loads(capsys.readouterr().out)
    assert "1 to 1 of 2 arms" in found["effects"]["memory"]
    assert "relaxes at once" in found["arms of the memory"]["1e-08 s"]
    assert found["arms of the memory"]["0.001 s"].endswith(": kept")
    assert 0 < found["numbers"]["largest error of stress by arms left out [-]"] <= 1e-3


@pytest.mark.slow
def test_folding_changes_friction_by_no_more_than_its_bound(tmp_path):
    scene = read_scene(write(tmp_path))
    two = replace(scene.pin, series=PronySeries((1.0, 1.0), (2e-7, 1e-3)))
    folded, whole = (
        slide_pin(two, 3000.0, mesh=replace(scene.mesh, folding_error=error))[1].friction for error in (2e-2, 0.0)
    )
    assert folded == pytest.approx(whole, rel=2e-2)
    assert folded != whole


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("speeds = [100.0, 3000.0]", "speeds = [0.0]", r"program\.speeds\[0\]"),
        ("speeds = [100.0, 3000.0]", "speeds = [5.0, 5.0]", r"program\.speeds\[1\].*twice"),
        ("speeds = [100.0, 3000.0]", "speeds = []", r"program\.speeds"),
        ("speeds = [100.0, 3000.0]", "speeds = 5.0", r"program\.speeds.*list of numbers"),
        ("load = 10.0", "load = 10.0\ntrack_radius = 29.0", "track leaves the sheet"),
        ("load = 10.0", "load = -10.0", r"pin\.load"),
        ("load = 10.0", "loud = 10.0", r"pin\.loud.*unknown key"),
        ("patch = 1.6", "patch = 0.0", r"accuracy\.patch"),
        ("times = [1e-3]", "times = [-1e-3]", r"material\.prony\.times\[0\]"),
        ('kind = "pin on plate"', 'kind = "pin"', r"scene\.kind"),
    ],
)
def test_bad_input_names_the_place(tmp_path, old, new, place):
    with pytest.raises(SceneError, match=place):
        read_scene(write(tmp_path, SCENE.replace(old, new)))


def test_scene_without_memory_is_refused(tmp_path):
    start, end = SCENE.index("[material.prony]"), SCENE.index("[pin]")
    with pytest.raises(SceneError, match=r"material\.prony.*is missing"):
        read_scene(write(tmp_path, SCENE[:start] + SCENE[end:]))
