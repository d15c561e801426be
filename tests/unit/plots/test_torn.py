"""Figures of a section that loses elements: of a block of squares whose fate is known, and of a run."""

import math
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgba

from ngwear.cli import BAD_INPUT, OK, main
from ngwear.errors import ResultError
from ngwear.geometry.cells import Fate
from ngwear.loop.run import run
from ngwear.plots.animation import FILE, FRAMES, animate, frames, worn_window
from ngwear.plots.area_balance import AREAS, CAUSES, IN_ALL, book_figure
from ngwear.plots.sections import living, lost, overlapping, sections, when, worn_face
from ngwear.plots.stress import critical_stress, directions, stress_figure, tensile
from ngwear.plots.torn import LOST, face_figure, ridge_figure, ridge_window
from ngwear.results.result_file import ResultFile, Snapshot, read_result
from ngwear.scene.read_scene import read_scene

WIDE, HIGH, SIDE, WORN = 30, 10, 0.1, 0.02  # squares, mm, and how far the face has receded in the end
PICTURES = ("torn_profiles", "ridge_evolution", "stress_field", "material_book")
DEACTIVATION = (
    ('step = "each"', 'step = "each"\nremesh = "never"\n[deactivation]\ndepth = 0.3\n[save]\nstrokes = [2]'),
)


def snapshot(stroke, kind, fate, *, worn=0.0, pull=1.0):
    """Squares over y = 0, the lower face receded by ``worn``, the bulge of the stress at the left."""
    x, y = np.meshgrid(SIDE * np.arange(WIDE + 1), SIDE * np.arange(HIGH + 1))
    points = np.column_stack([x.ravel(), y.ravel()])
    points[: WIDE + 1, 1] += worn
    low = (np.arange(HIGH)[:, None] * (WIDE + 1) + np.arange(WIDE)).ravel()
    corners = np.column_stack([low, low + 1, low + WIDE + 2, low + WIDE + 1])
    stress = np.zeros((len(corners), 3))
    stress[:, 0], stress[:, 1] = -2.0, pull * (1 - np.arange(len(corners)) / len(corners))
    stress[fate != 0] = np.nan
    length, height = WIDE * SIDE, HIGH * SIDE
    face = np.linspace(0, length, WIDE + 1)
    outline = np.vstack([np.column_stack([face, np.full(WIDE + 1, worn)]), [(length, height), (0, height)]])
    place = np.column_stack([np.linspace(0, length, 7), np.zeros(7)])
    profile = {"place [mm]": place, "reference [mm]": place, "gap [mm]": np.zeros(7)}
    profile["pressure [MPa]"] = np.array([0.0, 1, 2, 3, 2, 1, 0])
    elements = {"points [mm]": points, "corners": corners, "fate": fate, "stress xx, yy, xy [MPa]": stress}
    elements["displacement [mm]"] = np.zeros_like(points)
    return Snapshot(stroke, kind, outline, {"rod": profile}, {}, elements, time=900.0 * stroke)


@pytest.fixture
def result():
    """A run of 4 strokes: 3 squares torn side by side, one distorted above, one come loose far away."""
    fates = [np.zeros(WIDE * HIGH, np.int8) for _ in range(3)]
    fates[1][[10, 11]] = Fate.TORN
    fates[2][[10, 11, 12]], fates[2][41], fates[2][25] = Fate.TORN, Fate.DISTORTED, Fate.LOOSE
    shown = [
        snapshot(stroke, kind, fate, worn=worn)
        for stroke, fate, worn in zip((0, 2, 4), fates, (0.0, WORN / 2, WORN), strict=True)
        for kind in ("out", "back")
    ]
    outline = np.array([(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (0.0, 1.0)])
    stroke = np.repeat([0, 2, 4], 2)
    series = {"stroke [-]": stroke, "sliding distance [mm]": 500.0 * stroke}
    series["rod friction force x [N/mm]"] = np.tile([-1.0, 1.0], 3)
    for number, cause in enumerate(CAUSES):
        series[f"area lost by {cause} [mm^2]"] = 0.01 * (number + 1) * stroke
        series["elements worn away [-]" if cause == "wear" else f"elements lost by {cause} [-]"] = number * stroke
    series["area lost by merging [mm^2]"] = 0.05 * stroke
    series[IN_ALL] = 0.15 * stroke
    return ResultFile(
        scene="squares",
        outline=outline,
        edges=("bottom", "right", "top", "left"),
        wear_rates={"rod": 1e-6},
        worn_edges=("bottom",),
        has_memory=False,
        laws_vary=False,
        errors={},
        damage=("tensile normal stress", 1.2),
        series=series,
        snapshots=shown,
    )


def collections(panel):
    return {c.get_label(): c for c in panel.collections}


def test_kept_strokes_are_called_by_time(result):
    kept = sections(result)
    assert [s.stroke for s in kept] == [0, 2, 4]
    assert [when(result, s) for s in kept] == ["new", "after 30 min", "after 60 min"]


def test_kept_strokes_without_speed_are_called_by_distance(result):
    timeless = replace(result, snapshots=[replace(s, time=math.inf) for s in result.snapshots])
    assert when(timeless, sections(timeless)[-1]) == "after 4 strokes, 2 m"


def test_lost_elements_are_drawn_as_they_were_when_new(result):
    """The points that they share with living ones have receded since."""
    first, _, last = sections(result)
    torn = lost(first, last, Fate.TORN)
    assert len(torn) == 3
    for shape in torn:
        assert np.ptp(shape, axis=0) == pytest.approx([SIDE, SIDE])
    above = lost(first, last, Fate.DISTORTED)[0]
    assert above.min(axis=0) == pytest.approx([11 * SIDE, SIDE])


def test_dark_elements_of_the_ridge_are_the_torn_ones(result):
    window = ridge_window(result)
    low, high = window
    for number, (panel, kept) in enumerate(zip(ridge_figure(result).axes, sections(result), strict=True)):
        drawn = collections(panel)
        for fate, label, colour in LOST:
            shapes = lost(sections(result)[0], kept, fate)
            inside = int(overlapping(shapes, window).sum())
            assert len(drawn[label].get_paths()) == inside, (label, number)
            assert not inside or to_rgba(colour) == pytest.approx(drawn[label].get_facecolor()[0])
        assert len(drawn["torn"].get_paths()) == (0, 2, 3)[number]
        alive = int(overlapping(living(kept)[0], window).sum())
        assert len(drawn["rubber"].get_paths()) == alive
        assert panel.get_xlim() == pytest.approx((low[0], high[0]))
        assert panel.get_ylim() == pytest.approx((low[1], high[1]))
    assert low[0] < 10 * SIDE < 13 * SIDE < high[0]
    assert low[1] < 0 < high[1]


def test_ridge_without_loss_is_where_it_is_worn_most(result):
    """The receded face is deepest all along: the window still shows it."""
    whole = [replace(s, elements=s.elements | {"fate": np.zeros(WIDE * HIGH, np.int8)}) for s in result.snapshots]
    (_, low), (_, high) = ridge_window(replace(result, snapshots=whole))
    assert low < 0 < high
    legend = ridge_figure(replace(result, snapshots=whole)).legends[0]
    assert {text.get_text() for text in legend.get_texts()} == {"rubber", "worn away"}


def test_faces_leave_out_what_is_lost(result):
    *panels, depth = face_figure(result).axes
    assert [len(collections(p)["rubber"].get_paths()) for p in panels] == [300, 298, 295]
    assert [p.get_title(loc="left") for p in panels] == ["new", "after 30 min", "after 60 min"]
    for line, worn in zip(depth.lines, (WORN / 2, WORN), strict=True):
        assert line.get_ydata() == pytest.approx(1e3 * worn)
    low, high = worn_face(result)
    assert (low < 0).all()
    assert high[1] > 2 * SIDE, "the square lost behind the face is shown"


def test_narrow_gaps_do_not_hide_the_wear(result):
    """A gap of one square's width, half a millimetre deep: the depth is drawn twice, once for the wear beside it."""
    gap = [(1.0, WORN), (1.0, 0.5), (1.1, 0.5), (1.1, WORN)]
    torn = [replace(s, outline=np.vstack([s.outline[:10], gap, s.outline[12:]])) for s in result.snapshots[-2:]]
    *_, beside, whole = face_figure(replace(result, snapshots=[*result.snapshots[:-2], *torn])).axes
    assert whole.get_ylim()[0] > 500
    assert 1e3 * WORN < beside.get_ylim()[0] < 50


def test_stress_is_that_of_the_criterion(result):
    figure = stress_figure(result)
    assert directions(result) == ["out", "back"]
    *panels, bar = figure.axes
    assert [p.get_title(loc="left") for p in panels] == [
        f"{time}: {kind}" for kind in ("out", "back") for time in ("new", "after 60 min")
    ]
    for panel, number in zip(panels, (0, 4, 1, 5), strict=True):
        drawn = panel.collections[0]
        fate = result.snapshots[number].elements["fate"]
        assert len(drawn.get_array()) == (fate == 0).sum()
        assert np.array_equal(drawn.get_array(), tensile(result, result.snapshots[number])[fate == 0])
        assert drawn.norm.vmin == -drawn.norm.vmax
    assert critical_stress(result) == 1.2
    assert "tears at 1.2" in [text.get_text() for text in bar.texts]


def test_principal_stress_for_its_criterion(result):
    last = result.snapshots[-1]
    last.elements["stress xx, yy, xy [MPa]"][:, 2] = 3.0
    principal = tensile(replace(result, damage=("fatigue", 5.0)), last)
    alive = last.elements["fate"] == 0
    yy = last.elements["stress xx, yy, xy [MPa]"][alive, 1]
    assert principal[alive] == pytest.approx(0.5 * (yy - 2) + np.hypot(0.5 * (yy + 2), 3))
    assert critical_stress(replace(result, damage=("strain energy density", 5.0))) is None
    assert len(stress_figure(replace(result, damage=None)).axes[-1].texts) == 0


def test_stacked_areas_are_the_series(result):
    area, small, count = book_figure(result).axes
    below = np.zeros(6)
    for cause, stack in zip(AREAS, area.collections, strict=True):
        top = below + result.series[f"area lost by {cause} [mm^2]"]
        corners = stack.get_paths()[0].vertices
        for x, low, high in zip(result.series["sliding distance [mm]"] / 1e3, below, top, strict=True):
            here = corners[np.isclose(corners[:, 0], x), 1]
            assert (here.min(), here.max()) == pytest.approx((low, high))
        below = top
    assert area.lines[0].get_ydata() == pytest.approx(below), "the sum of the causes is what is lost in all"
    for cause, line in zip(list(AREAS)[1:], small.lines, strict=True):
        assert line.get_ydata() == pytest.approx(result.series[f"area lost by {cause} [mm^2]"])
    assert [line.get_ydata()[-1] for line in count.lines] == [0, 4, 8, 12]


def test_frames_run_from_the_first_to_the_last_stroke(result):
    many = [replace(result.snapshots[0], stroke=n) for n in range(1000)]
    chosen = [s.stroke for s in frames(replace(result, snapshots=many))]
    assert len(chosen) == FRAMES
    assert (chosen[0], chosen[-1]) == (0, 999)
    assert np.ptp(np.diff(chosen)) <= 1
    assert [s.stroke for s in frames(result)] == [0, 2, 4]


def test_window_of_the_moving_picture_holds_the_worn_face(result):
    (left, low), (right, high) = worn_window(result)
    assert left < 0 < 3 < right
    assert low < 0 < WORN < high


@pytest.fixture(scope="module")
def ran(tmp_path_factory, write_sheet):
    """A run from the command line."""
    folder = tmp_path_factory.mktemp("torn")
    scene = write_sheet(folder, *DEACTIVATION)
    assert main(["run", str(scene), "--out", str(folder / "out"), "--quiet", "--alone"]) == OK
    return folder / "out"


def test_run_that_deactivates_draws_its_figures(tmp_path, ran):
    out = Path(shutil.copytree(ran, tmp_path / "out"))
    for name in PICTURES:
        assert (out / f"{name}.png").read_bytes().startswith(b"\x89PNG"), name
        (out / f"{name}.png").unlink()
    result = read_result(out)
    assert [s.stroke for s in sections(result)] == [0, 2, 4]
    assert result.damage is None
    assert not math.isfinite(result.snapshots[-1].time)
    assert main(["plot", str(out)]) == OK
    assert all((out / f"{name}.png").is_file() for name in PICTURES)


def test_time_and_damage_are_kept(tmp_path, write_sheet):
    damage = 'depth = 0.3\ndamage = { criterion = "tensile normal stress", critical = 90.0 }'
    changes = (*DEACTIVATION, ("depth = 0.3", damage), ("travel = 10.0", "travel = 10.0\nspeed = 20.0"))
    scene = read_scene(write_sheet(tmp_path, *changes, ("strokes = 4", "strokes = 2")))
    run(scene, out=tmp_path / "out", figures=False)
    result = read_result(tmp_path / "out")
    assert result.damage == ("tensile normal stress", 90.0)
    assert [s.time for s in result.snapshots] == pytest.approx([0.5 * s.stroke for s in result.snapshots])


def test_moving_picture_of_any_wear_run(finished, capsys):
    from PIL import Image

    assert main(["plot", str(finished), "--animate"]) == OK
    assert capsys.readouterr().out.splitlines()[-1] == str(finished / FILE)
    with Image.open(finished / FILE) as picture:
        assert picture.format == "GIF"
        assert picture.n_frames == len(frames(read_result(finished))) == 5
    assert not any((finished / f"{name}.png").exists() for name in PICTURES), "it has no elements"


def test_moving_picture_of_nothing_is_refused(tmp_path):
    with pytest.raises(ResultError, match=r"result\.h5 does not exist"):
        animate(tmp_path)
    assert main(["plot", str(tmp_path), "--animate"]) == BAD_INPUT
