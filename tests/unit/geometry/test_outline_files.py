import numpy as np
import pytest

from ngwear.errors import GeometryError
from ngwear.geometry.outline import Outline

CSV = "x [mm],y [mm],edge\n0,0,bottom\n4,0,right\n4,2,top\n0,2,left\n"
RADIUS = 0.5


def write(tmp_path, name, text):
    file = tmp_path / name
    file.write_text(text, encoding="utf-8")
    return file


def test_toml_outline(sheet_file):
    box = Outline.read(sheet_file.with_name("sheet.toml"))
    assert box.area == pytest.approx(8.0, rel=1e-14)
    assert box.edge_names == ("bottom", "right", "top", "left")
    assert box.points[box.corners].tolist() == [[0, 0], [4, 0], [4, 2], [0, 2]]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('name = "top"', "", r"edge\[2\] has no name.*name every edge"),
        ('name = "top"', 'name = "top"\ncolour = 1', r"edge\[2\].*colour.*name, corner and points"),
        ('title = "sheet, 4 x 2 mm"', "units = 'm'", r"units.*title, provenance"),
        ("[4, 2], ", "[4, 2, 0], ", r"sheet\.toml"),
        ("[4, 2], ", "['x', 2], ", r"sheet\.toml.*'x'"),
        ("points = [[4, 0]", "point = [[4, 0]", r"edge\[1\].*point"),
        ('title = "sheet, 4 x 2 mm"', "title = ", r"sheet\.toml"),
        ("[4, 2], ", "[4, 2], [4, 2], ", r"coincide at \[4\.0, 2\.0\]"),
    ],
)
def test_toml_with_a_mistake_is_refused_with_file_and_place(sheet_file, old, new, message):
    file = sheet_file.with_name("sheet.toml")
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))
    with pytest.raises(GeometryError, match=message) as found:
        Outline.read(file)
    assert "sheet.toml" in str(found.value)


@pytest.mark.parametrize("text", ["", "title = 'x'\n", "edge = 5\n", "[[edge]]\nname = 'a'\n", "edge = [5]\n"])
def test_toml_without_points_is_refused(tmp_path, text):
    with pytest.raises(GeometryError, match=r"bad\.toml"):
        Outline.read(write(tmp_path, "bad.toml", text))


def test_csv_without_corner_column_finds_the_corners(tmp_path):
    box = Outline.read(write(tmp_path, "box.csv", CSV))
    assert box.area == pytest.approx(8.0)
    assert box.corners.all()
    assert box.names == ("bottom", "right", "top", "left")


def test_csv_with_corner_column_is_obeyed(tmp_path):
    rows = CSV.splitlines()
    text = "\n".join([rows[0] + ",corner"] + [f"{row},{k % 2}" for k, row in enumerate(rows[1:])])
    assert Outline.read(write(tmp_path, "box.csv", text)).corners.tolist() == [False, True, False, True]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "missing"),
        ("x [mm],y [mm],edge\n", "missing|at least 3 points"),
        ("x,y,edge\n0,0,a\n1,0,a\n0,1,a\n", r"x \[mm\].*missing"),
        (CSV.replace("4,2,top", "4,two,top"), "two"),
        (CSV.replace("4,2,top", "4"), r"box\.csv"),
        (CSV.replace("4,2,top", "4,2"), r"box\.csv"),
        (CSV.replace("4,2,top", "nan,2,top"), "finite"),
        (CSV.replace("edge\n", "edge,corner\n").replace("top", "top,yes"), r"box\.csv"),
    ],
)
def test_csv_with_a_mistake_is_refused_with_the_file(tmp_path, text, message):
    with pytest.raises(GeometryError, match=message) as found:
        Outline.read(write(tmp_path, "box.csv", text))
    assert "box.csv" in str(found.value)


def test_csv_as_a_spreadsheet_writes_it_with_a_byte_order_mark(tmp_path):
    file = tmp_path / "box.csv"
    file.write_text(CSV, encoding="utf-8-sig")
    assert Outline.read(file).area == pytest.approx(8.0)


def step_file(tmp_path, *, mirrored=False):
    import netgen.occ as occ

    a, b, c, d, e = (occ.Pnt(x, y, 0) for x, y in [(0, 0), (4, 0), (4, 2 - RADIUS), (4 - RADIUS, 2), (0, 2)])
    halfway = occ.Pnt(4 - RADIUS * (1 - 0.5**0.5), 2 - RADIUS * (1 - 0.5**0.5), 0)
    arc = occ.ArcOfCircle(c, halfway, d)
    face = occ.Face(occ.Wire([occ.Segment(a, b), occ.Segment(b, c), arc, occ.Segment(d, e), occ.Segment(e, a)]))
    for edge in face.edges:
        middle = edge.center
        if abs(middle.y) < 1e-6:
            edge.name = "bottom"
        elif abs(middle.y - 2) < 1e-6:
            edge.name = "top"
        elif abs(middle.x) < 1e-6:
            edge.name = "left"
        elif abs(middle.x - 4) < 1e-6:
            edge.name = "right"
        else:
            edge.name = "round"
    if mirrored:
        face = face.Mirror(occ.Axis((2, 1, 0), occ.Y))
    file = tmp_path / "box.step"
    face.WriteStep(str(file))
    return file, face.mass


@pytest.mark.parametrize("mirrored", [False, True])
def test_step_rectangle_with_a_rounded_corner(tmp_path, mirrored):
    exact = 8.0 - (1 - np.pi / 4) * RADIUS**2
    file, mass = step_file(tmp_path, mirrored=mirrored)
    assert mass == pytest.approx(exact, rel=1e-9)
    box = Outline.read(file)
    assert box.area == pytest.approx(exact, rel=3e-4), "the polygon turns by at most 0.2 rad at a point"
    t = np.linspace(0, len(box), 50 * len(box), endpoint=False)
    x, y = box.at(t).T
    spline = 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1))
    assert spline == pytest.approx(exact, rel=3e-5)


def test_step_keeps_names_where_they_are(tmp_path):
    box = Outline.read(step_file(tmp_path)[0])
    assert set(box.names) == {"bottom", "right", "round", "top", "left"}
    middle = 0.5 * (box.points + np.roll(box.points, -1, axis=0))
    assert np.allclose(middle[box.on(("bottom",))][:, 1], 0)
    assert np.allclose(middle[box.on(("left",))][:, 0], 0)
    assert (middle[box.on(("round",))].min(axis=0) > [3.4, 1.4]).all()


def test_step_with_two_faces_or_tilted_is_refused(tmp_path):
    import netgen.occ as occ

    file = tmp_path / "solid.step"
    occ.Box((0, 0, 0), (1, 1, 1)).WriteStep(str(file))
    with pytest.raises(GeometryError, match=r"solid\.step.*6 faces.*one plane section"):
        Outline.read(file)
    occ.WorkPlane().Rectangle(1, 1).Face().Rotate(occ.Axis((0, 0, 0), occ.X), 90).WriteStep(str(file))
    with pytest.raises(GeometryError, match=r"solid\.step.*x-y plane"):
        Outline.read(file)


def test_unknown_ending_names_the_known_ones(tmp_path):
    with pytest.raises(GeometryError, match=r"outline\.dxf.*\.toml.*\.csv.*\.step"):
        Outline.read(write(tmp_path, "outline.dxf", ""))


@pytest.mark.parametrize("name", ["a.toml", "a.csv", "a.step"])
def test_missing_file(tmp_path, name):
    with pytest.raises(GeometryError, match=rf"{name}: there is no such outline file"):
        Outline.read(tmp_path / name)


@pytest.mark.parametrize("name", ["a.toml", "a.csv", "a.step", "a.stp"])
def test_garbage_is_refused_with_the_file(tmp_path, name):
    file = tmp_path / name
    file.write_bytes(bytes(range(256)) * 8)
    with pytest.raises(GeometryError, match=name):
        Outline.read(file)
