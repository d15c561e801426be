"""Read scenes from TOML files: their tables hold the fields of the classes in ``ngwear.scene``."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from ngwear.errors import SceneError, typed
from ngwear.geometry.outline import Outline
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Fluid, Support
from ngwear.scene.contact import Contact
from ngwear.scene.holding import free_directions
from ngwear.scene.options import Save, Wear
from ngwear.scene.part import Part
from ngwear.scene.pin_scene import KIND as PIN
from ngwear.scene.pin_scene import PinScene
from ngwear.scene.program import Program, Stroke
from ngwear.scene.read_deactivation import read_deactivation
from ngwear.scene.read_laws import read_friction, read_wear_law, read_wear_rate
from ngwear.scene.read_material import read_arms, read_material
from ngwear.scene.read_pin import pin_scene
from ngwear.scene.scene import Scene
from ngwear.scene.toml_values import coordinate, get, known, record, subtable, tables
from ngwear.surfaces import Corner, Cylinder, Plane, RigidSurface, bore, rod

TABLES = {
    *("scene", "contour", "material", "contact", "fluid", "support"),
    *("program", "accuracy", "wear", "deactivation", "save"),
}
KINDS = {"axisymmetric": True, "plane strain": False}


def _rename(function: Callable[..., Any], **names: str) -> Callable[..., Any]:
    def build(**values: Any) -> Any:
        return function(**{names.get(key, key): value for key, value in values.items()})

    return build


_SURFACES: dict[str, tuple[Callable[..., RigidSurface], set[str]]] = {
    "rod": (rod, {"diameter"}),
    "bore": (bore, {"diameter"}),
    "plane": (_rename(Plane, normal="normal_vector"), {"point", "normal"}),
    "corner": (_rename(Corner, normal="normal_vector"), {"point", "normal", "side", "radius"}),
    "cylinder": (Cylinder, {"centre", "radius", "push"}),
}
_SURFACE_OPTIONAL = {"push"}
_PAIRS = {"point", "normal", "side", "centre", "push"}


def read_scene(path: Path | str) -> Scene | PinScene:
    """Read a scene of any kind; file names in it are relative to the folder of the scene file.

    A part with room to move takes the preset ``engineering`` if the file has no table ``accuracy``.

    Raises
    ------
    SceneError
        For an unknown or missing key, a value out of range, or a file that is not TOML.
    GeometryError
        If the outline is not usable.
    """
    path = Path(path)
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise SceneError("scene", str(path), f"cannot be read: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SceneError("scene", str(path), f"is not valid TOML: {error}") from None
    head = subtable(data, "scene")
    known("scene.", head, {"name", "kind"})
    kind, name = get(head, "scene", "kind"), str(head.get("name", path.stem))
    if not isinstance(kind, str) or kind not in (*KINDS, PIN):
        raise SceneError("scene.kind", kind, f"must be one of {[*KINDS, PIN]}")
    return pin_scene(data, name, path.parent) if kind == PIN else _wear_scene(data, name, path.parent)


def _wear_scene(data: dict[str, Any], name: str, folder: Path) -> Scene:
    known("", data, TABLES)
    scene = Scene(
        name=name,
        axisymmetric=KINDS[data["scene"]["kind"]],
        part=_part(data, folder),
        contacts=tuple(_contact(i, table, folder) for i, table in enumerate(tables(data, "contact"))),
        fluid=record(Fluid, "fluid", data["fluid"]) if "fluid" in data else None,
        supports=tuple(record(Support, f"support[{i}]", t) for i, t in enumerate(tables(data, "support"))),
        program=_program(subtable(data, "program")),
        accuracy=_accuracy(data.get("accuracy", {})),
        wear=record(Wear, "wear", data.get("wear", {})),
        deactivation=read_deactivation(data["deactivation"]) if "deactivation" in data else None,
        save=record(Save, "save", data.get("save", {})),
    )
    if "accuracy" not in data and free_directions(scene):
        # Elements of 0.01 mm, the default, are too many all around a ring that moves from wall to wall.
        return replace(scene, accuracy=Accuracy.preset("engineering"))
    return scene


def _part(data: dict[str, Any], folder: Path) -> Part:
    outline, material = subtable(data, "contour"), subtable(data, "material")
    known("contour.", outline, {"file"})
    return Part(
        Outline.read(folder / typed("contour.file", get(outline, "contour", "file"), "str")),
        material=read_material(material),
        prony=read_arms(material["prony"]) if "prony" in material else None,
    )


def _accuracy(table: Any) -> Accuracy:
    """Read the fields of ``Accuracy``, or the name of a preset."""
    if not isinstance(table, dict) or "preset" not in table:
        return record(Accuracy, "accuracy", table)
    known("accuracy.", table, {"preset", *Accuracy.__dataclass_fields__})
    for key in table.keys() - {"preset"}:
        raise SceneError(
            f"accuracy.{key}", table[key], f"is set by the preset {table['preset']!r}: give only one of them"
        )
    return Accuracy.preset(typed("accuracy.preset", table["preset"], "str"))


def _contact(number: int, table: dict[str, Any], folder: Path) -> Contact:
    place = f"contact[{number}]"
    if not isinstance(table, dict):
        raise SceneError(place, table, "must be a table")
    values = dict(table)
    surface = get(values, place, "surface")
    if not isinstance(surface, dict):
        raise SceneError(f"{place}.surface", surface, 'must be a table, such as { type = "rod", diameter = 22.2 }')
    surface = dict(surface)
    values["surface"] = _surface(f"{place}.surface", surface)
    laws = (("friction", read_friction), ("specific_wear_rate", read_wear_rate), ("wear_law", read_wear_law))
    for key, read in laws:
        if key in values:
            values[key] = read(f"{place}.{key}", values[key], folder)
    return record(Contact, place, values)


def _surface(place: str, table: dict[str, Any]) -> RigidSurface:
    kind = table.pop("type", None)
    if not isinstance(kind, str) or kind not in _SURFACES:
        raise SceneError(f"{place}.type", kind, f"must be one of {list(_SURFACES)}")
    build, keys = _SURFACES[kind]
    known(f"{place}.", table, keys)
    for key in sorted(keys - _SURFACE_OPTIONAL - set(table)):
        get(table, place, key)
    return build(**{key: coordinate(f"{place}.{key}", value, pair=key in _PAIRS) for key, value in table.items()})


def _program(table: dict[str, Any]) -> Program:
    known("program.", table, {"strokes", "stroke", "rest"})
    strokes = get(table, "program", "strokes")
    cycle = tuple(record(Stroke, f"program.stroke[{i}]", t) for i, t in enumerate(tables(table, "stroke")))
    if isinstance(strokes, bool) or not isinstance(strokes, int):
        raise SceneError("program.strokes", strokes, "must be a whole number")
    rest = {"rest": typed("program.rest", table["rest"], "float")} if "rest" in table else {}
    return Program(strokes=strokes, cycle=cycle, **rest)
