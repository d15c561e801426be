import json
import os
import subprocess
import sys
from types import SimpleNamespace

import pytest

from ngwear.cli import BAD_INPUT, GAVE_UP, OK, main
from ngwear.files.result_folder import CHECKPOINT, FIELDS, SERIES, SUMMARY
from ngwear.loop.stepper import Stepper
from ngwear.verify import CASES, Case, Check

INTERRUPTED = 130


def run(file, out, *more):
    """Without the companion runs, which begin as another process even for a scene that is refused."""
    return main(["run", str(file), "--out", str(out), "--quiet", "--alone", *more])


def test_run_reaches_its_end(tmp_path, sheet_file, capsys):
    assert main(["run", str(sheet_file), "--out", str(tmp_path / "out")]) == OK
    shown = capsys.readouterr().out
    assert "maximum depth [mm]" in shown
    assert "solves" in shown
    assert str(tmp_path / "out") in shown
    assert {p.name for p in (tmp_path / "out").iterdir()} >= {SERIES, FIELDS, SUMMARY, CHECKPOINT}


def test_quiet_is_quiet(tmp_path, write_sheet):
    """In a process of its own: NGSolve tells one that has made thousands of forms of timers."""
    scene = write_sheet(tmp_path, ("strokes = 4", "strokes = 1"))
    command = [sys.executable, "-m", "ngwear", "run", str(scene), "--out", str(tmp_path / "out"), "--quiet", "--alone"]
    shown = subprocess.run(command, capture_output=True, text=True, check=True)
    assert (shown.stdout, shown.stderr) == ("", "")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("friction = 0.1", "friction = -0.1", "contact 'roller'.friction = -0.1: must be at least 0"),
        ('edges = ["top"]', 'edges = ["lip"]', "the outline has no such edge"),
        ("friction = 0.1", "frictoin = 0.1", "contact[0].frictoin = 0.1: unknown key"),
        ("sheet.toml", "nowhere.toml", "there is no such outline file"),
        ("[2.0, 3.99]", "[2.0, 2.0]", "wrong side"),
    ],
)
def test_bad_scene_ends_with_2_and_one_line(tmp_path, write_sheet, capsys, old, new, message):
    assert run(write_sheet(tmp_path, (old, new)), tmp_path / "out") == BAD_INPUT
    shown = capsys.readouterr()
    assert shown.out == ""
    assert message in shown.err
    assert shown.err.startswith("ngwear: ")
    assert shown.err.count("\n") == 1
    assert not (tmp_path / "out").exists(), "a bad scene leaves nothing behind"


def test_missing_scene_file(tmp_path, capsys):
    assert main(["run", str(tmp_path / "nowhere.toml"), "--out", str(tmp_path / "out")]) == BAD_INPUT
    assert "nowhere.toml" in capsys.readouterr().err


def test_unusable_arguments_end_with_2(capsys):
    for arguments in ([], ["run"], ["run", "a.toml"], ["fly"]):
        with pytest.raises(SystemExit) as found:
            main(arguments)
        assert found.value.code == BAD_INPUT
    capsys.readouterr()


def test_folder_with_a_run_is_not_overwritten(finished, sheet_file, capsys):
    before = {p.name: p.read_bytes() for p in finished.iterdir()}
    assert run(sheet_file, finished) == BAD_INPUT
    assert "already holds a run: continue it with --resume, or give another folder" in capsys.readouterr().err
    assert {p.name: p.read_bytes() for p in finished.iterdir()} == before


def test_resume_with_another_scene(tmp_path, finished, write_sheet, capsys):
    other = write_sheet(tmp_path / "other", ("force = 0.5", "force = 0.6"))
    assert run(other, finished, "--resume") == BAD_INPUT
    assert "holds a run of another scene" in capsys.readouterr().err


def test_resume_with_a_damaged_checkpoint(finished, sheet_file, capsys):
    (finished / CHECKPOINT).write_bytes(b"\x80\x05 not a pickle")
    assert run(sheet_file, finished, "--resume") == BAD_INPUT
    assert "checkpoint.npz cannot be read" in capsys.readouterr().err


def test_out_is_a_file_or_lies_in_one(tmp_path, sheet_file, capsys):
    file = tmp_path / "file"
    file.write_text("mine")
    assert run(sheet_file, file) == BAD_INPUT
    assert "is a file; give a folder" in capsys.readouterr().err
    assert run(sheet_file, file / "out") == BAD_INPUT
    assert "cannot be made: Not a directory" in capsys.readouterr().err
    assert file.read_text() == "mine"


def test_out_without_permission(tmp_path, sheet_file, capsys, monkeypatch):
    (tmp_path / "out").mkdir()
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    assert run(sheet_file, tmp_path / "out") == BAD_INPUT
    assert "cannot be written to: no permission" in capsys.readouterr().err


def test_full_disk_ends_with_2(tmp_path, sheet_file, capsys, monkeypatch):
    def full(handle):
        raise OSError(28, os.strerror(28))

    monkeypatch.setattr(os, "fsync", full)
    assert run(sheet_file, tmp_path / "out") == BAD_INPUT
    assert "No space left on device" in capsys.readouterr().err


def test_giving_up_ends_with_3_and_says_where_the_results_are(tmp_path, write_sheet, capsys):
    assert run(write_sheet(tmp_path, ("force = 0.5", "force = 500")), tmp_path / "out") == GAVE_UP
    shown = capsys.readouterr().err
    assert "gave up: " in shown
    assert "no equilibrium" in shown
    assert str(tmp_path / "out") in shown
    assert json.loads((tmp_path / "out" / SUMMARY).read_text())["status"] == "gave up"


def test_interrupt_keeps_what_there_is(tmp_path, sheet_file, capsys, monkeypatch):
    def interrupted(self, state):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(Stepper, "advance", interrupted)
        assert run(sheet_file, tmp_path / "out") == INTERRUPTED
    assert "interrupted; continue with --resume" in capsys.readouterr().err
    assert run(sheet_file, tmp_path / "out", "--resume") == OK


def test_plot_draws_again(finished, capsys):
    for picture in finished.glob("*.png"):
        picture.unlink()
    assert main(["plot", str(finished)]) == OK
    drawn = capsys.readouterr().out.split()
    assert len(drawn) == 5
    for path in drawn:
        with open(path, "rb") as file:
            assert file.read(8) == b"\x89PNG\r\n\x1a\n"


def test_plot_of_nothing_or_of_a_damaged_file(tmp_path, finished, capsys):
    assert main(["plot", str(tmp_path)]) == BAD_INPUT
    assert "result.h5 does not exist" in capsys.readouterr().err
    file = finished / FIELDS
    file.write_bytes(file.read_bytes()[:2000])
    assert main(["plot", str(finished)]) == BAD_INPUT
    assert "cannot be read as a result of ngwear" in capsys.readouterr().err


def test_explain_names_what_is_in_and_what_is_left_out(sheet_file, capsys):
    assert main(["explain", str(sheet_file), "--json"]) == OK
    told = json.loads(capsys.readouterr().out)
    assert told["kind"] == "plane strain"
    assert "friction at 'roller'" in told["effects"]
    assert "fluid pressure" not in told["effects"]
    assert "LU" in told["solver"]
    assert told["numbers"]["K/G [-]"] == pytest.approx(100.0)
    assert main(["explain", str(sheet_file)]) == OK
    assert "left out: viscosity" in capsys.readouterr().out


def test_a_reader_that_has_seen_enough_is_no_error(sheet_file):
    """As ``| head`` is, which closes its end."""
    code = f"import sys; from ngwear.cli import main; sys.exit(main(['explain', {str(sheet_file)!r}]))"
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run([sys.executable, "-c", code], stdout=write, stderr=subprocess.PIPE, text=True)
    os.close(write)
    assert (done.returncode, done.stderr) == (141, "")


def test_verify_of_an_unknown_case(capsys):
    assert main(["verify", "moon"]) == BAD_INPUT
    assert "moon" in capsys.readouterr().err


def test_verify_prints_each_check_once_it_is_made(capsys, monkeypatch):
    told = []

    def run():
        for value in (1.0, 1.5):
            yield Check("moon", "mass [-]", value, 1.0, 0.1, 0.0)
            told.append(capsys.readouterr().out)

    monkeypatch.setitem(CASES, "moon", Case("moon", 0.0, "its mass"))
    monkeypatch.setitem(sys.modules, "moon", SimpleNamespace(run=run))
    assert main(["verify", "moon", "--json"]) == GAVE_UP
    assert [check["value"] for check in json.loads("".join(told) + capsys.readouterr().out)] == [1.0, 1.5]
    assert all('"mass [-]"' in part for part in told)
    told.clear()
    assert main(["verify", "moon"]) == GAVE_UP
    assert [part.split()[0] for part in told] == ["ok", "FAIL"]


def test_help_and_bad_scenes_load_no_solver(tmp_path):
    code = (
        "import sys, ngwear, ngwear.cli as cli\n"
        "for arguments in (['--help'], ['run', '--help'], ['--version']):\n"
        "    try:\n        cli.main(arguments)\n    except SystemExit as end:\n        assert end.code == 0\n"
        f"assert cli.main(['run', {str(tmp_path / 'nowhere.toml')!r}, '--out', 'x']) == 2\n"
        "heavy = {'ngsolve', 'netgen', 'matplotlib', 'h5py'} & set(sys.modules)\n"
        "sys.exit(f'loaded: {heavy}' if heavy else 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "friction and abrasive wear" in done.stdout.lower()


def test_importing_the_package_loads_nothing_heavy():
    code = "import sys, ngwear, ngwear.scene.scene; sys.exit('ngsolve' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_verify_lists_its_cases_and_runs_none(capsys):
    assert main(["verify", "--list"]) == OK
    assert "torn_seal" in capsys.readouterr().out
