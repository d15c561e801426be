"""Checked access to the tables of a TOML file: every error names the place, the value and the remedy."""

from __future__ import annotations

from dataclasses import MISSING, fields
from typing import Any

from ngwear.errors import SceneError, typed


def record(cls: Any, place: str, table: Any) -> Any:
    """Build a dataclass from a table whose keys are the names of its fields."""
    if not isinstance(table, dict):
        raise SceneError(place, table, "must be a table")
    own = fields(cls)
    known(f"{place}.", table, {f.name for f in own})
    for f in own:
        if f.default is MISSING and f.default_factory is MISSING:
            get(table, place, f.name)
    kind = {f.name: str(f.type) for f in own}
    return cls(**{key: typed(f"{place}.{key}", value, kind[key]) for key, value in table.items()})


def coordinate(place: str, value: Any, *, pair: bool) -> Any:
    """Read a number, or a pair of numbers."""
    if pair:
        if not isinstance(value, list) or len(value) != 2:
            raise SceneError(place, value, "must be two numbers [x, y]")
        return tuple(typed(place, v, "float") for v in value)
    return typed(place, value, "float")


def known(prefix: str, table: Any, allowed: set[str]) -> None:
    """SceneError if this is not a table, or has unknown keys."""
    if not isinstance(table, dict):
        raise SceneError(prefix.removesuffix("."), table, "must be a table")
    for key, value in table.items():
        if key not in allowed:
            raise SceneError(f"{prefix}{key}", value, f"unknown key; known here: {sorted(allowed)}")


def get(table: dict[str, Any], place: str, key: str) -> Any:
    """The value of a required key."""
    if key not in table:
        raise SceneError(f"{place}.{key}", None, "is missing")
    return table[key]


def subtable(data: dict[str, Any], key: str) -> dict[str, Any]:
    """A required table."""
    value = get(data, "scene file", key)
    if not isinstance(value, dict):
        raise SceneError(key, value, f"must be a table [{key}]")
    return value


def tables(data: dict[str, Any], key: str) -> list[dict[str, Any]]:
    """A list of tables, empty if the key is missing."""
    value = data.get(key, [])
    if not isinstance(value, list):
        raise SceneError(key, value, f"must be a list of tables [[{key}]]")
    return value
