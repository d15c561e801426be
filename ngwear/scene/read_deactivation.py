"""The table ``[deactivation]`` of a scene file."""

from __future__ import annotations

from typing import Any

from ngwear.errors import SceneError
from ngwear.laws.damage import CRITERIA, Criterion
from ngwear.scene.deactivation import Deactivation, DistortionFilter
from ngwear.scene.toml_values import record

PLACE = "deactivation"


def read_deactivation(table: Any) -> Deactivation:
    """Read layers, distortion filter and damage; a mechanism that is not in the table is not simulated."""
    if not isinstance(table, dict):
        raise SceneError(PLACE, table, "must be a table [deactivation]")
    values = dict(table)
    if "distortion" in values:
        values["distortion"] = record(DistortionFilter, f"{PLACE}.distortion", values["distortion"])
    if "damage" in values:
        values["damage"] = _damage(f"{PLACE}.damage", values["damage"])
    return record(Deactivation, PLACE, values)


def _damage(place: str, table: Any) -> Criterion:
    if not isinstance(table, dict):
        example = '{ criterion = "tensile normal stress", critical = 19.0 }'
        raise SceneError(place, table, f"must be a table, such as {example}")
    values = dict(table)
    name = values.pop("criterion", None)
    if not isinstance(name, str) or name not in CRITERIA:
        raise SceneError(f"{place}.criterion", name, f"must be one of {list(CRITERIA)}")
    return record(CRITERIA[name], place, values)
