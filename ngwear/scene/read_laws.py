"""The values ``friction``, ``specific_wear_rate`` and ``wear_law`` of a contact: numbers or tables."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ngwear.errors import SceneError, typed
from ngwear.laws import (
    ByPressure,
    FrictionalEnergyWear,
    FrictionLaw,
    Lubrication,
    PowerWear,
    Product,
    SaturatingWear,
    Stribeck,
    ThresholdWear,
    WearLaw,
    WearRate,
)
from ngwear.scene.toml_values import get, known, record

FRICTION_LAWS = {"lubrication": Lubrication, "pressure": ByPressure, "stribeck": Stribeck, "product": Product}
WEAR_LAWS = {
    "power": PowerWear,
    "threshold": ThresholdWear,
    "saturating": SaturatingWear,
    "frictional energy": FrictionalEnergyWear,
}


def read_friction(place: str, value: Any, folder: Path) -> FrictionLaw | float:
    """Read a number, or a table with ``law`` and the parameters of that law; file names are relative to ``folder``.

    ``law = "lubrication"`` needs the rows ``distance`` and ``coefficient``, or a ``file`` with them, or ``fitted``, a
    file of measurements to which the four phases are fitted. ``law = "product"`` needs ``factors``, a list of tables.

    Raises
    ------
    SceneError
        For an unknown law or key, or a value out of range.
    """
    return _friction_law(place, value, folder) if isinstance(value, dict) else typed(place, value, "float")


def _friction_law(place: str, table: dict[str, Any], folder: Path) -> FrictionLaw:
    kind, values = _chosen(place, table, FRICTION_LAWS)
    if kind == "product":
        return _product(place, values, folder)
    if kind == "lubrication" and "fitted" in values:
        from ngwear.laws.fit import fit_lubrication  # SciPy's optimizers are slow to load

        return _of_file(place, values, "fitted", folder, lambda path: fit_lubrication(path).law)
    return _table(place, values, folder, FRICTION_LAWS[kind])


def read_wear_rate(place: str, value: Any, folder: Path) -> WearRate | float:
    """Read a number, or a table with the rows ``distance`` and ``rate`` or a ``file`` with them.

    Raises
    ------
    SceneError
        For an unknown key or a value out of range.
    """
    if not isinstance(value, dict):
        return typed(place, value, "float")
    return _table(place, {key: inner for key, inner in value.items() if key != "source"}, folder, WearRate)


def read_wear_law(place: str, value: Any, folder: Path) -> WearLaw:
    """Read a table with ``law`` and the parameters of that law.

    Raises
    ------
    SceneError
        For an unknown law or key, or a value out of range.
    """
    if not isinstance(value, dict):
        raise SceneError(place, value, 'must be a table, such as { law = "power", exponent = 2.0 }')
    kind, values = _chosen(place, value, WEAR_LAWS)
    return _table(place, values, folder, WEAR_LAWS[kind])


def _chosen(place: str, table: dict[str, Any], laws: dict[str, Any]) -> tuple[str, dict[str, Any]]:
    """Name of the law in a table, and its parameters."""
    kind = get(table, place, "law")
    if not isinstance(kind, str) or kind not in laws:
        raise SceneError(f"{place}.law", kind, f"must be one of {list(laws)}")
    return kind, {key: value for key, value in table.items() if key not in ("law", "source")}


def _product(place: str, values: dict[str, Any], folder: Path) -> Product:
    known(f"{place}.", values, {"factors"})
    factors = get(values, place, "factors")
    if not isinstance(factors, list) or not all(isinstance(factor, dict) for factor in factors):
        raise SceneError(f"{place}.factors", factors, "must be a list of laws, each a table with its law")
    laws = tuple(_friction_law(f"{place}.factors[{i}]", factor, folder) for i, factor in enumerate(factors))
    return _placed(f"{place}.", lambda: Product(factors=laws))


def _table(place: str, values: dict[str, Any], folder: Path, law: Any) -> Any:
    if "file" in values and hasattr(law, "read"):
        return _of_file(place, values, "file", folder, law.read)
    return _placed(f"{place}.", lambda: record(law, place, values))


def _of_file(place: str, values: dict[str, Any], key: str, folder: Path, read: Callable[[Path], Any]) -> Any:
    known(f"{place}.", values, {key})
    path = folder / typed(f"{place}.{key}", values[key], "str")
    return _placed(f"{place}.{key}, ", lambda: read(path))


def _placed(before: str, build: Callable[[], Any]) -> Any:
    """Build a law; add contact and file to the place in its errors."""
    try:
        return build()
    except SceneError as error:
        if error.place.startswith(before):
            raise
        inner = error.place
        for own in ("friction.", "specific_wear_rate.", "wear_law."):
            inner = inner.removeprefix(own)
        raise SceneError(f"{before}{inner}", error.value, error.remedy) from None
