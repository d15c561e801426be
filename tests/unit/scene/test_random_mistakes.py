"""Scene files with random mistakes: each is a scene or a clear error, never a traceback."""

import copy
import datetime
import math
import random
import tomllib
from pathlib import Path

import pytest
import tomli_w

from ngwear.errors import GeometryError, SceneError
from ngwear.scene.read_scene import read_scene

SHIPPED = sorted((Path(__file__).parents[3] / "geometries").glob("*/scene*.toml"))
WRONG = [
    *(
        "text",
        "",
        "nan",
        0,
        1,
        -1,
        2,
        10**30,
        -(10**18),
        0.0,
        -0.0,
        1e300,
        -1e300,
        1e-300,
        math.nan,
        math.inf,
        -math.inf,
    ),
    *(True, False, [], {}, [1], ["a"], [[]], [{}], [1.0, 2.0, 3.0], {"a": 1}, {"law": "x"}, {"type": 3}, [["lip"]]),
    *(
        datetime.date(2026, 11, 26),
        datetime.datetime(2026, 11, 26, 12, 0),
        datetime.time(12),
        "../..",
        "\x00",
        "ü" * 300,
    ),
]


def places(node, path=()):
    """Paths of all values of a tree of tables and lists."""
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in items:
        yield (*path, key)
        yield from places(value, (*path, key))


def spoiled(data, rng):
    """A copy of a scene's tables with up to three mistakes."""
    data = copy.deepcopy(data)
    for _ in range(rng.randint(1, 3)):
        found = list(places(data))
        if not found:
            break
        *way, last = rng.choice(found)
        node = data
        for key in way:
            node = node[key]
        mistake = rng.choice(("replace", "replace", "remove", "rename", "nest", "list", "double", "number", "new"))
        value = node[last]
        if mistake == "replace":
            node[last] = copy.deepcopy(rng.choice(WRONG))
        elif mistake == "remove":
            del node[last]
        elif mistake == "rename" and isinstance(node, dict):
            node[last[:-1] or "x"] = node.pop(last)
        elif mistake == "nest":
            node[last] = {str(last): value}
        elif mistake == "list":
            node[last] = [value]
        elif mistake == "double" and isinstance(value, list):
            node[last] = value + value
        elif mistake == "number" and isinstance(value, int | float):
            node[last] = value * rng.choice((-1, 0, 1e-9, 1e9, 1e20, math.nan))
        elif mistake == "new" and isinstance(node, dict):
            node[rng.choice(("x", "edges", "law", "file", "compound", "preset", "error", "shift"))] = rng.choice(WRONG)
    return data


def told(path):
    """What reading a file says; anything but a scene or an error of ngwear's own goes through."""
    try:
        return read_scene(path).name
    except (SceneError, GeometryError) as error:
        return str(error)


def tried(folder, count, seed):
    rng = random.Random(seed)
    scenes = [(path.parent, tomllib.loads(path.read_text())) for path in SHIPPED]
    for number in range(count):
        source, data = rng.choice(scenes)
        if "prony" in data["material"] and number % 10:  # fitting a spectrum takes two seconds
            data = copy.deepcopy(data)
            data["material"]["prony"].pop("smoothing", None)
        data = spoiled(data, rng)
        if isinstance(data.get("contour"), dict) and isinstance(data["contour"].get("file"), str):
            data["contour"]["file"] = str(source / data["contour"]["file"])
        path = folder / "scene.toml"
        path.write_text(tomli_w.dumps(data), encoding="utf-8")
        try:
            told(path)
        except Exception as error:
            error.add_note(f"mistake {number} of seed {seed}:\n{path.read_text()}")
            raise


def test_mistakes_are_told_as_such(tmp_path):
    tried(tmp_path, 200, seed=1)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2, 5))
def test_many_mistakes_are_told_as_such(tmp_path, seed):
    tried(tmp_path, 1000, seed)


@pytest.mark.parametrize(
    "text",
    [
        "scene = 1",
        "scene = []",
        "[scene]",
        "[scene]\nkind = 3",
        "contour = 1",
        "[[scene]]\nkind = 'plane strain'",
        "\ufeff",
        "= 3",
    ],
)
def test_files_that_are_hardly_scenes_are_refused(tmp_path, text):
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError):
        read_scene(path)
