"""``import ngwear as nw``: its names, what it loads, and what a script without a guard gets."""

import ast
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import ngwear as nw
from ngwear.errors import ResultError, SceneError

ROOT = Path(nw.__file__).parent
SCRIPT = """
import ngwear as nw

class Rubber(nw.NeoHooke):
    pass

sheet = nw.Part(nw.Outline.rectangle((-2.0, 2.0), (0.0, 2.0)), material={material}(shear=1.0, bulk_modulus=100.0))
roller = nw.Contact(
    "roller", edges=["top"], surface=nw.Cylinder(centre=(0.0, 4.0), radius=2.0), force=0.5, specific_wear_rate=1e-3
)
scene = nw.Scene(
    "sheet",
    sheet,
    contacts=[roller],
    supports=[nw.Support(edges=["bottom"])],
    program=nw.Program(strokes=4, cycle=[nw.Stroke("slide", travel=10.0)]),
    axisymmetric=False,
    accuracy=nw.Accuracy(patch=0.15, coarse=0.5, mounting=0.2),
)
result = nw.run(scene, progress=False)
print(result.summary["error estimates"]["maximum depth by mesh and wear steps [-]"] > 0)
"""


def python(code, *arguments):
    return subprocess.run([sys.executable, *arguments, "-c", code], capture_output=True, text=True, check=True).stdout


def test_every_name_is_there_and_the_stub_has_the_same():
    for name in nw.__all__:
        assert getattr(nw, name) is not None
    tree = ast.parse((ROOT / "__init__.pyi").read_text(encoding="utf-8"))
    imports = [node for node in tree.body if isinstance(node, ast.ImportFrom)]
    assert {alias.asname: node.module for node in imports for alias in node.names} == nw._MODULES
    assert set(nw.__all__) <= set(dir(nw))
    with pytest.raises(AttributeError, match="no attribute 'runn'"):
        _ = nw.runn


def test_import_loads_nothing():
    loaded = python(
        "import sys, ngwear; print(sorted(m for m in sys.modules if m.split('.')[0] in "
        "('numpy', 'ngsolve', 'netgen', 'scipy') or m.startswith('ngwear.')))"
    )
    assert loaded.strip() == "[]"


def test_openblas_starts_with_one_thread_unless_the_user_says_otherwise():
    code = "import os, sys; {}import ngwear; print(os.environ['OPENBLAS_NUM_THREADS'], ngwear.NUMPY_CAME_FIRST)"
    assert python(code.format("os.environ.pop('OPENBLAS_NUM_THREADS', 0); ")).split() == ["1", "False"]
    assert python(code.format("os.environ['OPENBLAS_NUM_THREADS'] = '3'; import numpy; ")).split() == ["3", "True"]


def test_the_room_of_the_verb_verify_is_the_verb():
    assert python("import ngwear.verify.base, ngwear as nw; print(callable(nw.verify))").strip() == "True"


@pytest.mark.parametrize("material", ["nw.NeoHooke", pytest.param("Rubber", marks=pytest.mark.slow)])
def test_a_script_without_a_guard_states_errors(tmp_path, material):
    """The second process must not run the script again; a class of the script's own keeps all in one process."""
    script = tmp_path / "script.py"
    script.write_text(SCRIPT.replace("{material}", material), encoding="utf-8")
    run = subprocess.run([sys.executable, script], capture_output=True, text=True, check=False)
    assert (run.stdout, run.returncode) == ("True\n", 0), run.stderr


@pytest.fixture(scope="module")
def folder(tmp_path_factory, request):
    scene = request.getfixturevalue("sheet_scene_module")
    out = tmp_path_factory.mktemp("face") / "out"
    return out, nw.run(scene, out=out, alone=True, progress=False)


@pytest.fixture(scope="module")
def sheet_scene_module(tmp_path_factory):
    from conftest import SHEET_OUTLINE, SHEET_SCENE

    path = tmp_path_factory.mktemp("sheet")
    (path / "sheet.toml").write_text(SHEET_OUTLINE, encoding="utf-8")
    (path / "scene.toml").write_text(SHEET_SCENE, encoding="utf-8")
    return nw.read_scene(path / "scene.toml")


def test_a_result_gives_outlines_pressures_and_series_also_from_its_folder(folder):
    out, result = folder
    read = nw.read_result(out)
    assert str(read) == str(result)
    assert "maximum depth [mm]" in str(result)
    for one in (result, read):
        np.testing.assert_array_equal(one.worn_profile, result.outline(4))
        assert one.outline(0).shape[1] == 2
        first, last = one.pressure(stroke=0), one.pressure("roller", stroke=4)
        assert first.pressure.max() > last.pressure.max() > 0
        assert set(map(len, last.table.values())) == {len(last.along)}
        assert len(one.series["maximum depth [mm]"]) == 5
        assert one.plot("mean pressure", stroke=0).axes
    assert np.shares_memory(result.pressure().place, result.snapshots[-1].profiles["roller"]["place [mm]"])


def test_a_result_hands_out_ngsolves_objects(folder):
    import ngsolve as ng

    _, result = folder
    mesh, stress = result.mesh, result.stress
    width = 4.0
    lifted = ng.Integrate(stress[1, 1], mesh) / 2.0  # force per height: the plate's reaction, on the mean
    assert lifted == pytest.approx(-0.5, rel=0.1)
    assert ng.Integrate(1, mesh) < 2 * width
    low = ng.Integrate(result.displacement[1], mesh)
    assert low < 0


def test_what_was_not_kept_is_said(folder):
    out, result = folder
    with pytest.raises(ResultError, match=r"stroke 9 was not saved.* 1, 2, 3, 4"):
        result.outline(9)
    with pytest.raises(ResultError, match=r"contact 'rod' was not saved; saved: \['roller'\]"):
        result.pressure("rod")
    with pytest.raises(ResultError, match="no stroke is called 'back'"):
        result.pressure(kind="back")
    with pytest.raises(ResultError, match="has no mesh and no fields"):
        _ = nw.read_result(out).mesh
    with pytest.raises(ResultError, match="does not exist"):
        nw.read_result(out / "nowhere")


def test_a_scene_is_written_and_read_again(sheet_scene_module, tmp_path):
    scene = sheet_scene_module
    scene.write(tmp_path / "again.toml")
    again = nw.read_scene(tmp_path / "again.toml")
    assert repr(again.contacts) == repr(scene.contacts)
    assert (again.program, again.accuracy, again.wear, again.save) == (
        scene.program,
        scene.accuracy,
        scene.wear,
        scene.save,
    )
    np.testing.assert_array_equal(again.part.outline.points, scene.part.outline.points)


def test_what_a_file_cannot_say_leaves_none(sheet_scene_module, tmp_path):
    from dataclasses import replace

    class Rubber(nw.NeoHooke):
        pass

    part = replace(sheet_scene_module.part, material=Rubber(shear=1.0, bulk_modulus=100.0))
    with pytest.raises(SceneError, match="a scene file can only hold NeoHooke, MooneyRivlin"):
        replace(sheet_scene_module, part=part).write(tmp_path / "own.toml")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"edges": "top"}, r"edges = 'top': must be a list of names"),
        ({"surface": 3}, "surface = 3: must be a rigid surface"),
        ({"force": "much"}, "force = 'much': must be a number"),
        ({"friction": "dry"}, "friction = 'dry': must be a number"),
        ({"wear_law": 2.0}, "wear_law = 2.0: must be a law of wear"),
    ],
)
def test_bad_values_from_python_name_place_and_remedy(change, told):
    given = {"edges": ["top"], "surface": nw.rod(diameter=10.0)} | change
    with pytest.raises(SceneError, match=told):
        nw.Contact("rod", **given)


def test_bad_ways_to_run_are_refused(sheet_scene_module):
    for how, told in (
        ({"resume": True}, "needs the folder"),
        ({"accuracy": "fine"}, "must be one of"),
    ):
        with pytest.raises(SceneError, match=told):
            nw.run(sheet_scene_module, progress=False, **how)


def test_alone_a_scene_that_asks_for_an_error_is_run_at_the_first_level(sheet_scene_module):
    found = nw.run(sheet_scene_module, accuracy=0.05, alone=True, progress=False)
    assert found.summary["warnings"] == ["run alone: the error that the scene asks for is not checked"]
    assert "maximum depth by mesh and wear steps [-]" not in found.summary["error estimates"]
