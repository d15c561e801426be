"""The table ``[deactivation]`` of a scene file."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from ngwear.errors import SceneError
from ngwear.input.tables import get, known, record, typed
from ngwear.wear.damage import CRITERIA, Criterion, criterion
from ngwear.wear.deactivate import Deactivation, DistortionFilter

PLACE = "deactivation"


def read_deactivation(table: Any) -> Deactivation:
    """Layers, filter and damage; what the table leaves out does not happen."""
    if not isinstance(table, dict):
        raise SceneError(PLACE, table, "must be a table [deactivation]")
    known(f"{PLACE}.", table, {"depth", "distortion", "damage", "reach"})
    parts: dict[str, Any] = {"depth": typed(f"{PLACE}.depth", get(table, PLACE, "depth"), "float")}
    if "reach" in table:
        parts["reach"] = typed(f"{PLACE}.reach", table["reach"], "float")
    if "distortion" in table:
        parts["distortion"] = record(DistortionFilter, f"{PLACE}.distortion", table["distortion"])
    if "damage" in table:
        parts["damage"] = _damage(table["damage"])
    return Deactivation(**parts)


def _damage(table: Any) -> Criterion:
    place = f"{PLACE}.damage"
    if not isinstance(table, dict):
        example = '{ criterion = "tensile normal stress", critical = 19.0 }'
        raise SceneError(place, table, f"must be a table, such as {example}")
    values = dict(table)
    name = values.pop("criterion", None)
    kind = CRITERIA.get(name) if isinstance(name, str) else None
    if kind is None:
        raise SceneError(f"{place}.criterion", name, f"must be one of {list(CRITERIA)}")
    wanted = [f.name for f in fields(kind)]
    known(f"{place}.", values, set(wanted))
    return criterion(name, **{key: typed(f"{place}.{key}", get(values, place, key), "float") for key in wanted})
