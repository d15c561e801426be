import re
import subprocess
import sys

import numpy as np
import pytest

from ngwear.cli import BAD_INPUT, OK, main
from ngwear.errors import ResultError
from ngwear.loop.run import run
from ngwear.plots.contact_pressures import coordinate, pressed
from ngwear.plots.filled import _divided, outline
from ngwear.plots.loaded_section import draw_section
from ngwear.plots.rigid_bodies import body
from ngwear.plots.wear import plot_section
from ngwear.results.kept_sections import KeptSections
from ngwear.results.result_file import read_result
from ngwear.results.section import FIELDS, Section, SectionContact
from ngwear.results.surface_text import surface_of, surface_text
from ngwear.scene.read_scene import read_scene
from ngwear.surfaces import Corner, Cylinder, Plane, Sphere, rod

WINDOW = (np.array([-3.0, -3.0]), np.array([3.0, 3.0]))
HERE = SectionContact(np.zeros((2, 2)), np.zeros(2), np.array([[0, 1]]), np.zeros(2), 0.0)


def area(polygon):
    x, y = polygon.T
    return 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1))


def texts(figure):
    found = [t.get_text() for axes in figure.axes for t in axes.texts] + [t.get_text() for t in figure.texts]
    return {t for t in found if t}


@pytest.mark.parametrize("field", FIELDS)
def test_every_field_is_drawn(finished, field):
    figure = draw_section(read_result(finished), field=field.rsplit(" [", 1)[0].upper())
    assert field in [axes.get_ylabel() for axes in figure.axes]


def test_figure_names_surfaces_and_axes(finished):
    figure = draw_section(read_result(finished))
    assert {"roller", "contact pressure [MPa]", "sheet: after 4 strokes"} <= texts(figure)
    section, bar, panel = figure.axes
    assert (section.get_xlabel(), section.get_ylabel()) == ("x [mm]", "y [mm]")
    assert bar.get_ylabel() == "von Mises stress [MPa]"
    assert (panel.get_title(loc="left"), panel.get_xlabel()) == ("roller", "along roller [mm]")
    (legend,) = figure.legends
    assert [t.get_text() for t in legend.get_texts()] == ["new", "after 4 strokes"]
    lines = [line for axes in figure.axes for line in axes.lines]
    assert all(line.get_marker() == "None" for line in lines), "no dots"


def test_section_is_drawn_to_scale(finished):
    figure = draw_section(read_result(finished))
    section = figure.axes[0]
    wide, high = section.get_position().size * figure.get_size_inches()
    assert wide / np.ptp(section.get_xlim()) == pytest.approx(high / np.ptp(section.get_ylim()), rel=1e-6)


def test_pressures_are_those_of_the_contact(finished):
    result = read_result(finished)
    panel = draw_section(result).axes[2]
    for line, snapshot in zip(panel.lines, KeptSections.of(result).snapshots, strict=True):
        assert np.nanmax(line.get_ydata()) == pytest.approx(snapshot.profiles["roller"]["pressure [MPa]"].max(), 1e-6)


def test_a_new_part_is_drawn_alone(finished):
    figure = draw_section(read_result(finished), stroke=0, mesh=True)
    assert "sheet: new" in texts(figure)
    assert len(figure.axes[2].lines) == 1


def test_unknown_fields_strokes_and_kinds_are_refused_with_those_that_are_known(finished):
    result = read_result(finished)
    with pytest.raises(ResultError, match=r"no field is called 'heat': choose one of 'von Mises stress', 'mean pres"):
        draw_section(result, field="heat")
    with pytest.raises(ResultError, match=r"the section of stroke 3 is not saved; saved: 0, 4; save\.strokes"):
        draw_section(result, stroke=3)
    with pytest.raises(ResultError, match=r"no stroke is called 'back': the cycle has \['stroke'\]"):
        draw_section(result, kind="back")
    with pytest.raises(ResultError, match="'old' has no saved section"):
        draw_section(KeptSections("old", [], {}))


def test_plot_draws_another_field_beside(finished, capsys):
    before = (finished / "section.png").read_bytes()
    assert main(["plot", str(finished), "--field", "maximum principal stress"]) == OK
    path = finished / "section_maximum_principal_stress.png"
    assert capsys.readouterr().out.strip() == str(path)
    assert path.read_bytes().startswith(b"\x89PNG")
    assert (finished / "section.png").read_bytes() == before
    assert main(["plot", str(finished), "--field", "von mises stress"]) == OK
    assert capsys.readouterr().out.strip() == str(finished / "section.png")
    assert main(["plot", str(finished), "--field", "temperature"]) == BAD_INPUT
    assert "choose one of 'von Mises stress'" in capsys.readouterr().err


def test_drawing_again_loads_no_solver(finished):
    code = (
        "import sys; from ngwear.plots.wear import plot_section; "
        f"plot_section({str(finished)!r}); sys.exit('ngsolve' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


LOSES = """remesh = "never"

[deactivation]
depth = 0.3
distortion = { corner_cosine = 0.95 }
"""
ROD = (
    ('kind = "plane strain"', 'kind = "axisymmetric"'),
    ('"cylinder", centre = [2.0, 3.99], radius = 2.0, push = [0.0, -1.0]', '"bore", diameter = 23.96'),
    ("force = 0.5\n", ""),
)


@pytest.mark.parametrize("scene", [pytest.param("elements that may be lost", marks=pytest.mark.slow), "ring in a bore"])
def test_other_scenes_are_drawn(tmp_path, write_sheet, scene):
    if scene == "ring in a bore":
        text = (write_sheet(tmp_path).parent / "sheet.toml").read_text()
        raised = re.sub(r"\[([\d.]+), ([\d.]+)\]", lambda m: f"[{m[1]}, {float(m[2]) + 10}]", text)
        file = write_sheet(tmp_path / "ring", *ROD, outline=raised)
    else:
        file = write_sheet(tmp_path, ('step = "each"', 'step = "each"\n' + LOSES))
    run(read_scene(file), out=tmp_path / "out")
    result = read_result(tmp_path / "out")
    section = Section.of(KeptSections.of(result).at().section)
    assert (len(section.quadrilaterals) > 0) == (scene != "ring in a bore")
    assert sum(map(area, outline(section))) == pytest.approx(8.0, rel=0.02)
    assert (tmp_path / "out" / "section.png").stat().st_size > 10_000


def test_lattices_are_exact_for_parabolas_and_fill_the_element():
    for corners, nodes in (
        (3, [(0, 0), (1, 0), (0, 1), (0.5, 0), (0.5, 0.5), (0, 0.5)]),
        (4, [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5), (0.5, 0.5)]),
    ):
        nodes = np.array(nodes)
        for n in (1, 2, 5):
            place, linear, triangles = _divided(corners, n)
            at = place @ nodes
            assert linear @ nodes[:corners] == pytest.approx(at), "values and places agree on a straight element"
            assert place @ (nodes[:, 0] * nodes[:, 1] + nodes[:, 0] ** 2) == pytest.approx(
                at[:, 0] * at[:, 1] + at[:, 0] ** 2
            )
            areas = [area(at[triangle]) for triangle in triangles]
            assert min(areas) > 0
            assert sum(areas) == pytest.approx(0.5 if corners == 3 else 1.0)


def test_plane_is_a_body_behind_its_face():
    level = body(Plane(point=(0.0, -1.0), normal_vector=(0.0, 1.0)), HERE, {}, WINDOW)
    assert level.bounds == pytest.approx((-3.0, -3.0, 3.0, -1.0))
    turned = body(Plane(point=(0.0, 0.0), normal_vector=(1.0, 1.0)), HERE, {}, WINDOW)
    assert turned.area == pytest.approx(18.0)


def test_surfaces_stand_where_they_have_moved_to_and_are_worn():
    moved = SectionContact(HERE.place, HERE.pressure, HERE.edges, np.array([0.0, 0.5]), 0.25)
    disc = body(Cylinder(centre=(0.0, 0.0), radius=1.0), moved, {}, WINDOW)
    assert disc.bounds == pytest.approx((-1.0, -0.5, 1.0, 1.5), abs=1e-4)
    worn = {
        "counter-surface coordinate [mm]": np.linspace(-1, 1, 21),
        "counter-surface depth [mm]": 0.1 * (1 - np.abs(np.linspace(-1, 1, 21))),
    }
    surface = Plane(point=(0.0, -1.0), normal_vector=(0.0, 1.0))
    plane = body(surface, moved, worn, WINDOW)
    assert 6.0 * 2.5 - plane.area == pytest.approx(0.1, rel=1e-6)
    (lowest,) = [p for p in np.array(plane.exterior.coords) if -0.61 < p[1] < -0.59]
    assert float(surface.along(*lowest)) + 0.25 == pytest.approx(0.0, abs=1e-9)
    half = {k: v * 0.5 for k, v in worn.items()}
    assert body(Cylinder(centre=(0.0, 0.0), radius=1.0), moved, half, WINDOW).area < disc.area


def test_a_corner_is_a_quarter_of_the_plane_without_what_its_rounding_takes_away():
    corner = Corner(point=(0.0, -1.0), normal_vector=(1.0, 0.0), side=(0.0, -1.0), radius=1.0)
    quarter = body(corner, HERE, {}, WINDOW)  # left of x = 0, above y = -1
    assert quarter.bounds == pytest.approx((-3.0, -1.0, 0.0, 3.0))
    assert quarter.area == pytest.approx(3.0 * 4.0 - (1 - np.pi / 4), rel=1e-4)
    inside = np.array([[-0.5, 2.0], [-2.5, -0.9], [-0.4, -0.6]])
    assert (corner.gap(*inside.T) < 0).all()


def test_surfaces_are_told_in_a_file():
    corner = Corner(point=(1.0, 2.0), normal_vector=(1.0, 0.0), side=(0.0, -1.0), radius=0.1)
    for surface in (rod(20.0), corner, Cylinder(centre=(1.0, 2.0), radius=3.0, push=(0.0, 1.0))):
        assert surface_of(surface_text(surface)) == surface
    assert surface_of(surface_text(Sphere(centre=(0.0, 0.0, 1.0), radius=1.0))) is None
    assert body(Sphere(centre=(0.0, 0.0, 1.0), radius=1.0), HERE, {}, WINDOW).is_empty


def test_coordinates_are_those_of_the_picture_where_they_can_be():
    place = np.array([[0.0, 1.0], [1.0, 1.0]])
    contact = SectionContact(place, np.ones(2), np.array([[0, 1]]), np.zeros(2), 0.0)
    assert coordinate("rod", rod(2.0), contact)[1] == "x [mm]"
    assert coordinate("wall", Plane(point=(0.0, 0.0), normal_vector=(1.0, 0.0)), contact)[1] == "y [mm]"
    assert coordinate("mine", None, contact)[1] == "x [mm]"
    slope, name = coordinate("slope", Plane(point=(0.0, 1.0), normal_vector=(-1.0, 1.0)), contact)
    assert name == "along slope [mm]"
    assert abs(slope[1] - slope[0]) == pytest.approx(np.sqrt(0.5))


def test_contacts_that_press_come_in_the_order_of_the_scene(finished):
    section = Section.of(KeptSections.of(read_result(finished)).at().section)
    assert pressed([section], ["wall", "roller"]) == ["roller"]
    assert pressed([section], []) == ["roller"]


def test_picture_that_cannot_be_written(finished):
    (finished / "section_mean_pressure.png").mkdir()
    with pytest.raises(ResultError, match=r"section_mean_pressure\.png cannot be written"):
        plot_section(finished, field="mean pressure")
