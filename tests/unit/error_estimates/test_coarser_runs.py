import json
import shutil
import time
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import ngwear as nw
from ngwear.error_estimates import coarser_runs as companion
from ngwear.error_estimates.coarser_runs import (
    COARSER,
    COARSEST,
    FILE,
    LEAST_COARSER,
    coarser_scene,
    combined_errors,
    depth_exponent,
    edge_ratio,
    run_with_coarser_runs,
)
from ngwear.loop.run import run
from ngwear.materials import PronySeries
from ngwear.parallel.workers import Worker
from ngwear.plots import wear
from ngwear.results.quantities_of_interest import (
    BY_FRICTION,
    BY_HALVED,
    DEPTH,
    DEPTH_BY_MESH,
    LOST,
    PEAK,
    PLACES,
    compared,
    element_edge,
    quantities,
)
from ngwear.results.recorder import TORN, fingerprint
from ngwear.results.result_file import read_result
from ngwear.results.richardson import relative_errors
from ngwear.scene.options import Wear
from ngwear.verify import no_loss


def scene(scheme):
    """The block of elements for four strokes on elements of twice the size."""
    block = no_loss.scene(scheme)
    accuracy = replace(block.accuracy, patch=0.2, mounting=0.2)
    return replace(block, accuracy=accuracy, program=replace(block.program, strokes=4))


def without_companions(scene, folder):
    """Leave in the folder that both companions gave up, so that none is run."""
    for name, factor in ((FILE, 2.0), (COARSEST, 4.0)):
        told = {"scene": fingerprint(coarser_scene(scene, factor)), "gave up": "no equilibrium"}
        (folder / name).write_text(json.dumps(told))


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    return folder, run_with_coarser_runs(scene("implicit"), out=folder, figures=False)


def test_errors_by_hand():
    mine = {"depth": {"depth": 2.0}, "force": {"out": -3.0, "in": 0.1, "up": 0.0}, "nothing": {"leak": 0.0}, "none": {}}
    other = {
        "depth": {"depth": 2.2},
        "force": {"out": -3.0, "in": 0.4, "up": 0.0},
        "nothing": {"leak": 0.0},
        "none": {},
    }
    found = relative_errors(mine, other)
    assert found["depth"] == pytest.approx(0.1)
    assert found["force"] == pytest.approx(0.1), "of the largest force, not of one that vanishes"
    assert found["nothing"] == found["none"] == 0.0


def test_an_error_of_order_half_to_two_is_met_within_a_factor_of_three():
    for order, effectivity in ((0.5, 0.414), (1.0, 1.0), (1.5, 1.83), (2.0, 3.0)):
        exact, error = 3.0, 1e-5
        mine, other = ({"q": {"q": exact + error * edge**order}} for edge in (1.0, 2.0))
        assert relative_errors(mine, other)["q"] * exact / error == pytest.approx(effectivity, rel=2e-3)


def test_the_companion_is_coarser_in_every_setting():
    fine = no_loss.scene("implicit")
    coarse = coarser_scene(fine).accuracy
    assert coarse.patch == 2 * fine.accuracy.patch
    assert coarse.coarse == 2 * fine.accuracy.coarse
    assert coarse.mounting >= coarse.patch
    assert coarse.stress_error == pytest.approx(4 * fine.accuracy.stress_error)
    assert coarse.wear_error == pytest.approx(2 * fine.accuracy.wear_error)
    assert replace(coarser_scene(fine), accuracy=fine.accuracy, save=fine.save) == fine


def test_a_run_states_the_error_of_all_that_is_read_off(finished):
    folder, result = finished
    errors = json.loads((folder / "summary.json").read_text())["error estimates"]
    assert errors == result.summary["error estimates"]
    others = [companion.run_scene(coarser_scene(scene("implicit"), factor), figures=False) for factor in (2.0, 4.0)]
    mine, *theirs = (compared(r.recorder.rows) for r in (result, *others))
    found = relative_errors(mine, *theirs)
    least = {PEAK: relative_errors(mine, theirs[0])[PEAK]}  # the scene may lose elements
    for name in ("maximum depth", "worn area", "peak pressure", "contact width", "friction force"):
        assert errors[f"{name} by mesh [-]"] == pytest.approx(found[f"{name} [-]"]), name
        steps = errors.get(f"{name} by the wear steps alone [-]", 0.0)
        known = max(found[f"{name} [-]"] + steps, least.get(f"{name} [-]", 0.0))
        assert errors[f"{name} [-]"] == pytest.approx(known), "its steps are prescribed"
        assert 0 < found[f"{name} [-]"] < 0.5, name
    for other, name in zip(others, ("companion", "coarsest companion"), strict=True):
        assert result.summary[f"solves of the {name}"] == other.summary["solves"]


def test_histories_are_read_along_the_last_half(finished):
    _, result = finished
    rows, strokes = result.recorder.rows, result.summary["strokes"]
    read = quantities(rows)
    assert set(read["peak pressure [-]"]) == {f"{kind}: cylinder peak pressure [MPa]" for kind in ("forth", "back")}
    (depth,) = read["maximum depth [-]"].values()
    assert len(depth) == PLACES
    assert depth[-1] == pytest.approx(result.summary["maximum depth [mm]"])
    done = [r for r in rows if r["kind [-]"] == "back"]
    half = np.interp(strokes / 2, [r["stroke [-]"] for r in done], [r["maximum depth [mm]"] for r in done])
    assert depth[0] == pytest.approx(half)
    looked_at = dict(rows[-1], **{"strokes in one solve [-]": 0, "maximum depth [mm]": 9.0})
    assert quantities([*rows, looked_at]) == read
    assert all(len(force) == PLACES for force in read["friction force [-]"].values())


def test_folded_arms_and_prescribed_steps_are_added_by_their_names():
    whole = scene("implicit")
    program = replace(whole.program, cycle=tuple(replace(s, speed=1.0) for s in whole.program.cycle))
    arms = PronySeries((0.5,), (1e-4 * min(s.duration for s in program.cycle),))
    jumps = replace(
        whole,
        deactivation=None,
        part=replace(whole.part, prony=arms),
        program=program,
        wear=replace(whole.wear, step="jump"),
    )
    bound, embedded = jumps.folding.bound, {"maximum depth [-]": 0.02, "worn area [-]": 0.01}
    assert 0 < bound < 1e-3
    mine, other = ({"maximum depth [-]": {"d": [d]}, "peak pressure [-]": {"p": [2 * d]}} for d in (1.0, 1.04))
    found = combined_errors(jumps, embedded, mine, other)
    assert found["stress by arms folded away [-]"] == bound
    for name in ("maximum depth", "peak pressure"):
        assert found[f"{name} by mesh and wear steps [-]"] == pytest.approx(0.04)
        assert found[f"{name} [-]"] == pytest.approx(0.04 + bound)
    assert found["maximum depth by the wear steps alone [-]"] == 0.02
    less = [level | {DEPTH_BY_MESH: {"d": [d]}} for level, d in zip((mine, other), (1.0, 0.99), strict=True)]
    apart = combined_errors(jumps, embedded, *less)
    assert apart[DEPTH_BY_MESH] == pytest.approx(0.01)
    assert apart[DEPTH] == pytest.approx(0.01 + 0.02 + bound), "the elements' error without the steps', and theirs"
    assert apart["maximum depth by mesh and wear steps [-]"] == pytest.approx(0.03)
    each = combined_errors(replace(jumps, wear=replace(jumps.wear, step="each")), embedded, mine, other)
    assert each["maximum depth [-]"] == pytest.approx(0.04 + bound + 0.02)
    assert each["peak pressure [-]"] == pytest.approx(0.04 + bound)
    assert each["maximum depth by mesh [-]"] == pytest.approx(0.04)


def test_all_that_is_torn_counts_as_error_of_the_area_lost_and_of_the_depth():
    mine, other = ({LOST: {"a": [a]}, DEPTH: {"d": [1.0]}} for a in (1.0, 1.04))
    found = combined_errors(scene("implicit"), {TORN: 0.1}, mine, other)
    assert found[LOST] == pytest.approx(0.04 + 0.1)
    assert found["area lost in all by mesh and wear steps [-]"] == pytest.approx(0.04)
    assert found[DEPTH] == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("depth", "area", "power"),
    [
        ([1.0, 2.0, 4.0], [1.0, 2.0**1.5, 8.0], 2 / 3),
        ([1.0, 2.0], [1.0, 4.0], 0.5),
        ([1.0, 4.0], [1.0, 2.0], 1.0),
        ([1.0, 1.0], [1.0, 2.0], 1.0),
        ([0.0, 1.0], [0.0, 1.0], 1.0),
    ],
)
def test_depths_grow_by_a_power_of_the_area(depth, area, power):
    mine = {DEPTH: {"d": depth}, LOST: {"a": area}}
    assert depth_exponent(mine) == pytest.approx(power)
    assert combined_errors(scene("implicit"), {TORN: 0.1}, mine, mine)[DEPTH] == pytest.approx(0.1 * power)


def test_where_elements_are_lost_peaks_err_by_no_less_than_their_last_difference():
    losing = scene("implicit")
    levels = [{PEAK: {"out": [p]}, DEPTH: {"d": [1.0]}} for p in (1.0, 0.9, 1.0)]
    assert combined_errors(losing, {}, *levels)[PEAK] == pytest.approx(0.1)
    scatter = combined_errors(replace(losing, deactivation=None), {}, *levels)[PEAK]
    assert scatter < 0.08, "differences that turn round are scatter"


def test_without_the_coarsest_the_error_is_of_first_order(finished, tmp_path):
    folder, result = finished
    other = json.loads((folder / FILE).read_text())
    coarsest = {"scene": fingerprint(coarser_scene(scene("implicit"), 4.0)), "gave up": "no equilibrium"}
    for name, left in ((FILE, other), (COARSEST, coarsest)):
        (tmp_path / name).write_text(json.dumps(left))
    summary = run_with_coarser_runs(scene("implicit"), out=tmp_path, figures=False).summary
    assert summary["warnings"] == [
        "the coarsest run gave up: no equilibrium; first order is assumed for the error of the mesh"
    ]
    ratio = edge_ratio(element_edge(result.recorder.rows), other["element edge [mm]"])
    found = relative_errors(compared(result.recorder.rows), other["reading"], ratio=ratio)
    assert summary["error estimates"]["peak pressure [-]"] == pytest.approx(found["peak pressure [-]"])


def test_a_companion_counts_for_as_much_coarser_as_its_elements_in_contact_are(finished):
    folder, result = finished
    edge = element_edge(result.recorder.rows)
    assert 0.5 < edge / result.summary["element edge in the contact [mm]"] < 1.5
    assert json.loads((folder / FILE).read_text())["element edge [mm]"] > 1.5 * edge
    assert [edge_ratio(0.1, other) for other in (0.1, 0.15, 0.2, 0.3)] == pytest.approx([LEAST_COARSER, 1.5, 2, 2])
    assert edge_ratio(0.1, 0.0) == edge_ratio(0.0, 0.1) == COARSER
    mine, other, coarsest = ({DEPTH: {"d": [d]}} for d in (1.0, 1.04, 1.12))
    jumps = replace(scene("implicit"), deactivation=None, wear=Wear())
    two = combined_errors(jumps, {}, mine, other, ratio=1.5)
    three = combined_errors(jumps, {}, mine, other, coarsest, ratio=1.5)
    assert two[DEPTH] == pytest.approx(0.04 / 0.5)
    assert three[DEPTH] == pytest.approx(0.04), "three tell their order"


def test_the_two_runs_of_a_part_with_room_to_move_have_the_factor_of_safety_of_two_grids(ring, sheet):
    """Grid convergence index of two grids, order 3/2: 3 / (2^1.5 - 1) = 1.641 of their difference (Roache 1994)."""
    mine, other = ({DEPTH: {"depth": [depth]}, DEPTH_BY_MESH: {"depth": [depth]}} for depth in (1.0, 1.1))
    moves, held = (combined_errors(scene, {DEPTH: 0.02}, mine, other) for scene in (ring, sheet))
    assert held[DEPTH] == pytest.approx(0.1 + 0.02)
    assert moves[DEPTH] == pytest.approx(1.641 * 0.1 + 0.02, rel=1e-3)


@pytest.mark.parametrize(("over", "needed"), [(1.01, False), (0.99, True)])
def test_the_coarsest_is_needed_only_where_the_first_does_not_show_enough(finished, tmp_path, over, needed):
    folder, result = finished
    for name in (FILE, COARSEST):
        shutil.copy(folder / name, tmp_path / name)
    mine, other = compared(result.recorder.rows), json.loads((folder / FILE).read_text())["reading"]
    errors = result.summary["error estimates"]
    ratio = edge_ratio(element_edge(result.recorder.rows), json.loads((folder / FILE).read_text())["element edge [mm]"])
    two = relative_errors(mine, other, ratio=ratio)[DEPTH] + errors["maximum depth by the wear steps alone [-]"]
    requested = {DEPTH: over * two}
    summary = run_with_coarser_runs(scene("implicit"), out=tmp_path, requested=requested, figures=False).summary
    assert ("solves of the coarsest companion" in summary) is needed
    assert summary["error estimates"][DEPTH] == pytest.approx(errors[DEPTH] if needed else two)
    assert not any("coarse" in warning for warning in summary["warnings"])


def test_a_companion_that_has_ended_is_not_run_again(finished, monkeypatch):
    folder, result = finished
    monkeypatch.setattr(companion, "Worker", None)
    again = run_with_coarser_runs(scene("implicit"), out=folder, resume=True, figures=False)
    assert again.summary["error estimates"] == result.summary["error estimates"]


def test_the_readings_of_another_scene_are_not_taken(finished, tmp_path):
    folder, result = finished
    left = json.loads((folder / FILE).read_text())
    assert left["scene"] == fingerprint(coarser_scene(scene("implicit")))
    left["scene"], left["reading"]["maximum depth [-]"] = "another", {"maximum depth [mm]": 1.0}
    (tmp_path / FILE).write_text(json.dumps(left))
    again = run_with_coarser_runs(scene("implicit"), out=tmp_path, figures=False)
    assert again.summary["error estimates"] == pytest.approx(result.summary["error estimates"])


def test_a_companion_that_gives_up_loses_nothing(tmp_path):
    short = scene("implicit")
    short = replace(short, program=replace(short.program, strokes=2))
    left = {"scene": fingerprint(coarser_scene(short)), "gave up": "no equilibrium"}
    (tmp_path / FILE).write_text(json.dumps(left))
    summary = run_with_coarser_runs(short, out=tmp_path, figures=False).summary
    assert summary["status"] == "completed"
    assert summary["warnings"] == ["the coarser run gave up: no equilibrium; the error of the mesh is not known"]
    assert "peak pressure [-]" not in summary["error estimates"]
    assert np.isfinite(summary["error estimates"]["maximum depth [-]"])


@pytest.mark.parametrize(("part", "known"), [(BY_FRICTION, "not known"), (BY_HALVED, "known from elements of half")])
def test_without_a_companion_only_halved_elements_tell_of_the_mesh(tmp_path, part, known):
    """Friction left out is no error of the mesh."""
    short = scene("implicit")
    left = {"scene": fingerprint(coarser_scene(short)), "gave up": "no equilibrium"}
    (tmp_path / FILE).write_text(json.dumps(left))
    summary = {"error estimates": {f"{DEPTH[:-4]} {part}": 0.1}, "warnings": []}
    companion._CoarserRuns(short, tmp_path, None, None).state(None, summary)
    assert summary["warnings"][0].startswith(
        f"the coarser run gave up: no equilibrium; the error of the mesh is {known}"
    )
    assert summary["error estimates"][DEPTH] == 0.1


def test_a_part_with_room_waits_for_one_companion_as_long_as_its_run_took(tmp_path):
    ring = replace(nw.read_scene("geometries/o_ring/scene.toml"), accuracy=nw.Accuracy.draft())
    busy = SimpleNamespace(alive=True, idle=False, do=lambda *_: None, end=lambda: None)
    runs = companion._CoarserRuns(ring, tmp_path, None, busy)
    (only,) = runs.runs
    assert only[0].accuracy.across == 3.0
    runs.start = time.perf_counter() - 0.2
    begin = time.perf_counter()
    assert runs._wait_for(*only) == {"gave up": "it took more than twice the time of the run"}
    assert 0.2 < time.perf_counter() - begin < 2.0


def test_a_run_is_written_before_its_errors_are_known(tmp_path):
    found = {}

    def state(recorder, summary):
        found["files"] = {file.name for file in tmp_path.iterdir()}
        found["before"] = json.loads((tmp_path / "summary.json").read_text())
        summary["error estimates"]["peak pressure [-]"] = 0.1

    run(scene("implicit"), out=tmp_path, errors=state, figures=False)
    assert {"result.h5", "series.csv"} <= found["files"]
    assert found["before"]["status"] == "completed"
    after = json.loads((tmp_path / "summary.json").read_text())
    assert after["error estimates"] == found["before"]["error estimates"] | {"peak pressure [-]": 0.1}
    assert read_result(tmp_path).errors == after["error estimates"]


def test_who_stops_waiting_for_errors_has_all_else(tmp_path):
    def state(recorder, summary):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(replace(scene("implicit"), deactivation=None), out=tmp_path, errors=state)
    assert {"history.png", "profiles.png", "section.png"} <= {file.name for file in tmp_path.iterdir()}
    assert json.loads((tmp_path / "summary.json").read_text())["status"] == "completed"


@pytest.mark.parametrize("there", [True, False])
def test_figures_are_drawn_half_by_the_worker_or_else_all_here(tmp_path, monkeypatch, there):
    drawn, part = [], replace(scene("implicit"), deactivation=None)
    plot = wear.plot
    monkeypatch.setattr(wear, "plot", lambda *a, **how: drawn.append(plot(*a, **how)))  # a worker has its own
    worker = Worker("ngwear.error_estimates.coarser_runs")
    if not there:
        worker.end()
    without_companions(part, tmp_path)
    run_with_coarser_runs(part, out=tmp_path, worker=worker)
    pictures = {tmp_path / f"{name}.png" for name in ("section", "profiles", "peak_pressure", "history")}
    (here,) = drawn
    assert tmp_path / "profiles.png" in here
    assert there == (tmp_path / "section.png" not in here) == (tmp_path / "peak_pressure.png" not in here)
    assert there or pictures <= set(here)
    assert all(picture.is_file() for picture in pictures)
    assert not worker.alive


def test_section_is_drawn_once_the_part_is_mounted_and_again_worn(tmp_path):
    begun = []

    def mounted(state):
        begun.append({file.name for file in tmp_path.glob("*.png")})
        (tmp_path / "section.png").write_bytes(b"new")

    run(replace(scene("implicit"), deactivation=None), out=tmp_path, on_step=mounted)
    assert begun[0] == {"section.png"}
    assert {file.name for file in tmp_path.glob("*.png")} >= {"section.png", "history.png"}
    assert (tmp_path / "section.png").stat().st_size > 1000


def test_pressures_are_drawn_in_the_band_of_their_error(finished):
    folder, result = finished
    from ngwear.plots.wear import history_figure

    read = read_result(folder)
    assert read.errors == result.summary["error estimates"]
    depth, pressure, _ = history_figure(read).axes
    forth = read.series["kind [-]"] == "forth"
    top = (1 + read.errors["peak pressure [-]"]) * read.series["cylinder peak pressure [MPa]"][forth]
    assert pressure.collections[0].get_paths()[0].vertices[:, 1].max() == pytest.approx(top.max())
    deepest = 1e3 * (1 + read.errors["maximum depth [-]"]) * read.series["maximum depth [mm]"].max()
    assert depth.collections[0].get_paths()[0].vertices[:, 1].max() == pytest.approx(deepest)
