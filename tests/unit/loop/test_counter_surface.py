"""Scenes whose counter-surface keeps a worn profile."""

import math

import numpy as np
import pytest

from ngwear.errors import SceneError
from ngwear.explanation.explain import explain
from ngwear.loop.counter_surface import ways
from ngwear.loop.run import run
from ngwear.loop.stepper import Stepper
from ngwear.plots.counter import counter_figure, worn_counters
from ngwear.plots.wear import plot
from ngwear.results.result_file import read_result
from ngwear.scene.program import Program, Stroke
from ngwear.scene.read_scene import read_scene
from ngwear.surfaces import Cylinder, WornProfile, rod
from ngwear.wear.sliding_distance import Strokes

K, COUNTER_K = 1e-3, 5e-4
WEARS = ("specific_wear_rate = 1.0e-3", "specific_wear_rate = 1.0e-3\ncounter_wear_rate = 5.0e-4")
TO_AND_FRO = (
    ("travel = 10.0", 'travel = 10.0\n[[program.stroke]]\nname = "back"\ntravel = 10.0\ndirection = -1'),
    ("strokes = 4", "strokes = 12"),
    ('step = "each"', 'step = "jump"'),
)
PLATE = (
    (
        '"cylinder", centre = [2.0, 3.99], radius = 2.0, push = [0.0, -1.0] }\nforce = 0.5',
        '"plane", point = [0, 1.98], normal = [0, -1] }',
    ),
    ("friction = 0.1\n", ""),
)


def test_a_point_loses_what_it_passes_on_a_plane():
    under = np.array([[-0.4, 0.0], [0.0, 0.4]])
    wear = np.array([[0.0, 0.3], [0.3, 0.0]])  # a triangle of area 0.12
    worn = WornProfile.of(rod(2.0), 0.03).swept(under, wear, np.array([[0.0, 5.0], [5.0, 3.0]]))
    assert worn.area == pytest.approx(0.12 * 7.0, rel=1e-13)
    assert worn.at(np.array([-0.5, 1.0, 2.5, 4.0, 5.5])) == pytest.approx([0.0, 0.12, 0.12, 0.24, 0.0], abs=1e-12)
    assert worn.at(np.array([0.0, 3.0, 5.0])) == pytest.approx([0.06, 0.18, 0.12], rel=1e-3)


@pytest.mark.parametrize("way", [(0.0, 1.0), (40.0, 33.0), (-3.0, 50.0)])
def test_a_ring_wears_all_around(way):
    ring = WornProfile.of(Cylinder(centre=(0.0, 0.0), radius=1.0), 0.05)
    assert ring.length / ring.spacing == pytest.approx(126)
    under, wear = np.array([[-0.3, 0.1]]), np.full((1, 2), 0.2)
    worn = ring.swept(under, wear, np.array([way]))
    assert worn.area == pytest.approx(0.08 * abs(way[1] - way[0]), rel=1e-12)
    assert worn.depth[0] == pytest.approx(worn.depth[-1], abs=1e-14)
    assert worn.at(worn.along + 4 * math.pi) == pytest.approx(worn.depth, abs=1e-12)
    turns = abs(way[1] - way[0]) / ring.length
    assert 0.08 * math.floor(turns) - 1e-12 <= worn.depth.min() <= worn.depth.max() <= 0.08 * math.ceil(turns) + 1e-12


def test_ways_of_strokes_that_come_back_and_of_those_that_go_on():
    out, back = Stroke(name="out", travel=18.0, direction=-1), Stroke(name="back", travel=18.0)
    to_and_fro = Program(cycle=(out, back), strokes=10)
    assert ways(to_and_fro, 0, Strokes(36.0, 18.0, 36.0, 3)) == pytest.approx(np.array([[0.0, -18.0]]))
    assert ways(to_and_fro, 1, Strokes(54.0, 18.0, 36.0, 3)) == pytest.approx(np.array([[-18.0, 0.0]]))
    onwards = Program(cycle=(Stroke(name="turn", travel=4.0),), strokes=10)
    assert ways(onwards, 0, Strokes(8.0, 4.0, 4.0, 2)) == pytest.approx(np.array([[8.0, 12.0], [12.0, 16.0]]))


@pytest.mark.parametrize("changes", [(), TO_AND_FRO], ids=["turning", "to and fro"])
def test_surface_loses_what_the_law_wears_off_it(tmp_path, write_sheet, from_checkpoint, changes):
    scene = read_scene(write_sheet(tmp_path, WEARS, *changes))
    stepper = Stepper(scene)
    state, wanted = stepper.start(), 0.0
    while not stepper.finished(state):
        state = stepper.advance(state)
        loads = [r.repeats * r.contacts["roller"].load.sum() for r in state.reports]
        wanted += COUNTER_K * 10.0 * sum(loads)
    assert state.counters["roller"].area == pytest.approx(wanted, rel=1e-10)
    assert state.counters["roller"].area == pytest.approx(COUNTER_K / K * state.ledger.worn, rel=0.02)
    again = from_checkpoint(state, scene)
    assert again.counters["roller"].depth.tolist() == state.counters["roller"].depth.tolist()


def test_surface_that_sticks_in_part_wears_where_it_slips(tmp_path, write_sheet):
    moves = tuple((old.replace("10.0", "0.02"), new.replace("10.0", "0.02")) for old, new in TO_AND_FRO[:1])
    short = (("travel = 10.0", moves[0][1]), TO_AND_FRO[1], ("friction = 0.1", "friction = 0.3"))
    stepper = Stepper(read_scene(write_sheet(tmp_path, WEARS, *short)))
    state = stepper.start()
    while not stepper.finished(state):
        state = stepper.advance(state)
    assert 0 < state.ledger.worn < 0.5 * K * 0.5 * 12 * 0.02, "the middle sticks"
    assert state.counters["roller"].area == pytest.approx(COUNTER_K / K * state.ledger.worn, rel=0.02)


NEITHER_AND_BOTH = [("part", ()), ("both", (WEARS,))]


@pytest.fixture(scope="module")
def plates(tmp_path_factory, write_sheet):
    """Under a plate, the part that wears and both that do: folder and result of each run."""
    found = {}
    for name, more in NEITHER_AND_BOTH:
        folder = tmp_path_factory.mktemp(name)
        scene = read_scene(write_sheet(folder, *PLATE, *TO_AND_FRO, *more))
        found[name] = folder / "out", run(scene, out=folder / "out", figures=False)
    return found


def test_a_worn_plate_comes_away(plates):
    alone, both = (plates[name][1] for name, _ in NEITHER_AND_BOTH)
    rows = both.recorder.rows
    depth = rows[-1]["roller counter-surface depth [mm]"]
    column = "roller force y [N/mm]"
    passed = sum(r["strokes in one solve [-]"] * abs(r[column]) for r in rows)
    assert depth == pytest.approx(COUNTER_K * passed, rel=0.02)
    lost = 1 - rows[-1][column] / rows[0][column]
    assert lost > 1 - alone.recorder.rows[-1][column] / alone.recorder.rows[0][column] + 0.5 * depth / 0.02


def test_profile_is_kept_in_files_and_through_a_kill(tmp_path, write_sheet, monkeypatch):
    scene = read_scene(write_sheet(tmp_path, WEARS, *TO_AND_FRO))
    whole = run(scene, out=tmp_path / "whole", figures=False)
    last = read_result(tmp_path / "whole").snapshots[-1].profiles["roller"]
    counter = whole.state.counters["roller"]
    assert last["counter-surface coordinate [mm]"] == pytest.approx(counter.along)
    assert last["counter-surface depth [mm]"] == pytest.approx(counter.depth)
    assert whole.recorder.rows[-1]["roller counter-surface worn area [mm^2]"] == pytest.approx(counter.area)

    def kill(state):
        if state.strokes >= 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(scene, out=tmp_path / "parts", figures=False, on_step=kill)
    rest = run(scene, out=tmp_path / "parts", resume=True, figures=False)
    assert rest.state.counters["roller"].depth == pytest.approx(counter.depth, rel=1e-9)


def test_a_surface_that_wears_alone_is_refused_and_explained_otherwise(tmp_path, write_sheet):
    with pytest.raises(SceneError, match=r"counter_wear_rate.*specific_wear_rate"):
        read_scene(write_sheet(tmp_path, WEARS, ("1.0e-3", "0.0")))
    with pytest.raises(SceneError, match=r"counter_wear_rate.*at least 0"):
        read_scene(write_sheet(tmp_path, WEARS, ("5.0e-4", "-1.0")))
    told = explain(read_scene(write_sheet(tmp_path, WEARS)))
    assert "0.0005 mm²/N" in told["effects"]["wear of the surface of 'roller'"]


def test_a_worn_surface_is_drawn_and_only_then(plates):
    for name, (folder, _) in plates.items():
        drawn = [path.name for path in plot(folder)]
        assert ("counter_surface.png" in drawn) is (name == "both")
    folder, whole = plates["both"]
    result, counter = read_result(folder), whole.state.counters["roller"]
    assert worn_counters(result) == ["roller"]
    (panel,) = counter_figure(result).axes
    depths = [line.get_ydata().max() for line in panel.lines]
    assert depths == sorted(depths)
    assert [line.get_label() for line in panel.lines] == [f"after {n} strokes" for n in (3, 6, 12)]
    assert panel.lines[-1].get_xdata() == pytest.approx(counter.along)
    assert panel.lines[-1].get_ydata() == pytest.approx(1e3 * counter.depth)
    left, right = panel.get_xlim()
    assert left < counter.along[counter.depth > 0].min() < counter.along[counter.depth > 0].max() < right
    assert panel.yaxis_inverted()
