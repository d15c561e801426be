"""Measured profiles: read, laid over a worn edge, compared, and bad ones refused."""

import json

import h5py
import numpy as np
import pytest
from scipy.integrate import trapezoid

from ngwear.cli import BAD_INPUT, OK, main
from ngwear.errors import ResultError, SceneError
from ngwear.profiles import comparison as compared
from ngwear.profiles.alignment import Placement, align
from ngwear.profiles.measured import Profile, read_profile
from ngwear.profiles.worn_edge import WornEdge, read_worn_edge

PLACE = np.linspace(0.0, 4.0, 2001)
DISTANCE = np.array([0.0, 10.0, 25.0, 50.0, 100.0])


def worn(distance, place=PLACE):
    """A lopsided ridge, and a flat worn into it by a cylinder of 20 mm, off its middle."""
    ridge = 0.05 * np.exp(-((place - 1.6) ** 2)) + 0.02 * np.sin(2 * place)
    half = (0.01 * distance) ** (1 / 3)
    return ridge - np.maximum(0.0, (half**2 - (place - 2.2) ** 2) / 40)


@pytest.fixture
def edge():
    return WornEdge(
        scene="ridge",
        axis="x",
        place=PLACE,
        heights=np.array([worn(d) for d in DISTANCE]),
        distance=DISTANCE,
        strokes=DISTANCE / 10,
        wear_rates={"rod": 2e-6},
        has_memory=False,
        laws_vary=False,
    )


def scanned(distance, *, noise=1e-3, tilt=0.5, shift=(0.2, 7.0), seed=0, span=(0.3, 3.8)):
    """A profile of the closed form, disturbed as an instrument would."""
    x = np.linspace(*span, 1500)
    z = np.random.default_rng(seed).normal(worn(distance, x), noise)
    c, s = np.cos(np.radians(tilt)), np.sin(np.radians(tilt))
    return Profile(c * x - s * z + shift[0], s * x + c * z + shift[1])


def written(path, profile, header="x [mm],z [mm]", scale=(1.0, 1.0)):
    table = np.column_stack([scale[0] * profile.x, scale[1] * profile.z])
    np.savetxt(path, table, delimiter=",", header=header, comments="", encoding="utf-8")
    return path


@pytest.fixture
def compare(edge, tmp_path, monkeypatch):
    """``compare(profile, header, scale, ...)`` with the edge above in place of a run's."""
    monkeypatch.setattr(compared, "read_worn_edge", lambda folder, *, edges: edge)

    def call(profile, header="x [mm],z [mm]", scale=(1.0, 1.0), **options):
        return compared.compare_profile(tmp_path, written(tmp_path / "p.csv", profile, header, scale), **options)

    return call


def test_a_placement_is_a_rigid_motion():
    x, z = np.array([0.0, 3.0, 3.0]), np.array([0.0, 0.0, 4.0])
    place, height = Placement(1.0, 2.0, 0.3, (1.0, 1.0))(x, z)
    assert np.hypot(place[2] - place[0], height[2] - height[0]) == pytest.approx(5.0)
    assert Placement(0.0, 0.0, np.pi / 2, (0.0, 0.0))(x, z)[1] == pytest.approx([0.0, 3.0, 3.0])


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_rate_area_shift_and_tilt_are_found_again(compare, seed):
    """The part wore at 1.3 times the run's rate over half of its distance: the outline after 65 of 100 mm."""
    found = compare(scanned(65.0, seed=seed), strokes=5).as_dict()
    x = np.linspace(0.3, 3.8, 1500)
    assert found["rod specific wear rate [mm^2/N]"] == pytest.approx(1.3 * 2e-6, rel=0.03)
    off = abs(found["measured over simulated specific wear rate [-]"] - 1.3)
    assert off < 4 * found["standard error of it [-]"] < 0.12
    assert found["worn area, measured [mm^2]"] == pytest.approx(trapezoid(worn(0, x) - worn(65.0, x), x), rel=0.03)
    assert found["worn area, simulated [mm^2]"] == pytest.approx(trapezoid(worn(0, x) - worn(50.0, x), x), rel=1e-3)
    assert found["shift along x [mm]"] == pytest.approx(-0.2, abs=0.02)
    assert found["tilt [deg]"] == pytest.approx(-0.5, abs=0.01)
    assert found["best fit: RMS deviation [mm]"] == pytest.approx(1e-3, rel=0.05)
    assert found["RMS deviation [mm]"] > found["best fit: RMS deviation [mm]"]
    assert found["largest deviation, measured less simulated [mm]"] < 0, "worn deeper than the run at that distance"
    assert found["notes"] == []


def test_dust_pulls_little(compare):
    profile = scanned(65.0)
    z = profile.z.copy()
    z[::40] += 0.03
    found = compare(Profile(profile.x, z), distance=50.0)
    assert found.factor == pytest.approx(1.3, rel=0.05)
    assert [note.split(":")[0] for note in found.notes] == [
        "38 points stand out from the best fit by more than 8 times the noise"
    ]


@pytest.mark.parametrize(
    ("turns", "told"),
    [
        ({"upside_down": True}, "upside down.*give --upside-down"),
        ({"mirrored": True}, "mirrored.*give --mirrored"),
        ({"upside_down": True, "mirrored": True}, "upside down and mirrored.*--upside-down.*--mirrored"),
    ],
)
def test_a_turned_profile_is_recognised_and_may_be_turned_back(compare, turns, told):
    profile = scanned(65.0).turned(**turns)
    with pytest.raises(SceneError, match=told):
        compare(profile)
    assert compare(profile, **turns).factor == pytest.approx(0.65, rel=0.03)


def test_flags_that_turn_a_good_profile_over_are_recognised(compare):
    with pytest.raises(SceneError, match="leave out --upside-down"):
        compare(scanned(65.0), upside_down=True)


@pytest.mark.parametrize(
    ("header", "scale", "told"),
    [
        (
            "x [mm],z [mm]",
            (1, 1e3),
            r"z.*divided by 1000 they fit: are the values in µm\? Name the column's unit \[µm\]",
        ),
        ("x [mm],z [µm]", (1, 1), r"z.*multiplied by 1000 they fit: are the values in mm under a header that says µm"),
        ("x [mm],z [mm]", (1e3, 1e3), r"x = 3499\.\d+: so many mm long, where the edge measures 4 mm: .* in µm\?"),
        ("x [um],z [mm]", (1, 1), r"x = 0\.0034\d+: so many mm long.*in mm under a header that says µm"),
        ("x,z [mm]", (1e3, 1), r"column = 'x': name its unit.*from end to end it is 3500.*in µm\?"),
        ("x [inch],z [mm]", (1, 1), r"column = 'x \[inch\]': name its unit.*the values look like mm"),
    ],
)
def test_another_unit_is_recognised(compare, header, scale, told):
    with pytest.raises(SceneError, match=told):
        compare(scanned(65.0), header, scale)


def test_a_header_in_micrometres_is_converted(compare):
    assert compare(scanned(65.0), "x [um],z [µm]", (1e3, 1e3)).factor == pytest.approx(0.65, rel=0.03)


def test_a_part_worn_beyond_the_run_is_said_so(compare):
    found = compare(scanned(160.0))
    told = found.as_dict()
    assert found.beyond
    assert found.factor is None
    assert told["rod specific wear rate [mm^2/N]"] is None
    assert any("deeper than the run's last outline: run about" in note for note in told["notes"])
    json.dumps(told, allow_nan=False)


def test_a_part_that_slid_further_than_the_run_is_compared_with_its_end(compare):
    found = compare(scanned(65.0), distance=400.0)
    assert found.compared == 100.0
    assert found.factor == pytest.approx(65.0 / 400.0, rel=0.03)
    assert any("compared with the run's end" in note for note in found.notes)


def test_uniform_wear_cannot_be_told_from_a_shift(edge):
    flat = WornEdge(**{**edge.__dict__, "heights": edge.heights[0] - 1e-4 * DISTANCE[:, None]})
    assert align(scanned(0.0), flat).error > flat.end


@pytest.mark.parametrize(("tilt", "shift"), [(5.0, 0.2), (0.0, 2.0)])
def test_large_tilts_and_shifts_are_pointed_out(compare, tilt, shift):
    (note,) = compare(scanned(65.0, tilt=tilt, shift=(shift, 0.0))).notes
    assert ("levelled" in note) == bool(tilt)
    assert ("where it should" in note) == (shift > 1)


@pytest.mark.parametrize("options", [{"distance": 0.0}, {"distance": -1.0}, {"strokes": 1, "distance": 5.0}])
def test_distances_that_cannot_be(compare, options):
    with pytest.raises(SceneError, match="distance"):
        compare(scanned(65.0), **options)


def test_a_profile_of_something_else_is_said_so(compare):
    x = np.linspace(0.0, 3.5, 500)
    notes = compare(Profile(x, 0.03 * np.sin(9 * x))).notes
    assert any("hardly resemble each other" in note for note in notes)


ROWS = [f"{0.1 * i:.3f},{0.01 * np.sin(i):.6f}" for i in range(30)]


def test_a_table_is_mended_and_says_how(tmp_path):
    path = tmp_path / "p.csv"
    rows = ["0.2,", "0.3,NaN", *ROWS[10:], *ROWS[:10], "0.0,0.01", ""]
    path.write_bytes("\n".join(["# instrument", "x [mm],z [µm],quality", *(f"{r},1" for r in rows)]).encode("latin-1"))
    profile = read_profile(path)
    assert len(profile.x) == 30
    assert (np.diff(profile.x) > 0).all()
    assert profile.z[0] == pytest.approx(0.5e-5)
    assert [n.split()[0] for n in profile.notes] == ["3", "x", "1"]


def test_semicolons_falling_places_and_a_hole(tmp_path):
    path = tmp_path / "p.csv"
    path.write_text("\n".join(["x [mm];z [mm]", *(r.replace(",", ";") for r in ROWS[:10:-1] + ROWS[:6])]))
    profile = read_profile(path)
    assert profile.x[0] == 0.0
    assert any("nothing is known between x = 0.5 and 1.1 mm" in note for note in profile.notes)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("", "empty"),
        ("x [mm],y [mm]\n1,2", r"column 'z \[mm\]' or 'z \[µm\]' is missing"),
        ("x [mm],z [mm]\n1,2\n2,3", "only so many of 2 points"),
        ("x [mm],z [mm]\n1,2\n2,a3", r"line 3, z \[mm\] = 'a3': must be a number"),
        ("x [mm],z [mm]\n" + "\n".join(ROWS) + "\n1,\n" * 40, "only so many of 70"),
        ("x [mm],z [mm]\n" + "\n".join(f"{i},1.5" for i in range(30)), "all heights are the same"),
        ("x [mm],z [mm]\n" + "\n".join(f"1.0,{i}" for i in range(30)), "at least 20 pairs"),
        ("x,z\n" + "\n".join(ROWS), r"column = 'x': name its unit: 'x \[mm\]' or 'x \[µm\]'"),
    ],
)
def test_tables_that_are_no_profile(tmp_path, content, told):
    path = tmp_path / "p.csv"
    path.write_text(content)
    with pytest.raises(SceneError, match=told):
        read_profile(path)


def test_a_missing_table(tmp_path):
    with pytest.raises(SceneError, match="no such file"):
        read_profile(tmp_path / "p.csv")


@pytest.mark.parametrize(
    ("edges", "axis", "height"),
    [(("top",), "x", 2.0), (("right",), "y", 4.0), (("bottom",), "x", 0.0), (("left",), "y", 0.0)],
)
def test_an_edge_is_seen_from_outside(finished, edges, axis, height):
    seen = read_worn_edge(finished, edges=edges)
    assert seen.axis == axis
    assert seen.heights[0] == pytest.approx(height, abs=1e-9)
    assert seen.length == pytest.approx(4.0 if axis == "x" else 2.0, abs=5e-3)
    assert (np.diff(seen.distance) > 0).all()
    assert seen.end == 40.0
    assert seen.strokes_at(seen.distance_at(9.0)) == pytest.approx(9.0)


def test_the_worn_area_of_an_edge_is_the_runs(finished):
    seen = read_worn_edge(finished)
    summary = json.loads((finished / "summary.json").read_text())
    area = trapezoid(seen.heights[0] - seen.heights[-1], seen.place)
    assert area == pytest.approx(summary["worn area [mm^2]"], rel=1e-3)


@pytest.fixture
def profile_of_run(finished, tmp_path):
    """A profile of the small sheet after 3 of its 4 strokes."""
    seen = read_worn_edge(finished)
    x = np.linspace(0.2, 3.8, 800)
    z = np.interp(x, seen.place, seen.at(30.0)) + np.random.default_rng(0).normal(0, 1e-4, len(x))
    return written(tmp_path / "p.csv", Profile(x, z))


def test_command(finished, profile_of_run, capsys):
    before = {p.name: p.read_bytes() for p in finished.iterdir()}
    assert main(["compare", str(finished), str(profile_of_run), "--strokes", "2"]) == OK
    shown = capsys.readouterr().out
    numbers = json.loads((finished / "measured.json").read_text())
    assert numbers["roller specific wear rate [mm^2/N]"] == pytest.approx(1.5e-3, rel=0.05)
    assert "roller specific wear rate [mm^2/N]" in shown
    assert shown.split()[-2:] == [str(finished / "measured.json"), str(finished / "measured.png")]
    assert (finished / "measured.png").stat().st_size > 10_000
    assert {p.name: p.read_bytes() for p in finished.iterdir() if p.name in before} == before
    assert main(["compare", str(finished), str(profile_of_run), "--distance", "20", "--json"]) == OK
    assert json.loads(capsys.readouterr().out) == numbers


@pytest.mark.parametrize(
    ("more", "told"), [(["--edges", "lip"], "no such edge"), (["--upside-down"], "leave out --upside-down")]
)
def test_command_with_bad_input(finished, profile_of_run, capsys, more, told):
    assert main(["compare", str(finished), str(profile_of_run), *more]) == BAD_INPUT
    shown = capsys.readouterr()
    assert told in shown.err
    assert shown.err.count("\n") == 1
    assert not (finished / "measured.json").exists()


def test_command_without_a_run(tmp_path, profile_of_run, capsys):
    assert main(["compare", str(tmp_path), str(profile_of_run)]) == BAD_INPUT
    assert "result.h5 does not exist" in capsys.readouterr().err


def test_a_run_without_wear_is_refused(finished, profile_of_run):
    with h5py.File(finished / "result.h5", "a") as h5:
        h5["contacts/roller"].attrs["specific wear rate [mm^2 per N]"] = 0.0
    with pytest.raises(ResultError, match="nothing has worn"):
        read_worn_edge(finished)


@pytest.mark.parametrize("name", ["measured.json", "measured.png"])
def test_files_that_cannot_be_written_are_said_so(finished, profile_of_run, capsys, name):
    (finished / name).mkdir()
    assert main(["compare", str(finished), str(profile_of_run)]) == BAD_INPUT
    assert "cannot be written" in capsys.readouterr().err
