"""Rigid surfaces as text in a result file: write and read."""

from __future__ import annotations

import json
from dataclasses import fields
from typing import Any

from ngwear.files.hdf5 import name_of
from ngwear.surfaces import Corner, Cylinder, Plane, RigidSurface

KNOWN: dict[str, type[RigidSurface]] = {"plane": Plane, "corner": Corner, "cylinder": Cylinder}


def surface_text(surface: RigidSurface) -> str:
    """JSON text of a surface: its kind and numbers; for a user-defined kind, its class name only."""
    kind = next((name for name, known in KNOWN.items() if type(surface) is known), None)
    if kind is None:
        return json.dumps({"type": type(surface).__name__})
    return json.dumps({"type": kind} | {f.name: getattr(surface, f.name) for f in fields(surface)})


def surface_of(text: str) -> RigidSurface | None:
    """The surface from its JSON text; None if its kind is not known."""
    numbers = json.loads(text)
    kind = KNOWN.get(numbers.pop("type"))
    if kind is None:
        return None
    return kind(**{name: tuple(value) if isinstance(value, list) else value for name, value in numbers.items()})


def surfaces_of(h5: Any) -> dict[str, RigidSurface]:
    """Surface of each contact in an open result file, in the order of the scene; without user-defined kinds."""
    groups = sorted(h5.get("contacts", {}).values(), key=lambda group: group.attrs.get("number", 0))
    found = {name_of(group): surface_of(group.attrs.get("surface", '{"type": ""}')) for group in groups}
    return {name: surface for name, surface in found.items() if surface is not None}
