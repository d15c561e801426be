import math
import pickle
from dataclasses import replace

import pytest
from conftest import edited

from ngwear.errors import GeometryError, SceneError
from ngwear.scene.program import Program, Stroke
from ngwear.scene.read_scene import read_scene
from ngwear.surfaces import Corner

ROLLER = 'surface = { type = "cylinder", centre = [2.0, 3.99], radius = 2.0, push = [0.0, -1.0] }'
EDGES = 'edges = ["top"]'


def test_small_scene_is_read(sheet):
    (roller,) = sheet.contacts
    assert (roller.force, roller.friction, roller.specific_wear_rate) == (0.5, 0.1, 1e-3)
    assert not sheet.axisymmetric
    assert sheet.supports[0].edges == ("bottom",)
    assert sheet.program.cycle[0].travel == 10.0
    assert sheet.followed == (roller,)


def test_shipped_seal_is_read(seal):
    assert seal.axisymmetric
    assert seal.program.strokes == 200
    assert [s.direction for s in seal.program.cycle] == [-1.0, 1.0]
    assert seal.part.material.shear_modulus == pytest.approx(16.0)
    assert [c.name for c in seal.followed] == ["rod"]
    still = tuple(replace(contact, specific_wear_rate=0.0) for contact in seal.contacts)
    assert replace(seal, contacts=still).followed == still  # where nothing wears, all contacts are looked at


# (piece of the scene, what it becomes, place, value, words of the remedy)
BAD = {
    # unknown keys, one at each level
    "unknown table": ("[wear]", "[waer]", "waer", {"step": "each"}, "unknown key; known here.*'wear'"),
    "unknown scene key": ('kind = "pl', 'colour = 1\nkind = "pl', "scene.colour", 1, "unknown key.*'kind'"),
    "unknown contour key": ('file = "', 'scale = 2\nfile = "', "contour.scale", 2, "unknown key.*'file'"),
    "unknown material key": ("shear = 1.0", "shear = 1.0\nc10 = 1", "material.c10", 1, "unknown key.*'shear'"),
    "unknown contact key": ("friction = 0.1", "frictoin = 0.1", "contact[0].frictoin", 0.1, "unknown key.*'friction'"),
    "unknown surface key": ("radius = 2.0", "diameter = 4.0", "contact[0].surface.diameter", 4.0, "unknown.*'radius'"),
    "unknown support key": ("[program]\n", "z = true\n[program]\n", "support[0].z", True, "unknown key.*'x'"),
    "unknown program key": ("strokes = 4", "strokes = 4\ncycles = 2", "program.cycles", 2, "unknown key.*'strokes'"),
    "unknown stroke key": ("travel = 10.0", "length = 10.0", "program.stroke[0].length", 10.0, "unknown.*'travel'"),
    "unknown accuracy key": ("patch = 0.2", "patches = 0.1", "accuracy.patches", 0.1, "unknown key.*'patch'"),
    "unknown wear key": ('step = "each"', 'steps = "each"', "wear.steps", "each", "unknown key.*'step'"),
    # missing
    "no kind": ('kind = "plane strain"\n', "", "scene.kind", None, "is missing"),
    "no contour": ('[contour]\nfile = "sheet.toml"\n', "", "scene file.contour", None, "is missing"),
    "no contour file": ('file = "sheet.toml"\n', "", "contour.file", None, "is missing"),
    "no model": ('model = "neo-hooke"\n', "", "material.model", None, "is missing"),
    "no modulus": ("shear = 1.0\n", "", "material.shear", None, "is missing"),
    "no contact name": ('name = "roller"\n', "", "contact[0].name", None, "is missing"),
    "no contact edges": (EDGES, "edges = []", "contact 'roller'.edges", (), "at least one edge"),
    "no surface": (ROLLER + "\n", "", "contact[0].surface", None, "is missing"),
    "no surface type": ('type = "cylinder", ', "", "contact[0].surface.type", None, "must be one of.*'cylinder'"),
    "no radius": ("radius = 2.0, ", "", "contact[0].surface.radius", None, "is missing"),
    "no strokes": ("strokes = 4\n", "", "program.strokes", None, "is missing"),
    "no travel": ("travel = 10.0\n", "", "program.stroke[0].travel", None, "is missing"),
    # wrong types
    "kind": ('"plane strain"', '"plane stress"', "scene.kind", "plane stress", "axisymmetric"),
    "kind list": ('"plane strain"', '["plane strain"]', "scene.kind", ["plane strain"], "axisymmetric"),
    "model": ('"neo-hooke"', '"ogden"', "material.model", "ogden", "neo-hooke.*mooney-rivlin"),
    "model list": ('"neo-hooke"', '["neo-hooke"]', "material.model", ["neo-hooke"], "neo-hooke"),
    "modulus text": ("shear = 1.0", 'shear = "soft"', "material.shear", "soft", "number"),
    "modulus true": ("shear = 1.0", "shear = true", "material.shear", True, "number"),
    "force text": ("force = 0.5", 'force = "0.5 N"', "contact[0].force", "0.5 N", "must be a number"),
    "edges text": (EDGES, 'edges = "top"', "contact[0].edges", "top", "list of names"),
    "edges number": (EDGES, "edges = 5", "contact[0].edges", 5, "list of names"),
    "edges numbers": (EDGES, "edges = [5]", "contact[0].edges", [5], "list of names"),
    "name number": ('name = "roller"', "name = 5", "contact[0].name", 5, "text in quotes"),
    "surface text": (ROLLER, 'surface = "rod"', "contact[0].surface", "rod", "table"),
    "surface type": ('"cylinder"', '"sphere"', "contact[0].surface.type", "sphere", "must be one of"),
    "surface type list": ('"cylinder"', "[1]", "contact[0].surface.type", [1], "must be one of"),
    "radius text": ("radius = 2.0", 'radius = "2"', "contact[0].surface.radius", "2", "must be a number"),
    "radius pair": ("radius = 2.0", "radius = [2, 2]", "contact[0].surface.radius", "[2, 2]|(2.0, 2.0)", "number"),
    "centre triple": ("[2.0, 3.99]", "[2, 4, 0]", "contact[0].surface.centre", [2, 4, 0], "two numbers"),
    "centre number": ("[2.0, 3.99]", "4.0", "contact[0].surface.centre", 4.0, "two numbers"),
    "contact table": ("[[contact]]", "[contact]", "contact", None, r"list of tables \[\[contact\]\]"),
    "program text": ("strokes = 4", "strokes = 4.5", "program.strokes", 4.5, "whole number"),
    "strokes true": ("strokes = 4", "strokes = true", "program.strokes", True, "whole number"),
    "support x": ("[program]\n", "x = 1\n[program]\n", "support[0].x", 1, "true or false"),
    "jump": ('step = "each"', "max_jump = 2.5", "wear.max_jump", 2.5, "whole number"),
    "save": ("[wear]", "[save]\nstrokes = 5\n[wear]", "save.strokes", 5, "list of whole numbers"),
    # names that do not exist
    "unknown edge": (EDGES, 'edges = ["lip"]', "contact 'roller'.edges", "lip", "no such edge.*'top'"),
    "unknown held edge": ('edges = ["bottom"]', 'edges = ["base"]', "support[0].edges", "base", "no such edge.*bottom"),
    "no edges": (EDGES, "edges = []", "contact 'roller'.edges", (), "at least one edge"),
    # out of range
    "shear": ("shear = 1.0", "shear = -1.0", "material.shear", -1.0, "greater than 0 MPa"),
    "bulk": ("bulk_modulus = 100.0", "bulk_modulus = 0", "material.bulk_modulus", 0.0, "greater than 0 MPa"),
    "friction": ("friction = 0.1", "friction = -0.1", "contact 'roller'.friction", -0.1, "at least 0"),
    "friction nan": ("friction = 0.1", "friction = nan", ".friction", math.nan, "at least 0|finite"),
    "wear rate": ("1.0e-3", "-1e-3", "contact 'roller'.specific_wear_rate", -1e-3, "at least 0 mm²/N"),
    "wear rate inf": ("1.0e-3", "inf", ".specific_wear_rate", math.inf, "finite"),
    "force": ("force = 0.5", "force = -0.5", "contact 'roller'.force", -0.5, "greater than 0"),
    "force inf": ("force = 0.5", "force = inf", ".force", math.inf, "finite"),
    "radius": ("radius = 2.0", "radius = -2.0", "surface.radius", -2.0, "greater than 0 mm"),
    "travel": ("travel = 10.0", "travel = 0", "program.stroke 'stroke'.travel", 0.0, "greater than 0 mm"),
    "travel inf": ("travel = 10.0", "travel = inf", ".travel", math.inf, "finite"),
    "direction": ("travel = 10.0", "travel = 1\ndirection = 2", "'stroke'.direction", 2.0, "between -1 and 1"),
    "negative pressure": ("travel = 10.0", "travel = 1\npressure = -2", "'stroke'.pressure", -2.0, "at least 0 MPa"),
    "pressure, no fluid": ("travel = 10.0", "travel = 1\npressure = 2", "'stroke'.pressure", 2.0, r"\[fluid\] table"),
    "no stroke": ('[[program.stroke]]\nname = "stroke"\ntravel = 10.0\n', "", "program.stroke", (), "at least one"),
    "strokes": ("strokes = 4", "strokes = -4", "program.strokes", -4, "at least 0"),
    "patch": ("patch = 0.2", "patch = 0", "accuracy.patch", 0.0, "greater than 0 mm"),
    "coarse": ("coarse = 0.5", "coarse = 0.05", "accuracy.coarse", 0.05, "at least the patch size"),
    "grading": ("patch = 0.2", "patch = 0.2\ngrading = 2", "accuracy.grading", 2.0, "between 0 and 1"),
    "stress error": (
        "patch = 0.2",
        "patch = 0.2\nstress_error = 0",
        "accuracy.stress_error",
        0.0,
        "between 0 and 1",
    ),
    "scheme": ('step = "each"', 'scheme = "magic"', "wear.scheme", "magic", "implicit.*explicit"),
    "step": ('step = "each"', 'step = "all"', "wear.step", "all", "jump.*each"),
    "save stroke": ("[wear]", "[save]\nstrokes = [0]\n[wear]", "save.strokes", (0,), "above 0"),
    # geometry
    "inside": ("[2.0, 3.99]", "[2.0, 2.0]", "contact 'roller'.surface", None, "wrong side.*1 mm inside"),
}


@pytest.mark.parametrize("case", BAD)
def test_mistake_is_refused_with_place_value_and_remedy(tmp_path, write_sheet, case):
    old, new, place, value, remedy = BAD[case]
    with pytest.raises(SceneError, match=remedy) as found:
        read_scene(write_sheet(tmp_path, (old, new)))
    assert place in found.value.place
    if isinstance(value, str) and "|" in value:
        assert repr(found.value.value) in value.split("|")
    elif value is not None:
        assert repr(found.value.value) == repr(value) or found.value.value == value
        assert repr(found.value.value) in str(found.value)
    assert found.value.remedy


def test_contacts_must_differ_in_name(tmp_path, write_sheet):
    again = f'[[contact]]\nname = "roller"\n{EDGES}\n{ROLLER}\n[[support]]'
    with pytest.raises(SceneError, match=r"contact\.name.*differ"):
        read_scene(write_sheet(tmp_path, ("[[support]]", again)))


def test_axisymmetric_section_must_lie_above_the_axis(tmp_path, write_sheet):
    with pytest.raises(SceneError, match=r"contour = 0\.0.*radii > 0 mm"):
        read_scene(write_sheet(tmp_path, ('"plane strain"', '"axisymmetric"')))


@pytest.mark.parametrize(
    ("old", "new", "contact"),
    [
        ('"rod", diameter = 22.2', '"rod", diameter = 30.0', "rod"),
        ('type = "bore", diameter = ', 'type = "bore", diameter = 21.0 } # ', "housing bore"),
        ("normal = [-1.0, 0.0]", "normal = [1.0, 0.0]", "sealed shoulder"),
    ],
)
def test_surface_on_the_wrong_side(tmp_path, seal_text, old, new, contact):
    file = tmp_path / "seal.toml"
    file.write_text(edited(seal_text, [(old, new)]))
    with pytest.raises(SceneError, match=rf"contact '{contact}'\.surface.*wrong side.*check diameters"):
        read_scene(file)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('inlet = ["sealed face"]', 'inlet = ["heel"]', r"fluid\.inlet.*some of the fluid's edges"),
        ('inlet = ["sealed face"]', "inlet = []", r"fluid\.inlet.*some of the fluid's edges"),
        ('inlet = ["sealed face"]', "", r"fluid\.inlet.*missing"),
        ('inlet = ["sealed face"]', 'inlet = "sealed face"', r"fluid\.inlet.*list of names"),
        ('"sealed round", "static face"]\ninlet', '"moon"]\ninlet', r"fluid\.edges = 'moon'.*no such edge"),
        ('inlet = ["sealed face"]', 'inlet = ["sealed face"]\npressure = 2', r"fluid\.pressure.*unknown key"),
    ],
)
def test_fluid_mistakes(tmp_path, seal_text, old, new, message):
    file = tmp_path / "seal.toml"
    file.write_text(edited(seal_text, [(old, new)]))
    with pytest.raises(SceneError, match=message):
        read_scene(file)


def test_scene_that_is_missing_a_folder_not_toml_or_not_text(tmp_path):
    with pytest.raises(SceneError, match=r"nowhere\.toml.*cannot be read: No such file"):
        read_scene(tmp_path / "nowhere.toml")
    with pytest.raises(SceneError, match="cannot be read: Is a directory"):
        read_scene(tmp_path)
    file = tmp_path / "bad.toml"
    file.write_text("[scene\n")
    with pytest.raises(SceneError, match=r"bad\.toml.*not valid TOML: .*line 1"):
        read_scene(file)
    file.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SceneError, match="not valid TOML"):
        read_scene(file)


@pytest.mark.parametrize("name", ["nowhere.toml", "sheet.dxf", "."])
def test_outline_file_that_cannot_be_read(tmp_path, write_sheet, name):
    with pytest.raises(GeometryError, match=r"no such outline file|outlines are read from"):
        read_scene(write_sheet(tmp_path, ("sheet.toml", name)))


def test_classes_check_themselves_without_a_file():
    with pytest.raises(SceneError, match=r"program\.stroke 'out'\.travel = -1"):
        Stroke(name="out", travel=-1.0)
    with pytest.raises(SceneError, match=r"program\.stroke.*at least one"):
        Program(cycle=(), strokes=1)


def test_a_scene_that_another_process_was_handed_can_be_changed_there(sheet):
    """An infinite default is another object there."""
    program = replace(sheet.program, rest=float("inf"))
    assert replace(pickle.loads(pickle.dumps(program)), strokes=2).rest == math.inf


def test_a_wall_may_end_at_a_gap(tmp_path, write_sheet):
    wall = 'surface = { type = "corner", point = [2.0, 2.0], normal = [0.0, -2.0], side = [1.0, 0.0], radius = 0.1 }'
    scene = read_scene(write_sheet(tmp_path, (ROLLER, wall)))
    (contact,) = scene.contacts
    assert contact.surface == Corner(point=(2.0, 2.0), normal_vector=(0.0, -1.0), side=(1.0, 0.0), radius=0.1)
    scene.write(tmp_path / "again.toml")
    assert read_scene(tmp_path / "again.toml").contacts == scene.contacts
