"""Checkpoints: all of a run to the last bit, and nothing else, whatever lies in the folder."""

import csv
import json
import os
import pickle
import zipfile
from dataclasses import replace

import numpy as np
import pytest
from conftest import REMEMBERS
from valve import valve

from ngwear.cli import BAD_INPUT, main
from ngwear.equilibrium.linear import has_pardiso
from ngwear.errors import ResultError
from ngwear.files.archive import Format, packed, write
from ngwear.files.result_folder import CHECKPOINT, OLD_CHECKPOINT, SERIES
from ngwear.laws.damage import Fatigue
from ngwear.loop.checkpoint import FORMAT, classes, load
from ngwear.loop.run import run
from ngwear.loop.stepper import Stepper
from ngwear.results.recorder import Folder
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.read_scene import read_scene
from ngwear.verify.material_book import torn_scene
from ngwear.verify.no_loss import scene as unlost

JUMPS = (("strokes = 4", "strokes = 12"), ('step = "each"', 'step = "jump"'))
WEARS = ("specific_wear_rate = 1.0e-3", "specific_wear_rate = 1.0e-3\ncounter_wear_rate = 1.0e-4")
STICKS = (("force = 0.5", "force = 0.5\nsticks = true"), ("travel = 10.0", "travel = 0.02"))


def tiring():
    base = unlost("implicit", damage=Fatigue(critical=2.0, exponent=2.0))
    return replace(base, program=replace(base.program, strokes=4))


def two_pressures():
    """A ring with room to move that is never without fluid pressure."""
    ring = read_scene("geometries/o_ring/scene.toml")
    cycle = [replace(s, pressure=p) for s, p in zip(ring.program.cycle, (1.0, 3.0), strict=True)]
    return replace(ring, program=replace(ring.program, cycle=cycle, strokes=2000), accuracy=Accuracy(across=4.0))


def pockets():
    """A plate wears a lip before a pocket that keeps the fluid's pressure."""
    lip = valve("trapped", strokes=12)
    return replace(lip, contacts=[replace(lip.contacts[0], specific_wear_rate=1e-4, friction=0.05)])


def across(scene):
    return replace(scene, accuracy=Accuracy(across=4.0))


@pytest.fixture(
    params=[
        "plain",
        "worn surface",
        "sticking",
        "elements across",
        "memory",
        "torn",
        "pockets",
        pytest.param("two pressures", marks=pytest.mark.slow),
        pytest.param("fatigue", marks=pytest.mark.slow),
    ]
)
def scene(request, tmp_path, write_sheet):
    def sheet(*changes):
        return read_scene(write_sheet(tmp_path / "scene", *changes))

    return {
        "plain": lambda: sheet(*JUMPS),
        "worn surface": lambda: sheet(WEARS),
        "sticking": lambda: sheet(*STICKS),
        "elements across": lambda: across(sheet()),
        "memory": lambda: sheet(*REMEMBERS),
        "torn": torn_scene,
        "pockets": pockets,
        "two pressures": two_pressures,
        "fatigue": tiring,
    }[request.param]()


def bits(state):
    """All that is stored of a state."""
    members = packed(state.to_data(), FORMAT, classes(state.stage.scene))
    return {name: array.tobytes() for name, array in members.items()}


def rows(folder):
    table = csv.DictReader((folder / SERIES).read_text().splitlines())
    return [{name: value for name, value in row.items() if "time" not in name} for row in table]


@pytest.mark.skipif(not has_pardiso(), reason="only PARDISO (the extra 'fast') repeats itself bit for bit")
def test_stopped_and_resumed_it_ends_bit_for_bit_as_in_one_go(scene, tmp_path):
    whole = run(scene, out=tmp_path / "whole", figures=False)
    seen = []

    def stop(state):
        seen.append(bits(state))
        if len(seen) == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(scene, out=tmp_path / "parts", figures=False, on_step=stop)
    state, recorder = load(Folder(tmp_path / "parts", scene, resume=True), scene)
    assert bits(state) == seen[-1]
    assert len(recorder.rows) == len(recorder.snapshots) == len(rows(tmp_path / "parts"))
    assert state.stage.scene == replace(scene, accuracy=state.stage.scene.accuracy)
    parts = run(scene, out=tmp_path / "parts", resume=True, figures=False)
    assert rows(tmp_path / "parts") == rows(tmp_path / "whole")
    assert bits(parts.state) == bits(whole.state)


@pytest.fixture
def begun(tmp_path, sheet):
    """The folder of a run that was stopped once it was mounted."""

    def stop(state):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(sheet, out=tmp_path / "begun", figures=False, on_step=stop)
    return tmp_path / "begun"


DAMAGE = {
    "truncated": lambda data: data[: len(data) // 2],
    "cut short": lambda data: data[:-100],
    "empty": lambda data: b"",
    "garbage": lambda data: bytes(range(256)) * 40,
    "overwritten": lambda data: data[:512] + bytes(len(data) - 512),
}
REFUSED = r"checkpoint\.npz cannot be read as a checkpoint \(.*\); remove the folder and run again"


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_one_is_refused_with_the_remedy(begun, sheet, damage):
    file = begun / CHECKPOINT
    file.write_bytes(DAMAGE[damage](file.read_bytes()))
    with pytest.raises(ResultError, match=REFUSED):
        load(Folder(begun, sheet, resume=True), sheet)


class Bomb:
    """A pickle that runs a program when it is read."""

    def __reduce__(self):
        return os.mkdir, ("exploded",)


@pytest.mark.parametrize("make", ["pickle", "array of pickles"])
def test_a_crafted_one_is_refused_and_never_executed(begun, sheet_file, make, monkeypatch, capsys):
    monkeypatch.chdir(begun)
    if make == "pickle":
        (begun / CHECKPOINT).write_bytes(pickle.dumps(Bomb()))
    else:
        np.savez(begun / CHECKPOINT, about=np.array([Bomb()], dtype=object), tree=np.array([Bomb()], dtype=object))
    assert main(["run", str(sheet_file), "--out", str(begun), "--quiet", "--resume"]) == BAD_INPUT
    assert "cannot be read as a checkpoint" in capsys.readouterr().err
    assert not (begun / "exploded").exists()


def rewritten(file, change):
    """Write a checkpoint with its tree changed."""
    with zipfile.ZipFile(file) as archive:
        arrays = {
            name.removesuffix(".npy"): np.lib.format.read_array(archive.open(name)) for name in archive.namelist()
        }
    tree = json.loads(arrays["tree"].tobytes())
    change(tree["dict"])
    arrays["tree"] = np.frombuffer(json.dumps(tree).encode(), dtype=np.uint8)
    with file.open("wb") as opened:
        write(opened, arrays)


CHANGES = {
    "no state": lambda tree: tree.pop("state"),
    "no phases": lambda tree: tree["state"]["dict"].pop("phases"),
    "a field of a later version": lambda tree: tree["state"]["dict"]["ledger"]["object"][1].update(more=1),
    "another class": lambda tree: tree["state"]["dict"]["ledger"]["object"].__setitem__(0, "Popen"),
    "a body without a mesh": lambda tree: tree["state"]["dict"]["body"]["object"][1].pop("mesh"),
    "a mesh of other points": lambda tree: tree["state"]["dict"]["body"]["object"][1]["mesh"]["dict"]["triangles"][
        "array"
    ].__setitem__(2, [1, 3]),
    "records of something else": lambda tree: tree["recorder"]["dict"].update(nonsense=[]),
}


@pytest.mark.parametrize("change", CHANGES)
def test_data_that_do_not_fit_together_are_refused(begun, sheet, change):
    rewritten(begun / CHECKPOINT, CHANGES[change])
    with pytest.raises(ResultError, match=REFUSED):
        load(Folder(begun, sheet, resume=True), sheet)


@pytest.mark.parametrize("resume", [[], ["--resume"]], ids=["anew", "resume"])
def test_a_folder_of_the_first_version_says_so_and_what_to_do(begun, sheet_file, resume, capsys):
    (begun / CHECKPOINT).unlink()
    (begun / OLD_CHECKPOINT).write_bytes(pickle.dumps(Bomb()))
    assert main(["run", str(sheet_file), "--out", str(begun), "--quiet", *resume]) == BAD_INPUT
    told = capsys.readouterr().err
    assert "holds a run of ngwear 0.1 (checkpoint.pkl)" in told
    assert "run the scene again in another folder" in told
    assert not os.path.exists("exploded")


def test_one_of_a_later_version_says_so(begun, sheet):
    later = replace(FORMAT, version=FORMAT.version + 1)
    with (begun / CHECKPOINT).open("wb") as file:
        write(file, packed({}, later))
    with pytest.raises(ResultError, match=rf"a checkpoint of version {later.version}.*reads version {FORMAT.version}"):
        load(Folder(begun, sheet, resume=True), sheet)


def test_another_file_of_ngwear_is_none(begun, sheet):
    with (begun / CHECKPOINT).open("wb") as file:
        write(file, packed(1.0, Format("result of a sweep", FORMAT.version, "")))
    with pytest.raises(ResultError, match="is not a checkpoint of ngwear: its format is 'ngwear result of a sweep'"):
        load(Folder(begun, sheet, resume=True), sheet)


def test_a_folder_without_a_run_has_nothing_to_go_on_with(tmp_path, sheet):
    assert load(Folder(tmp_path / "new", sheet, resume=True), sheet) is None


def test_elements_are_kept_by_the_scene_that_loses_some_alone():
    state = Stepper(torn_scene()).start()
    assert [cls.__name__ for cls in classes(state.stage.scene)][-1] == "ElementBody"
    assert "CycleMemory" not in [cls.__name__ for cls in classes(state.stage.scene)]
