"""Scenes of the kind "pin on plate"."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any

from ngwear.errors import typed
from ngwear.scene.pin_scene import Pin, PinMesh, PinScene
from ngwear.scene.read_laws import read_friction
from ngwear.scene.read_material import read_arms, read_material
from ngwear.scene.toml_values import get, known, record, subtable


def pin_scene(data: dict[str, Any], name: str, folder: Path) -> PinScene:
    """Build the scene from the tables of its file; file names in it are relative to ``folder``.

    Raises
    ------
    SceneError
        For an unknown or missing key, or a value out of range.
    """
    known("", data, {"scene", "material", "pin", "program", "accuracy", "save"})
    material = subtable(data, "material")
    arms = read_arms(material["prony"]) if "prony" in material else None
    pin = subtable(data, "pin")
    own = {f.name: str(f.type) for f in fields(Pin) if f.name not in ("material", "series")}
    known("pin.", pin, set(own))
    sizes = {key: typed(f"pin.{key}", value, own[key]) for key, value in pin.items()}
    if "friction" in sizes:
        sizes["friction"] = read_friction("pin.friction", sizes["friction"], folder)
    program, save = subtable(data, "program"), data.get("save", {})
    known("program.", program, {"speeds"})
    known("save.", save, {"vtk"})
    return PinScene(
        name=name,
        pin=Pin(material=read_material(material), series=arms, **sizes),
        speeds=typed("program.speeds", get(program, "program", "speeds"), "tuple[float"),
        mesh=record(PinMesh, "accuracy", data.get("accuracy", {})),
        vtk=typed("save.vtk", save.get("vtk", False), "bool"),
    )
