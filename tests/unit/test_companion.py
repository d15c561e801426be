import json
from dataclasses import replace

import numpy as np
import pytest

from ngwear import companion
from ngwear.companion import FILE, coarser, estimates, reading, run_stated
from ngwear.results import fingerprint
from ngwear.verify.no_loss import scene


@pytest.fixture(scope="module")
def stated(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    return folder, run_stated(scene("implicit"), out=folder)


def test_errors_by_hand():
    mine = {"depth": {"depth": 2.0}, "force": {"out": -3.0, "in": 0.1, "up": 0.0}, "nothing": {"leak": 0.0}, "none": {}}
    other = {
        "depth": {"depth": 2.2},
        "force": {"out": -3.0, "in": 0.4, "up": 0.0},
        "nothing": {"leak": 0.0},
        "none": {},
    }
    found = estimates(mine, other)
    assert found["depth"] == pytest.approx(0.1)
    assert found["force"] == pytest.approx(0.1), "of the largest force, not of one that vanishes"
    assert found["nothing"] == found["none"] == 0.0


def test_an_error_of_order_half_to_two_is_met_within_a_factor_of_three():
    for order, effectivity in ((0.5, 0.414), (1.0, 1.0), (1.5, 1.83), (2.0, 3.0)):
        exact, error = 3.0, 1e-5
        mine, other = ({"q": {"q": exact + error * edge**order}} for edge in (1.0, 2.0))
        assert estimates(mine, other)["q"] * exact / error == pytest.approx(effectivity, rel=2e-3)


def test_the_companion_is_coarser_in_every_setting():
    fine = scene("implicit")
    coarse = coarser(fine).accuracy
    assert coarse.patch == 2 * fine.accuracy.patch
    assert coarse.coarse == 2 * fine.accuracy.coarse
    assert coarse.mounting >= coarse.patch
    assert coarse.stress_error == pytest.approx(4 * fine.accuracy.stress_error)
    assert coarse.wear_error == pytest.approx(2 * fine.accuracy.wear_error)
    assert replace(coarser(fine), accuracy=fine.accuracy, save=fine.save) == fine


def test_a_run_states_the_error_of_all_that_is_read_off(stated):
    folder, result = stated
    errors = json.loads((folder / "summary.json").read_text())["error estimates"]
    assert errors == result.summary["error estimates"]
    other = companion.run_scene(coarser(scene("implicit")), figures=False)
    off = abs(other.summary["maximum depth [mm]"] / result.summary["maximum depth [mm]"] - 1)
    assert errors["maximum depth [-]"] == pytest.approx(off)
    for name in ("worn area [-]", "peak pressure [-]", "contact width [-]", "friction force [-]"):
        assert 0 < errors[name] < 0.5, name
    assert result.summary["solves of the companion"] == other.summary["solves"]
    read = reading(other.summary, other.recorder.rows)
    assert set(read["peak pressure [-]"]) == {f"{kind}: cylinder peak pressure [MPa]" for kind in ("forth", "back")}


def test_a_companion_that_has_ended_is_not_run_again(stated, monkeypatch):
    folder, result = stated
    monkeypatch.setattr(companion, "get_context", None)
    again = run_stated(scene("implicit"), out=folder, resume=True)
    assert again.summary["error estimates"] == result.summary["error estimates"]


def test_the_readings_of_another_scene_are_not_taken(stated, tmp_path):
    folder, result = stated
    left = json.loads((folder / FILE).read_text())
    assert left["scene"] == fingerprint(coarser(scene("implicit")))
    left["scene"], left["reading"]["maximum depth [-]"] = "another", {"maximum depth [mm]": 1.0}
    (tmp_path / FILE).write_text(json.dumps(left))
    assert run_stated(scene("implicit"), out=tmp_path).summary["error estimates"] == pytest.approx(
        result.summary["error estimates"]
    )


def test_a_companion_that_gives_up_loses_nothing(tmp_path):
    short = scene("implicit")
    short = replace(short, program=replace(short.program, strokes=2))
    left = {"scene": fingerprint(coarser(short)), "gave up": "no equilibrium"}
    (tmp_path / FILE).write_text(json.dumps(left))
    summary = run_stated(short, out=tmp_path).summary
    assert summary["status"] == "completed"
    assert summary["warnings"] == [
        "the coarser companion run gave up: no equilibrium; the error of the mesh is not known"
    ]
    assert "peak pressure [-]" not in summary["error estimates"]
    assert np.isfinite(summary["error estimates"]["maximum depth [-]"])


def test_pressures_are_drawn_in_the_band_of_their_error(stated):
    folder, result = stated
    from ngwear.plots.wear import history_figure
    from ngwear.result_file import read_result

    read = read_result(folder)
    assert read.errors == result.summary["error estimates"]
    depth, pressure, _ = history_figure(read).axes
    forth = read.series["kind [-]"] == "forth"
    top = (1 + read.errors["peak pressure [-]"]) * read.series["cylinder peak pressure [MPa]"][forth]
    assert pressure.collections[0].get_paths()[0].vertices[:, 1].max() == pytest.approx(top.max())
    deepest = 1e3 * (1 + read.errors["maximum depth [-]"]) * read.series["maximum depth [mm]"].max()
    assert depth.collections[0].get_paths()[0].vertices[:, 1].max() == pytest.approx(deepest)
