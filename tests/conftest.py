"""Options, markers by folder, and a small scene that mounts and wears in a third of a second."""

import os
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ngwear.geometry.outline import Outline
from ngwear.parallel.workers import ONE_THREAD
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.read_scene import read_scene

TESTS = Path(__file__).parent
FOLDERS = ("unit", "verification", "stability", "regression", "benchmarks")
DRAW = Figure.draw
SEAL = TESTS.parent / "geometries" / "rod_seal" / "scene.toml"

SHEET_OUTLINE = """
title = "sheet, 4 x 2 mm"
[[edge]]
name = "bottom"
points = [[0, 0], [0.5, 0], [1, 0], [1.5, 0], [2, 0], [2.5, 0], [3, 0], [3.5, 0]]
[[edge]]
name = "right"
points = [[4, 0], [4, 0.5], [4, 1], [4, 1.5]]
[[edge]]
name = "top"
points = [[4, 2], [3.5, 2], [3, 2], [2.5, 2], [2, 2], [1.5, 2], [1, 2], [0.5, 2]]
[[edge]]
name = "left"
points = [[0, 2], [0, 1.5], [0, 1], [0, 0.5]]
"""

SHEET_SCENE = """
[scene]
name = "sheet"
kind = "plane strain"

[contour]
file = "sheet.toml"

[material]
model = "neo-hooke"
shear = 1.0
bulk_modulus = 100.0

[[contact]]
name = "roller"
edges = ["top"]
surface = { type = "cylinder", centre = [2.0, 3.99], radius = 2.0, push = [0.0, -1.0] }
force = 0.5
specific_wear_rate = 1.0e-3
friction = 0.1

[[support]]
edges = ["bottom"]

[program]
strokes = 4

[[program.stroke]]
name = "stroke"
travel = 10.0

[accuracy]
patch = 0.2
coarse = 0.5
mounting = 0.2

[wear]
step = "each"
"""

ARMS = """

[material.prony]
moduli = [0.5, 0.4, 0.3]
times = [0.1, 1.0, 10.0]
reference = "long-term"
temperature = 303.15
shift = { law = "wlf", c1 = 17.44, c2 = 51.6, reference = 296.15 }
"""
FINE = (("patch = 0.2", "patch = 0.1"), ("mounting = 0.2", "mounting = 0.15"))
REMEMBERS = (("bulk_modulus = 100.0", "bulk_modulus = 100.0" + ARMS), ("travel = 10.0", "travel = 10.0\nspeed = 20.0"))


def pytest_addoption(parser):
    parser.addoption("--slow", action="store_true", help="also run tests/stability and tests marked slow")


def pytest_configure(config):
    if not config.getoption("--slow"):  # one thread for each of the processes that share the cores
        for name in ONE_THREAD:
            os.environ.setdefault(name, "1")
    config.addinivalue_line("markers", "slow: takes more than a few seconds; needs --slow")
    config.addinivalue_line("markers", "rendered: looks at its pictures")
    for folder in FOLDERS:
        config.addinivalue_line("markers", f"{folder}: everything under tests/{folder}")


def pytest_collection_modifyitems(config, items):
    for item in items:
        try:
            folder = item.path.relative_to(TESTS).parts[0]
        except ValueError:
            continue
        if folder in FOLDERS:
            item.add_marker(folder)
        slow = folder == "stability" or item.get_closest_marker("slow") is not None
        if slow and not config.getoption("--slow"):
            item.add_marker(pytest.mark.skip(reason="slow: give --slow"))


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    """Without ``--slow`` figures are built; only those of ``tests/unit/plots`` and of marked tests are rendered."""
    if item.config.getoption("--slow"):
        return
    ConstrainedLayoutEngine.execute = _nothing
    rendered = item.path.parent.name == "plots" or item.get_closest_marker("rendered")
    Figure.draw = DRAW if rendered else _nothing


def _nothing(*_):
    pass


def edited(text: str, changes) -> str:
    """Replace pieces of a text that must be there."""
    for old, new in changes:
        assert text.count(old) >= 1, f"{old!r} is not in the text"
        text = text.replace(old, new, 1)
    return text


def _write_sheet(folder: Path, *changes: tuple[str, str], outline: str = SHEET_OUTLINE) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "sheet.toml").write_text(outline, encoding="utf-8")
    file = folder / "scene.toml"
    file.write_text(edited(SHEET_SCENE, changes), encoding="utf-8")
    return file


@pytest.fixture(scope="session")
def write_sheet():
    """``write_sheet(folder, (old, new), ...)`` writes the small scene with pieces of its text replaced."""
    return _write_sheet


@pytest.fixture
def sheet_file(tmp_path):
    """The small scene as a file."""
    return _write_sheet(tmp_path)


@pytest.fixture
def sheet(sheet_file):
    """The small scene."""
    return read_scene(sheet_file)


@pytest.fixture
def fine_sheet(tmp_path):
    """The small scene with about twice the elements."""
    return read_scene(_write_sheet(tmp_path / "fine", *FINE))


@pytest.fixture(scope="session")
def ring():
    """The shipped O-ring, a part with room to move, for one cycle with few elements."""
    scene = read_scene("geometries/o_ring/scene.toml")
    return replace(scene, accuracy=Accuracy.preset("draft"), program=replace(scene.program, strokes=2))


@pytest.fixture(scope="session")
def seal_text():
    """The shipped seal's scene file, its outline given by an absolute path."""
    return SEAL.read_text(encoding="utf-8").replace('"contour.toml"', f"'{SEAL.with_name('contour.toml')}'")


@pytest.fixture(scope="session")
def seal():
    """The shipped seal's scene."""
    return read_scene(SEAL)


@pytest.fixture(scope="session")
def _finished_once(tmp_path_factory):
    from ngwear.loop.run import run

    folder = tmp_path_factory.mktemp("sheet")
    run(read_scene(_write_sheet(folder)), out=folder / "out")
    return folder / "out"


@pytest.fixture
def finished(_finished_once, tmp_path):
    """A copy of the results of the small scene, with figures."""
    return Path(shutil.copytree(_finished_once, tmp_path / "finished"))


@pytest.fixture
def from_checkpoint(tmp_path):
    """``from_checkpoint(state, scene)``: the state as a file gives it back."""
    from ngwear.loop.checkpoint import load, save
    from ngwear.results.recorder import Folder, Recorder

    def through_a_file(state, scene):
        folder = Folder(tmp_path / "checkpoint", scene, resume=True)
        save(folder, state, Recorder(scene))
        return load(folder, scene)[0]

    return through_a_file


def _circle(n: int, radius: float = 1.0, centre=(0.0, 0.0)) -> Outline:
    angle = 2 * np.pi * np.arange(n) / n
    points = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1) + centre
    return Outline(points, ("rim",) * n, np.zeros(n, dtype=bool))


@pytest.fixture(scope="session")
def circle():
    """``circle(n, radius)``: an outline without corners."""
    return _circle


def _rectangle(width: float, height: float, nx: int = 1, ny: int = 1) -> Outline:
    ends = [(0, 0, "bottom", nx), (width, 0, "right", ny), (width, height, "top", nx), (0, height, "left", ny)]
    points, names, corners = [], [], []
    for k, (x, y, name, n) in enumerate(ends):
        x2, y2 = ends[(k + 1) % 4][:2]
        points += [(x + (x2 - x) * i / n, y + (y2 - y) * i / n) for i in range(n)]
        names += [name] * n
        corners += [True] + [False] * (n - 1)
    return Outline(np.array(points), tuple(names), np.array(corners))


@pytest.fixture(scope="session")
def rectangle():
    """``rectangle(width, height, nx, ny)`` with the edges bottom, right, top, left from the origin."""
    return _rectangle
