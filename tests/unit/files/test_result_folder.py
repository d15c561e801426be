"""A folder's files: whole, of usual modes, without subnormal numbers."""

import csv
import json
import math
import os
import stat
import subprocess
import sys

import numpy as np
import pytest

from ngwear.files.result_folder import SERIES, SUMMARY, OutFolder
from ngwear.files.subnormal import SMALLEST, without_subnormals

SMALL = (5e-324, -1e-310, SMALLEST / 2)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such modes")
@pytest.mark.parametrize("mask", [0o022, 0o077, 0o002])
def test_files_have_the_modes_of_any_other_file(tmp_path, mask):
    folder = OutFolder(tmp_path, "", resume=True)
    before = os.umask(mask)
    try:
        folder.replace("a.bin", lambda file: file.write(b"new"))
        folder.replace("a.bin", lambda file: file.write(b"newer"))
        (tmp_path / "other").write_text("")
    finally:
        os.umask(before)
    assert (tmp_path / "a.bin").read_bytes() == b"newer"
    assert stat.S_IMODE((tmp_path / "a.bin").stat().st_mode) == stat.S_IMODE((tmp_path / "other").stat().st_mode)


def test_all_files_of_a_run_have_the_same_modes(finished):
    assert len({stat.S_IMODE(file.stat().st_mode) for file in finished.iterdir()}) == 1


def test_numbers_below_the_smallest_normal_one_become_0():
    values = (*SMALL, SMALLEST, -SMALLEST, 0.0, -0.0, math.inf, 1.0)
    expected = [0.0, 0.0, 0.0, SMALLEST, -SMALLEST, 0.0, -0.0, math.inf, 1.0]
    found = without_subnormals({"a": [*values], "b": (np.array(values), "text", 3, None, True)})
    assert list(map(str, found["a"])) == list(map(str, expected))
    assert list(map(str, found["b"][0].tolist())) == list(map(str, expected))
    assert found["b"][1:] == ("text", 3, None, True)
    assert math.isnan(without_subnormals(math.nan))
    whole, short = np.arange(3), np.array([1e-40, 1.0], dtype=np.float32)
    assert without_subnormals(whole) is whole
    assert without_subnormals(short).tolist() == [0.0, 1.0]
    assert without_subnormals(short).dtype == np.float32


def test_tables_and_json_hold_none(tmp_path):
    folder = OutFolder(tmp_path, "", resume=True)
    rows = [{"a [-]": value, "name [-]": "x"} for value in SMALL]
    folder.write_series(rows)
    folder.write_json(SUMMARY, {"inner": {"a [-]": SMALL[0]}, "list": [*SMALL]})
    read = list(csv.DictReader((tmp_path / SERIES).read_text().splitlines()))
    assert [row["a [-]"] for row in read] == ["0.0"] * 3
    assert json.loads((tmp_path / SUMMARY).read_text()) == {"inner": {"a [-]": 0.0}, "list": [0.0] * 3}
    assert rows[0]["a [-]"] == SMALL[0], "what is computed on stays as it is"


def test_peak_memory_counts_what_was_once_there():
    code = "\n".join(
        [
            "import numpy as np",
            "from ngwear.files.peak_memory import peak_memory",
            "before = peak_memory()",
            "block = np.ones(60 * 2**17)",
            "assert block[0] == 1.0",
            "del block",
            "print(before, peak_memory())",
        ]
    )
    # A process of its own: here, a test before this one may have taken more and given it back.
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    before, after = map(float, said.split())
    assert 10 < before < 50_000
    assert before + 30 < after < before + 600
