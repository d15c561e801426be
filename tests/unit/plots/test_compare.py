"""Two runs side by side in a picture."""

import shutil

import h5py
import pytest

from ngwear.cli import BAD_INPUT, OK, main
from ngwear.plots.compare import compare
from ngwear.results.recorder import FIELDS


def test_two_runs_of_one_outline_are_drawn(finished, tmp_path, capsys):
    other = shutil.copytree(finished, tmp_path / "other")
    assert main(["plot", str(finished), "--against", str(other)]) == OK
    path = finished / "comparison.png"
    assert capsys.readouterr().out.split() == [str(path)]
    assert path.stat().st_size > 10_000


def test_runs_of_different_outlines_are_not_compared(finished, tmp_path, capsys):
    other = shutil.copytree(finished, tmp_path / "other")
    with h5py.File(other / FIELDS, "a") as h5:
        h5["outline/points [mm]"][...] += 0.1
    assert main(["plot", str(finished), "--against", str(other)]) == BAD_INPUT
    assert "different outlines" in capsys.readouterr().err


def test_a_picture_that_cannot_be_written_is_said_so(finished, monkeypatch):
    from ngwear.errors import ResultError

    (finished / "comparison.png").mkdir()
    with pytest.raises(ResultError, match="cannot be written"):
        compare(finished, finished)
