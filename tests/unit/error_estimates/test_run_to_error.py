import json
from dataclasses import replace

import pytest

from ngwear.cli import main
from ngwear.error_estimates import run_to_error as adaptive
from ngwear.error_estimates.coarser_runs import COARSEST, FILE
from ngwear.error_estimates.run_to_error import ACROSS, LEVELS, at_level, first_across, next_across, run_to_error
from ngwear.errors import ResultError, SceneError
from ngwear.loop.stepper import Stepper
from ngwear.results.quantities_of_interest import DEPTH
from ngwear.results.recorder import fingerprint
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.options import Wear
from ngwear.verify.no_loss import scene

ASKED = 4e-3


def to(error):
    block = scene("implicit")
    few = replace(block.program, strokes=3)
    return replace(block, deactivation=None, wear=Wear(), accuracy=Accuracy(error=error), program=few)


@pytest.fixture
def coarse_first(monkeypatch):
    """Begin so coarse that the first level cannot do."""
    monkeypatch.setattr(adaptive, "first_across", lambda error, peak_error=None: 2.0)


@pytest.mark.parametrize(
    ("error", "across"),
    [(0.3, 2.5), (0.05, 2.5), (0.02, 2.5), (0.01, 4), (0.005, 8), (0.0025, 16), (0.002, 32), (0.001, 32)],
)
def test_the_first_level_by_the_error(error, across):
    assert first_across(error) == across


@pytest.mark.parametrize(
    ("across", "stated", "error", "found"),
    [
        (6, 0.009, 0.01, None),
        (6, 0.01, 0.01, None),
        (6, 0.011, 0.01, 12),
        (6, 0.02, 0.01, 12),
        (6, 0.021, 0.01, 24),
        (6, 0.5, 0.01, 24),
        (6, None, 0.01, 12),
        (96, 0.5, 0.01, 192),
        (192, 0.5, 0.01, None),
        (192, None, 0.01, None),
    ],
)
def test_the_next_level_by_what_one_states(across, stated, error, found):
    assert next_across(across, stated, error) == found


@pytest.mark.slow
def test_levels_are_run_until_one_states_less(tmp_path, coarse_first):
    result = run_to_error(to(ASKED), out=tmp_path)
    levels = result.summary["levels"]
    assert len(levels) > 1
    assert [level[ACROSS] for level in levels] == sorted({level[ACROSS] for level in levels})
    assert all(level[DEPTH] > ASKED for level in levels[:-1])
    assert levels[-1][DEPTH] <= ASKED
    assert result.summary["error asked for [-]"] == ASKED
    assert result.summary["error estimates"][DEPTH] == levels[-1][DEPTH]
    total = sum(level["CPU time [s]"] for level in levels)
    assert result.summary["CPU time of all levels [s]"] == pytest.approx(total, abs=1e-3)
    assert json.loads((tmp_path / "summary.json").read_text()) == result.summary
    assert (tmp_path / "history.png").exists()
    for level in levels[:-1]:
        earlier = tmp_path / LEVELS / f"{level[ACROSS]:g}"
        assert json.loads((earlier / "summary.json").read_text())["error estimates"][DEPTH] == level[DEPTH]
    last, before = levels[-1][ACROSS], levels[-2][ACROSS]
    name = FILE if last == 2 * before else COARSEST
    told = json.loads((tmp_path / name).read_text())
    assert told["elements"] == json.loads((tmp_path / LEVELS / f"{before:g}" / "summary.json").read_text())["elements"]


GOOD = {"elements across [-]": 2.0, "parts of a stroke [-]": 1}
NOTES = {
    "no JSON": "{",
    "a list": "[1, 2]",
    "no levels": {"levels": []},
    "levels that are none": {"levels": [3]},
    "a path for elements across": {"levels": [GOOD | {"elements across [-]": "../../elsewhere"}]},
    "a path for parts": {"levels": [GOOD | {"parts of a stroke [-]": "/../../../elsewhere"}]},
}


@pytest.mark.parametrize("notes", NOTES)
def test_crafted_notes_of_levels_are_refused_and_move_nothing(tmp_path, notes):
    out, content = tmp_path / "out", NOTES[notes]
    out.mkdir()
    (out / "mine.txt").write_text("mine")
    text = content if isinstance(content, str) else json.dumps({"scene": fingerprint(to(ASKED))} | content)
    (out / "levels.json").write_text(text)
    with pytest.raises(ResultError, match=r"levels\.json cannot be read .*; remove the folder and run again"):
        run_to_error(to(ASKED), out=out, resume=True)
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["levels.json", "mine.txt", "out"]


@pytest.mark.slow
def test_interrupted_it_goes_on_where_it_was(tmp_path, coarse_first, monkeypatch):
    whole = run_to_error(to(ASKED), out=tmp_path / "whole").summary
    steps, real = [0], Stepper.advance

    def advance(self, state):
        steps[0] += 1
        if steps[0] in (2, 5):
            raise KeyboardInterrupt
        return real(self, state)

    monkeypatch.setattr(Stepper, "advance", advance)
    for _ in range(2):
        with pytest.raises(KeyboardInterrupt):
            run_to_error(to(ASKED), out=tmp_path / "cut", resume=True)
    resumed = run_to_error(to(ASKED), out=tmp_path / "cut", resume=True).summary
    assert [level[ACROSS] for level in resumed["levels"]] == [level[ACROSS] for level in whole["levels"]]
    assert resumed["maximum depth [mm]"] == pytest.approx(whole["maximum depth [mm]"], rel=1e-9)
    again = run_to_error(to(ASKED), out=tmp_path / "cut", resume=True).summary
    assert again["maximum depth [mm]"] == resumed["maximum depth [mm]"]
    with pytest.raises(ResultError, match="holds a run of another scene"):
        run_to_error(to(0.003), out=tmp_path / "cut", resume=True)
    with pytest.raises(ResultError, match="already holds a run"):
        run_to_error(to(ASKED), out=tmp_path / "cut")


def test_a_finest_level_that_is_not_enough_warns(tmp_path, monkeypatch):
    monkeypatch.setattr(adaptive, "MOST_ACROSS", 3.0)
    monkeypatch.setattr(adaptive, "first_across", lambda error, peak_error=None: 3.0)
    summary = run_to_error(to(0.001), out=tmp_path).summary
    assert summary["levels"][-1][DEPTH] > 0.001
    assert "0.001 was asked for" in summary["warnings"][-1]


def test_a_single_run_is_no_answer():
    with pytest.raises(SceneError, match="needs several runs"):
        Stepper(to(0.01))


def test_a_level_keeps_what_is_not_about_the_error():
    asked = replace(to(0.01), accuracy=Accuracy(error=0.01, order=3, grading=0.4, folding_error=0.1))
    level = at_level(asked, 5.0).accuracy
    assert level == Accuracy(across=5.0, order=3, grading=0.4, folding_error=0.1)


@pytest.mark.parametrize(
    ("asked", "told"),
    [("rough", "accuracy = 'rough': must be one of"), ("1e-7", "is below 0.001"), ("2", "must be below 1")],
)
def test_the_command_line_refuses(asked, told, sheet_file, tmp_path, capsys):
    assert main(["run", str(sheet_file), "--out", str(tmp_path / "out"), "--accuracy", asked]) == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize(("asked", "more"), [("draft", ["--alone"]), pytest.param("0.05", [], marks=pytest.mark.slow)])
def test_the_command_line_takes_a_preset_and_an_error(write_sheet, tmp_path, asked, more):
    sheet, out = str(write_sheet(tmp_path, ("strokes = 4", "strokes = 2"))), tmp_path / "out"
    assert main(["run", sheet, "--out", str(out), "--accuracy", asked, "--quiet", *more]) == 0
    assert ("levels" in json.loads((out / "summary.json").read_text())) == (asked == "0.05")
