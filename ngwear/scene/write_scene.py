"""Write scenes to TOML files that ``read_scene`` reads."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

import tomli_w

from ngwear.errors import SceneError
from ngwear.laws import Constant, Lubrication, WearRate
from ngwear.materials import PronySeries
from ngwear.scene.read_laws import FRICTION_LAWS, WEAR_LAWS
from ngwear.scene.read_material import MATERIALS
from ngwear.surfaces import Corner, Cylinder, Plane

Table = dict[str, Any]


def write_wear_scene(scene: Any, path: Path) -> None:
    """Write a scene to NAME.toml, and its outline to ``NAME.contour.toml`` in the same folder.

    Raises
    ------
    SceneError
        If a scene file cannot represent something, such as a user-defined law or material, or cannot be written.
    GeometryError
        If the outline's file cannot be written.
    """
    part, program = scene.part, scene.program
    outline = path.with_name(f"{path.stem}.contour.toml")
    whole = program.divided(1)
    data: Table = {
        "scene": {"name": scene.name, "kind": "axisymmetric" if scene.axisymmetric else "plane strain"},
        "contour": {"file": outline.name},
        "material": _material(part.material, part.prony),
        "contact": [_contact(contact, axisymmetric=scene.axisymmetric) for contact in scene.contacts],
        "fluid": None if scene.fluid is None else _given(scene.fluid),
        "support": [_given(support) for support in scene.supports],
        "program": {"strokes": whole.strokes, "stroke": [_given(stroke) for stroke in whole.cycle]},
        "accuracy": _given(scene.accuracy),
        "wear": _given(scene.wear),
        "deactivation": _deactivation(scene.deactivation),
        "save": _given(scene.save),
    }
    if program.rest < float("inf"):
        data["program"]["rest"] = program.rest
    text = _text(data)  # before any file is written: it may raise SceneError
    part.outline.write(outline)
    _write(path, text)


def write_pin_scene(scene: Any, path: Path) -> None:
    """Write a ``PinScene``.

    Raises
    ------
    SceneError
        If a scene file cannot represent something, or cannot be written.
    """
    pin = _given(scene.pin, without=("material", "series", "friction"))
    if scene.pin.friction_law is not None:
        pin["friction"] = _friction("pin.friction", scene.pin.friction)
    data: Table = {
        "scene": {"name": scene.name, "kind": "pin on plate"},
        "material": _material(scene.pin.material, scene.pin.series),
        "pin": pin,
        "program": {"speeds": list(scene.speeds)},
        "accuracy": _given(scene.mesh),
        "save": {"vtk": True} if scene.vtk else {},
    }
    _write(path, _text(data))


def _text(data: Table) -> str:
    return tomli_w.dumps({key: value for key, value in data.items() if value})


def _write(path: Path, text: str) -> None:
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise SceneError("scene", str(path), f"cannot be written: {error.strerror}") from None


def _given(record: Any, without: Sequence[str] = ()) -> Table:
    """The fields of a dataclass that differ from their default."""
    values = {f.name: getattr(record, f.name) for f in fields(record) if f.name not in without}
    default = {f.name: f.default for f in fields(record) if f.default is not MISSING}
    given = {name: value for name, value in values.items() if name not in default or value != default[name]}
    for name, value in given.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise SceneError(name, value, "a scene file holds only finite numbers: run the scene from Python")
    return {name: list(value) if isinstance(value, tuple) else value for name, value in given.items()}


def _kind(place: str, value: Any, known: Mapping[str, Any]) -> str:
    """Name of an object's class in a scene file."""
    for name, kind in known.items():
        if type(value) is kind:
            return name
    names = ", ".join(kind.__name__ for kind in known.values())
    raise SceneError(place, value, f"a scene file can only hold {names}: run the scene from Python")


def _material(material: Any, prony: PronySeries | None) -> Table:
    table = {"model": _kind("material", material, MATERIALS), **_given(material)}
    if prony is not None:
        table["prony"] = {"reference": "long-term", "moduli": list(prony.ratios), "times": list(prony.times)}
    return table


def _contact(contact: Any, *, axisymmetric: bool) -> Table:
    place = f"contact '{contact.name}'"
    table = _given(contact, without=("surface", "friction", "specific_wear_rate", "wear_law"))
    table["surface"] = _surface(f"{place}.surface", contact.surface, axisymmetric=axisymmetric)
    if contact.friction_law is not None:
        table["friction"] = _friction(f"{place}.friction", contact.friction)
    rate = contact.specific_wear_rate
    if contact.wears:
        table["specific_wear_rate"] = _given(rate) if isinstance(rate, WearRate) else rate
    if contact.wear_law is not None:
        table["wear_law"] = _law(f"{place}.wear_law", contact.wear_law, WEAR_LAWS)
    return table


def _friction(place: str, friction: Any) -> Any:
    if isinstance(friction, int | float):
        return friction
    if type(friction) is Constant:
        return friction.value
    table = _law(place, friction, FRICTION_LAWS)
    if "factors" in table:
        table["factors"] = [_friction_factor(f"{place}.factors[{i}]", law) for i, law in enumerate(friction.factors)]
    return table


def _friction_factor(place: str, law: Any) -> Table:
    if type(law) is Constant:  # a factor must be a table: here a constant over the distance
        law = Lubrication(distance=(0.0,), coefficient=(law.value,))
    factor: Table = _friction(place, law)
    return factor


def _law(place: str, law: Any, known: Mapping[str, Any]) -> Table:
    return {"law": _kind(place, law, known), **_given(law)}


def _surface(place: str, surface: Any, *, axisymmetric: bool) -> Table:
    if type(surface) is Plane:
        (x, y), (nx, ny) = surface.point, surface.normal_vector
        if axisymmetric and x == 0 and nx == 0:
            return {"type": "rod" if ny > 0 else "bore", "diameter": 2 * y}
        return {"type": "plane", "point": [x, y], "normal": [nx, ny]}
    if type(surface) is Corner:
        table = {"type": "corner", **_given(surface)}
        return {"normal" if key == "normal_vector" else key: value for key, value in table.items()}
    if type(surface) is Cylinder:
        return {"type": "cylinder", **_given(surface)}
    remedy = "a scene file can only hold Plane, Corner and Cylinder: run the scene from Python"
    raise SceneError(place, surface, remedy)


def _deactivation(deactivation: Any) -> Table | None:
    if deactivation is None:
        return None
    table = _given(deactivation, without=("distortion", "damage"))
    if deactivation.distortion is not None:
        table["distortion"] = {"corner_cosine": deactivation.distortion.corner_cosine}
    if deactivation.damage is not None:
        table["damage"] = {"criterion": deactivation.damage.name, **_given(deactivation.damage)}
    return table
