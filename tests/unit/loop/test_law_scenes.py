"""Scenes whose friction and wear follow laws: files, what is refused, jumps, columns, resumption."""

import csv
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ngwear.cli import main
from ngwear.equilibrium.steady_sliding import SteadyOptions
from ngwear.errors import SceneError
from ngwear.explanation.explain import explain
from ngwear.laws import ByPressure, Lubrication, Product, Stribeck, WearRate
from ngwear.loop.law_changes import friction_range, steady_cycles
from ngwear.loop.run import run
from ngwear.loop.stepper import Stepper
from ngwear.materials import MooneyRivlin, PronySeries
from ngwear.plots.wear import plot
from ngwear.results.result_file import read_result
from ngwear.scene.pin_scene import Pin, PinMesh
from ngwear.scene.program import Program, Stroke
from ngwear.scene.read_scene import read_scene
from ngwear.sliding.pin import PinStage
from ngwear.wear.sliding_distance import Strokes

MU, K = "roller friction coefficient [-]", "roller specific wear rate [mm^2/N]"
PHASES = 'friction = { law = "lubrication", distance = [0, 100, 200, 300], coefficient = [0.06, 0.06, 0.2, 0.6] }'
RATES = "{ distance = [0.0, 100.0, 300.0], rate = [0.0, 0.0, 1e-3] }"
JUMPING = (("strokes = 4", "strokes = 40"), ('step = "each"', 'step = "jump"'))


def with_friction(folder, write_sheet, text, *more):
    return write_sheet(folder, ("friction = 0.1", text), *more)


@pytest.mark.parametrize(
    ("text", "law"),
    [
        ("friction = 0.3", 0.3),
        (PHASES, Lubrication(distance=(0.0, 100.0, 200.0, 300.0), coefficient=(0.06, 0.06, 0.2, 0.6))),
        (
            'friction = { law = "pressure", light = 0.9, limit = 0.2, pressure = 1.5, source = "mine" }',
            ByPressure(light=0.9, limit=0.2, pressure=1.5),
        ),
        (
            'friction = { law = "product", factors = [{ law = "lubrication", distance = [0, 9], coefficient = [0, 1] }'
            ', { law = "pressure", light = 1.0, pressure = 2.0 }] }',
            Product(
                factors=(
                    Lubrication(distance=(0.0, 9.0), coefficient=(0.0, 1.0)),
                    ByPressure(light=1.0, pressure=2.0),
                )
            ),
        ),
    ],
)
def test_laws_are_read(tmp_path, write_sheet, text, law):
    (contact,) = read_scene(with_friction(tmp_path, write_sheet, text)).contacts
    assert contact.friction == law


def test_tables_are_read_from_files_beside_the_scene(tmp_path, write_sheet):
    s = np.linspace(0, 400, 21)
    mu = np.interp(s, [0, 100, 200, 300], [0.06, 0.06, 0.2, 0.6])
    rows = [f"{a},{b}" for a, b in zip(s, mu, strict=True)]
    (tmp_path / "mu.csv").write_text("\n".join(["sliding distance [mm],friction coefficient [-]", *rows]))
    (tmp_path / "k.csv").write_text("sliding distance [mm],specific wear rate [mm^2/N]\n0,0\n50,1e-3\n")
    rate = ("specific_wear_rate = 1.0e-3", 'specific_wear_rate = { file = "k.csv" }')
    (contact,) = read_scene(
        with_friction(tmp_path, write_sheet, 'friction = { law = "lubrication", file = "mu.csv" }', rate)
    ).contacts
    assert len(contact.friction.distance) == 21
    assert contact.specific_wear_rate == WearRate(distance=(0.0, 50.0), rate=(0.0, 1e-3))
    (contact,) = read_scene(
        with_friction(tmp_path, write_sheet, 'friction = { law = "lubrication", fitted = "mu.csv" }')
    ).contacts
    assert contact.friction.distance == pytest.approx((0, 100, 200, 300), abs=0.1)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{ law = "ice" }', r"contact\[0\]\.friction\.law = 'ice': must be one of \['lubrication'"),
        ("{ coefficient = [1.0] }", r"contact\[0\]\.friction\.law = None: is missing"),
        (
            '{ law = "lubrication", distance = [0, 5, 3], coefficient = [0, 1, 2] }',
            r"friction\.distance\[2\] = 3\.0.*5 mm",
        ),
        (
            '{ law = "lubrication", distance = [0, 5], coefficient = [0, -1] }',
            r"coefficient\[1\] = -1\.0: must be at lea",
        ),
        ('{ law = "lubrication", distance = [0, 5] }', r"contact\[0\]\.friction\.coefficient = None: is missing"),
        ('{ law = "lubrication", file = "no.csv" }', r"contact\[0\]\.friction\.file, file = .*there is no such file"),
        ('{ law = "lubrication", file = "no.csv", distance = [0] }', r"friction\.distance = \[0\]: unknown key"),
        (
            '{ law = "pressure", light = -1.0, pressure = 1.0 }',
            r"contact\[0\]\.friction\.light = -1\.0: must be at least",
        ),
        ('{ law = "product", factors = [] }', r"contact\[0\]\.friction\.factors = 0: a product needs at least two"),
        ('{ law = "product", factors = [1.0] }', r"friction\.factors = \[1\.0\]: must be a list of laws"),
        (
            '{ law = "stribeck", boundary = 0.5, full = 0.1, speed = 9.0 }',
            r"stroke 'stroke'\.speed = None.*'roller' depe",
        ),
    ],
)
def test_bad_laws_are_refused_with_their_place(tmp_path, write_sheet, text, message):
    with pytest.raises(SceneError, match=message):
        read_scene(with_friction(tmp_path, write_sheet, f"friction = {text}"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "{ distance = [0, 1], rate = [0.0, -1e-3] }",
            r"specific_wear_rate\.rate\[1\] = -0\.001: must be at least 0 mm²/N",
        ),
        (
            "{ distance = [1, 0], rate = [0.0, 1e-3] }",
            r"contact\[0\]\.specific_wear_rate\.distance\[1\] = 0\.0.*must rise",
        ),
        ("{ distance = [1, 0] }", r"contact\[0\]\.specific_wear_rate\.rate = None: is missing"),
        ("[0.0, 1e-3]", r"contact\[0\]\.specific_wear_rate = .*must be a number"),
    ],
)
def test_bad_wear_tables_are_refused_with_their_place(tmp_path, write_sheet, text, message):
    with pytest.raises(SceneError, match=message):
        read_scene(write_sheet(tmp_path, ("= 1.0e-3", f"= {text}")))


def test_strokes_know_their_ways():
    strokes = Strokes(start=100.0, travel=10.0, cycle=15.0, repeats=3)
    assert strokes.distance == 30.0
    assert strokes.starts.tolist() == [100.0, 115.0, 130.0]
    assert strokes.middle == 120.0
    assert Strokes(start=100.0, travel=10.0, cycle=15.0).middle == 100.0
    rate = WearRate(distance=(100.0, 140.0), rate=(0.0, 4.0))
    assert strokes.worn_depth(rate) == pytest.approx(5.0 + 20.0 + 35.0)
    assert strokes.wear_rate(rate) == pytest.approx(2.0)


def test_program_counts_the_way_slid():
    program = Program(cycle=(Stroke(name="a", travel=10.0), Stroke(name="b", travel=5.0)), strokes=5)
    assert [program.slid(n) for n in range(5)] == [0, 10, 15, 25, 30]


def test_jumps_end_before_a_law_changes_by_a_tenth(tmp_path, write_sheet):
    scene = read_scene(with_friction(tmp_path, write_sheet, PHASES, *JUMPING))
    law = scene.contacts[0].friction
    assert friction_range(scene, scene.contacts[0]) == (0.06, 0.6)
    for done in range(39):
        cycles = steady_cycles(scene, done, 40 - done)
        start, end = 10.0 * done, 10.0 * (done + cycles)
        assert cycles == 1 or law.mu(end) - law.mu(start) <= 0.06 + 1e-12
        mean = law.curve().mean(start, end)
        assert cycles == 1 or law.mu(0.5 * (start + end)) == pytest.approx(mean, rel=0.01)
    assert steady_cycles(scene, 0, 40) == 10
    assert steady_cycles(scene, 31, 9) == 9


def test_a_coarser_run_lets_a_law_change_by_more(tmp_path, write_sheet):
    """Only so does it show what the jumps err by; at most half of the law is passed over, however coarse."""
    scene = read_scene(with_friction(tmp_path, write_sheet, PHASES, *JUMPING))
    law, error = scene.contacts[0].friction, scene.accuracy.wear_error
    longest = []
    for factor in (1.0, 2.0, 24.0):
        coarse = replace(scene, accuracy=replace(scene.accuracy, wear_error=factor * error))
        cycles = [steady_cycles(coarse, done, 40 - done) for done in range(40)]
        change = [law.mu(10.0 * (done + n)) - law.mu(10.0 * done) for done, n in enumerate(cycles)]
        longest.append(max(d for d, n in zip(change, cycles, strict=True) if n > 1))
    assert longest[0] <= 0.06 < longest[1] <= 0.12 < longest[2] <= 0.3


def test_jump_does_not_skip_a_phase(tmp_path, write_sheet):
    rates = ("specific_wear_rate = 1.0e-3", f"specific_wear_rate = {RATES}")
    scene = read_scene(with_friction(tmp_path, write_sheet, PHASES, rates, *JUMPING))
    result = run(scene, out=tmp_path / "out", figures=False)
    plot(tmp_path / "out", share=(4, 5))
    with (tmp_path / "out" / "series.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert (tmp_path / "out" / "laws.png").is_file()
    kept = read_result(tmp_path / "out")
    assert kept.laws_vary
    assert kept.wear_rates["roller"] == pytest.approx(scene.contacts[0].wear_rate.curve.mean(0.0, 400.0))
    mu, k = np.array([[float(row[MU]), float(row[K])] for row in rows]).T
    repeats = np.array([int(row["strokes in one solve [-]"]) for row in rows])
    assert repeats.max() > 1
    assert mu[0] == pytest.approx(0.06)
    assert mu[-1] == pytest.approx(0.6)
    assert k[0] == 0.0
    assert k[-1] == pytest.approx(1e-3)
    assert np.diff(mu).max() < 0.1
    assert ((mu > 0.07) & (mu < 0.19)).any()
    assert ((mu > 0.21) & (mu < 0.55)).any()
    heat = float(repeats @ [float(row["roller friction heat of the stroke [mJ/mm]"]) for row in rows])
    mean = scene.contacts[0].friction.curve().mean(0.0, 400.0)
    assert heat == pytest.approx(0.5 * 400 * mean, rel=0.1)  # int P dA over the roller's arc is above its force
    worn = 0.5 * 400 * scene.contacts[0].specific_wear_rate.curve.mean(0.0, 400.0)
    assert result.summary["worn area by the law [mm^2]"] == pytest.approx(worn, rel=0.1)


def test_number_needs_no_column(finished):
    assert not read_result(finished).laws_vary
    header = (finished / "series.csv").read_text().splitlines()[0]
    assert "coefficient" not in header
    assert "wear rate" not in header
    assert not (finished / "laws.png").exists()


def test_friction_by_pressure_is_less_where_the_pressure_is_high(tmp_path, write_sheet):
    law = 'friction = { law = "pressure", light = 0.4, pressure = 0.5 }'
    result = run(read_scene(with_friction(tmp_path, write_sheet, law)), figures=False)
    row = result.recorder.rows[-1]
    peak = row["roller peak pressure [MPa]"]
    assert 0.4 / (1 + peak / 0.5) < row[MU] < 0.4
    snapshot = result.recorder.snapshots[-1].profiles["roller"]
    nominal, p = snapshot["nominal pressure [MPa]"], snapshot["pressure [MPa]"]
    assert row[MU] == pytest.approx(float((0.4 / (1 + p / 0.5) * nominal).sum() / nominal.sum()), rel=0.05)
    along = row["roller force x [N/mm]"] + row["roller friction force x [N/mm]"]
    assert abs(along) == pytest.approx(row[MU] * 0.5, rel=0.1)


def test_friction_by_speed_differs_between_strokes(tmp_path, write_sheet):
    law = 'friction = { law = "stribeck", boundary = 0.4, full = 0.05, speed = 20.0 }'
    back = 'travel = 10.0\nspeed = 10.0\n[[program.stroke]]\nname = "back"\ntravel = 5.0\nspeed = 40.0\ndirection = -1'
    scene = read_scene(with_friction(tmp_path, write_sheet, law, ("travel = 10.0", back)))
    rows = run(scene, figures=False).recorder.rows
    curve = Stribeck(boundary=0.4, full=0.05, speed=20.0)
    for row in rows:
        speed = 40.0 if row["kind [-]"] == "back" else 10.0
        assert row[MU] == pytest.approx(curve.mu(0.0, speed), rel=1e-9)


def test_state_goes_on_the_same_after_it_was_saved(tmp_path, write_sheet, from_checkpoint):
    rates = ("specific_wear_rate = 1.0e-3", f"specific_wear_rate = {RATES}")
    scene = read_scene(with_friction(tmp_path, write_sheet, PHASES, rates, *JUMPING))
    stepper = Stepper(scene)
    state = stepper.start()
    while state.strokes < 16:
        state = stepper.advance(state)
    ends = []
    for going_on in (from_checkpoint(state, scene), state):
        while going_on.strokes < 25:
            going_on = stepper.advance(going_on)
        ends.append((going_on.ledger.worn, going_on.reports[-1].coefficients["roller"], going_on.strokes))
    assert ends[0] == pytest.approx(ends[1], rel=1e-9)


def test_explain_says_which_law_and_what_the_scene_meets(tmp_path, write_sheet, capsys):
    rates = ("specific_wear_rate = 1.0e-3", f"specific_wear_rate = {RATES}")
    file = with_friction(tmp_path, write_sheet, PHASES, rates, ("strokes = 4", "strokes = 25"))
    effects = explain(read_scene(file))["effects"]
    assert "by lubrication, 4 rows to 300 mm; mu = 0.06 to 0.4 over the program" in effects["friction at 'roller'"]
    assert "k = 0 to 0.00075 mm²/N" in effects["wear rate at 'roller'"]
    assert main(["explain", str(file)]) == 0
    assert "by lubrication" in capsys.readouterr().out


PIN = Path(__file__).parents[3] / "geometries" / "pin_on_plate" / "scene.toml"
STRIBECK = 'friction = { law = "stribeck", boundary = 0.5, full = 0.05, speed = 50.0 }'


def test_pin_takes_laws_by_speed_and_pressure_but_none_by_distance(tmp_path):
    file = tmp_path / "pin.toml"
    file.write_text(PIN.read_text().replace("friction = 0.06", STRIBECK))
    assert read_scene(file).pin.friction == Stribeck(boundary=0.5, full=0.05, speed=50.0)
    file.write_text(PIN.read_text().replace("friction = 0.06", PHASES))
    with pytest.raises(SceneError, match=r"pin\.friction = Lubrication.*depends on the sliding distance"):
        read_scene(file)
    file.write_text(PIN.read_text().replace("friction = 0.06", "friction = [0.06]"))
    with pytest.raises(SceneError, match=r"pin\.friction = \[0\.06\]: must be a number"):
        read_scene(file)


def test_pin_slides_with_the_friction_of_its_speed():
    sheet = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1500.0)
    law = Stribeck(boundary=0.5, full=0.05, speed=50.0)
    pin = Pin(material=sheet, series=PronySeries((1.0,), (1e-3,)), load=20.0, track_radius=math.inf, friction=law)
    stage = PinStage(pin, PinMesh(patch=1.2, column=0.6, reach=2.5, beside=2.0), (0.0, 0.0, 2.0), speed=80.0)
    stage.press()
    found = stage.result(80.0, stage.slide(80.0, SteadyOptions(tolerance=2e-3)), 0.0)
    assert found.surface_friction == pytest.approx(law.mu(0.0, 80.0), rel=0.05)


@pytest.mark.slow
def test_shipped_scene_runs_through_the_four_phases():
    scene = read_scene(PIN.parents[1] / "starving_lubrication" / "scene.toml")
    rows = run(scene, figures=False).recorder.rows
    law = scene.contacts[0].friction
    for row in rows[1:]:
        way = 100.0 * row["strokes in one solve [-]"]
        used = law.mu(row["sliding distance [mm]"] - 0.5 * way)
        assert row["shaft friction coefficient [-]"] == pytest.approx(used, rel=1e-9)
    films = [row["sliding distance [mm]"] for row in rows if row["shaft friction coefficient [-]"] < 0.0601]
    dry = [row["sliding distance [mm]"] for row in rows if row["shaft friction coefficient [-]"] > 1.0999]
    assert 2500 < max(films) < 3500
    assert 10000 < min(dry) < 12500
    assert len(rows) > 15
