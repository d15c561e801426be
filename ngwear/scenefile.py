"""Scenes as TOML files: a serialisation of the classes in ``ngwear.scene``."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

from ngwear.errors import SceneError
from ngwear.geometry.contour_files import read_contour
from ngwear.materials import WLF, Arrhenius, Hyperelastic, MooneyRivlin, NeoHooke, PronySeries
from ngwear.materials.library import relaxation_of
from ngwear.scene import Accuracy, ContactSpec, FluidSpec, Program, Save, Scene, Stroke, SupportSpec, Wear
from ngwear.surfaces import Cylinder, Plane, RigidSurface

KINDS = {"axisymmetric": True, "plane strain": False}
_MATERIALS: dict[str, Callable[..., Hyperelastic]] = {
    "neo-hooke": NeoHooke,
    "mooney-rivlin": MooneyRivlin,
}
_SHIFTS = {"wlf": WLF, "arrhenius": Arrhenius}
_REFERENCES = ("long-term", "instantaneous", "absolute")


def _rename(function: Callable[..., Any], **names: str) -> Callable[..., Any]:
    def build(**values: Any) -> Any:
        return function(**{names.get(key, key): value for key, value in values.items()})

    return build


_SURFACES: dict[str, tuple[Callable[..., RigidSurface], set[str]]] = {
    "rod": (Plane.rod, {"diameter"}),
    "bore": (Plane.bore, {"diameter"}),
    "plane": (_rename(Plane, normal="normal_vector"), {"point", "normal"}),
    "cylinder": (Cylinder, {"centre", "radius", "push"}),
}
_SURFACE_OPTIONAL = {"push"}
_PAIRS = {"point", "normal", "centre", "push"}


def read_scene(path: Path | str) -> Scene:
    """Read a scene; relative file names in it start from the scene's folder.

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
    allowed = {"scene", "contour", "material", "contact", "fluid", "support", "program", "accuracy", "wear", "save"}
    _known("", data, allowed)
    head = _table(data, "scene")
    _known("scene.", head, {"name", "kind"})
    kind = _get(head, "scene", "kind")
    if not isinstance(kind, str) or kind not in KINDS:
        raise SceneError("scene.kind", kind, f"must be one of {list(KINDS)}")
    outline = _table(data, "contour")
    _known("contour.", outline, {"file"})
    return Scene(
        name=str(head.get("name", path.stem)),
        axisymmetric=KINDS[kind],
        contour=read_contour(path.parent / str(_get(outline, "contour", "file"))),
        material=_material(_table(data, "material")),
        prony=_prony(data["material"]["prony"]) if "prony" in data["material"] else None,
        contacts=tuple(_contact(i, table) for i, table in enumerate(_list(data, "contact"))),
        fluid=_dataclass(FluidSpec, "fluid", data["fluid"]) if "fluid" in data else None,
        supports=tuple(_dataclass(SupportSpec, f"support[{i}]", t) for i, t in enumerate(_list(data, "support"))),
        program=_program(_table(data, "program")),
        accuracy=_dataclass(Accuracy, "accuracy", data.get("accuracy", {})),
        wear=_dataclass(Wear, "wear", data.get("wear", {})),
        save=_dataclass(Save, "save", data.get("save", {})),
    )


def _material(table: dict[str, Any]) -> Hyperelastic:
    model = _get(table, "material", "model")
    if not isinstance(model, str) or model not in _MATERIALS:
        raise SceneError("material.model", model, f"must be one of {list(_MATERIALS)}")
    values = {key: value for key, value in table.items() if key not in ("model", "source", "prony")}
    return _dataclass(_MATERIALS[model], "material", values)


def _prony(table: dict[str, Any]) -> PronySeries:
    """Arms at the scene's temperature: a compound's from the library, or moduli and times."""
    place = "material.prony"
    if not isinstance(table, dict):
        raise SceneError(place, table, "must be a table [material.prony]")
    table = {key: value for key, value in table.items() if key != "source"}
    shift = None
    if "compound" in table:
        _known(f"{place}.", table, {"compound", "temperature", "shift"})
        series, shift = relaxation_of(_typed(f"{place}.compound", table["compound"], "str"))
    else:
        series = _listed_arms(table, place)
    if "shift" in table:
        shift = _shift(table["shift"], f"{place}.shift")
        _get(table, place, "temperature")
    if "temperature" not in table:
        return series
    temperature = _typed(f"{place}.temperature", table["temperature"], "float")
    if shift is None:
        raise SceneError(f"{place}.temperature", temperature, "needs a [material.prony.shift] table")
    try:
        return series.shifted(shift.factor(temperature))
    except SceneError as error:
        raise SceneError(f"{place}.temperature", temperature, error.remedy) from None


def _listed_arms(table: dict[str, Any], place: str) -> PronySeries:
    _known(f"{place}.", table, {"compound", "moduli", "times", "reference", "long_term", "temperature", "shift"})
    moduli, times = (_numbers(f"{place}.{key}", _get(table, place, key)) for key in ("moduli", "times"))
    reference = _get(table, place, "reference")
    if reference not in _REFERENCES:
        raise SceneError(
            f"{place}.reference", reference, f"must be one of {list(_REFERENCES)}: what the moduli are relative to"
        )
    if reference == "absolute":
        long_term = _typed(f"{place}.long_term", _get(table, place, "long_term"), "float")
        return PronySeries.from_moduli(moduli, times, long_term=long_term)
    if "long_term" in table:
        raise SceneError(f"{place}.long_term", table["long_term"], "goes with reference = 'absolute' only")
    return PronySeries(moduli, times) if reference == "long-term" else PronySeries.from_shares(moduli, times)


def _numbers(place: str, values: Any) -> tuple[float, ...]:
    if not isinstance(values, list) or not values:
        raise SceneError(place, values, "must be a list of numbers, one for each arm")
    numbers = tuple(_typed(f"{place}[{i}]", value, "float") for i, value in enumerate(values))
    for i, number in enumerate(numbers):
        if not number > 0:
            raise SceneError(f"{place}[{i}]", number, "must be greater than 0")
    return numbers


def _shift(table: Any, place: str) -> WLF | Arrhenius:
    if not isinstance(table, dict):
        raise SceneError(place, table, "must be a table [material.prony.shift]")
    law = _get(table, place, "law")
    if not isinstance(law, str) or law not in _SHIFTS:
        raise SceneError(f"{place}.law", law, f"must be one of {list(_SHIFTS)}")
    return _dataclass(_SHIFTS[law], place, {key: value for key, value in table.items() if key != "law"})


def _contact(number: int, table: dict[str, Any]) -> ContactSpec:
    place = f"contact[{number}]"
    if not isinstance(table, dict):
        raise SceneError(place, table, "must be a table")
    values = dict(table)
    surface = _get(values, place, "surface")
    if not isinstance(surface, dict):
        raise SceneError(f"{place}.surface", surface, 'must be a table, such as { type = "rod", diameter = 22.2 }')
    surface = dict(surface)
    values["surface"] = _surface(f"{place}.surface", surface)
    return _dataclass(ContactSpec, place, values)


def _surface(place: str, table: dict[str, Any]) -> RigidSurface:
    kind = table.pop("type", None)
    if not isinstance(kind, str) or kind not in _SURFACES:
        raise SceneError(f"{place}.type", kind, f"must be one of {list(_SURFACES)}")
    build, keys = _SURFACES[kind]
    _known(f"{place}.", table, keys)
    for key in sorted(keys - _SURFACE_OPTIONAL - set(table)):
        _get(table, place, key)
    return build(**{key: _checked(f"{place}.{key}", value, pair=key in _PAIRS) for key, value in table.items()})


def _program(table: dict[str, Any]) -> Program:
    _known("program.", table, {"strokes", "stroke", "rest"})
    strokes = _get(table, "program", "strokes")
    cycle = tuple(_dataclass(Stroke, f"program.stroke[{i}]", t) for i, t in enumerate(_list(table, "stroke")))
    if isinstance(strokes, bool) or not isinstance(strokes, int):
        raise SceneError("program.strokes", strokes, "must be a whole number")
    rest = {"rest": _typed("program.rest", table["rest"], "float")} if "rest" in table else {}
    return Program(strokes=strokes, cycle=cycle, **rest)


def _dataclass(cls: Any, place: str, table: Any) -> Any:
    if not isinstance(table, dict):
        raise SceneError(place, table, "must be a table")
    own = fields(cls)
    _known(f"{place}.", table, {f.name for f in own})
    for f in own:
        if f.default is MISSING and f.default_factory is MISSING:
            _get(table, place, f.name)
    kind = {f.name: str(f.type) for f in own}
    return cls(**{key: _typed(f"{place}.{key}", value, kind[key]) for key, value in table.items()})


def _typed(place: str, value: Any, kind: str) -> Any:
    """Check a TOML value against the annotation of the field that takes it."""
    if kind.startswith("tuple[str"):
        if not isinstance(value, list) or not all(isinstance(v, str) for v in value):
            raise SceneError(place, value, 'must be a list of names, such as ["lip"]')
        return tuple(value)
    if kind.startswith("tuple[int"):
        if not isinstance(value, list) or not all(isinstance(v, int) and not isinstance(v, bool) for v in value):
            raise SceneError(place, value, "must be a list of whole numbers, such as [50, 100]")
        return tuple(value)
    if kind == "bool" and not isinstance(value, bool):
        raise SceneError(place, value, "must be true or false")
    if kind == "str" and not isinstance(value, str):
        raise SceneError(place, value, "must be a text in quotes")
    if kind == "int" and (isinstance(value, bool) or not isinstance(value, int)):
        raise SceneError(place, value, "must be a whole number")
    if kind.startswith("float"):
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise SceneError(place, value, "must be a number")
        if not abs(value) < 1e15:
            raise SceneError(place, value, "must be a finite number (below 1e15)")
        return float(value)
    return value


def _checked(place: str, value: Any, *, pair: bool) -> Any:
    if pair:
        if not isinstance(value, list) or len(value) != 2:
            raise SceneError(place, value, "must be two numbers [x, y]")
        return tuple(_typed(place, v, "float") for v in value)
    return _typed(place, value, "float")


def _known(prefix: str, table: dict[str, Any], allowed: set[str]) -> None:
    for key, value in table.items():
        if key not in allowed:
            raise SceneError(f"{prefix}{key}", value, f"unknown key; known here: {sorted(allowed)}")


def _get(table: dict[str, Any], place: str, key: str) -> Any:
    if key not in table:
        raise SceneError(f"{place}.{key}", None, "is missing")
    return table[key]


def _table(data: dict[str, Any], key: str) -> dict[str, Any]:
    value = _get(data, "scene file", key)
    if not isinstance(value, dict):
        raise SceneError(key, value, f"must be a table [{key}]")
    return value


def _list(data: dict[str, Any], key: str) -> list[dict[str, Any]]:
    value = data.get(key, [])
    if not isinstance(value, list):
        raise SceneError(key, value, f"must be a list of tables [[{key}]]")
    return value
