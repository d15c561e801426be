"""Every value of a scene file replaced by every kind of nonsense: it is refused with a message, or read."""

import copy
import json
import math

import pytest
from conftest import REMEMBERS, SHEET_OUTLINE, SHEET_SCENE, edited

from ngwear.errors import NgwearError, SceneError
from ngwear.scene.read_scene import read_scene

NONSENSE = [
    True,
    -1,
    0,
    1e308,
    math.nan,
    math.inf,
    -math.inf,
    "",
    "top",
    [],
    [1.0],
    [1.0, 2.0, 3.0],
    ["top"],
    {},
    {"a": 1},
]


def toml(value):
    """Write a value in TOML's inline form."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(toml(v) for v in value) + "]"
    return json.dumps(value) if isinstance(value, str) else repr(value)


def places(value, path=()):
    """All paths to values inside nested tables and lists, the containers included."""
    if path:
        yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield from places(inner, (*path, key))


def replaced(data, path, value):
    data = copy.deepcopy(data)
    inner = data
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    return data


LAWS = (
    (
        "friction = 0.1",
        'friction = { law = "product", factors = [{ law = "lubrication", distance = [0, 9], coefficient = [0.1, 1] }, '
        '{ law = "stribeck", boundary = 1, full = 0.5, speed = 9 }, { law = "pressure", light = 1, pressure = 2 }] }',
    ),
    ("specific_wear_rate = 1.0e-3", "specific_wear_rate = { distance = [0, 9], rate = [0, 1e-3] }"),
)


def scene_data():
    import tomllib

    return tomllib.loads(edited(SHEET_SCENE, (*REMEMBERS, *LAWS)) + "[save]\nstrokes = [2]\nvtk = false\n")


PLACES = list(places(scene_data()))


@pytest.mark.parametrize("path", PLACES, ids=lambda path: ".".join(map(str, path)))
def test_nonsense_is_refused_with_a_message_or_read(tmp_path, path):
    (tmp_path / "sheet.toml").write_text(SHEET_OUTLINE)
    file = tmp_path / "scene.toml"
    escaped = []
    for value in NONSENSE:
        data = replaced(scene_data(), path, value)
        file.write_text("\n".join(f"{key} = {toml(inner)}" for key, inner in data.items()))
        try:
            read_scene(file)
        except SceneError as error:
            if not (error.place and error.remedy):
                escaped.append(f"{value!r}: says too little: {error}")
        except NgwearError as error:
            if not str(error):
                escaped.append(f"{value!r}: says nothing")
        except Exception as error:
            escaped.append(f"{value!r}: {error!r}")
    assert not escaped, f"{path}: " + "; ".join(escaped)


def test_rewritten_scene_is_the_same_scene(tmp_path):
    """The writer above keeps the scene: what is refused is refused for the nonsense alone."""
    (tmp_path / "sheet.toml").write_text(SHEET_OUTLINE)
    file = tmp_path / "scene.toml"
    file.write_text("\n".join(f"{key} = {toml(inner)}" for key, inner in scene_data().items()))
    assert read_scene(file).contacts[0].force == 0.5
