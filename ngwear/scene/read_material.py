"""The tables [material] and [material.prony]."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ngwear.errors import SceneError, typed
from ngwear.materials import WLF, Arrhenius, Hyperelastic, MooneyRivlin, NeoHooke, PronySeries
from ngwear.materials.library import relaxation_of
from ngwear.scene.toml_values import get, known, record

MATERIALS: dict[str, Callable[..., Hyperelastic]] = {
    "neo-hooke": NeoHooke,
    "mooney-rivlin": MooneyRivlin,
}
_SHIFTS = {"wlf": WLF, "arrhenius": Arrhenius}
_REFERENCES = ("long-term", "instantaneous", "absolute")


def read_material(table: dict[str, Any]) -> Hyperelastic:
    """Read the long-term hyperelastic material from a table [material]."""
    model = get(table, "material", "model")
    if not isinstance(model, str) or model not in MATERIALS:
        raise SceneError("material.model", model, f"must be one of {list(MATERIALS)}")
    values = {key: value for key, value in table.items() if key not in ("model", "source", "prony")}
    return record(MATERIALS[model], "material", values)


def read_arms(table: dict[str, Any]) -> PronySeries:
    """Read the Prony series: a compound of the library, or moduli and times; shifted to the scene's temperature."""
    place = "material.prony"
    if not isinstance(table, dict):
        raise SceneError(place, table, "must be a table [material.prony]")
    table = {key: value for key, value in table.items() if key != "source"}
    shift: WLF | Arrhenius | None = None
    common = {"temperature", "shift", "smoothing"}
    if "compound" in table:
        known(f"{place}.", table, {"compound", *common})
        series, shift = relaxation_of(typed(f"{place}.compound", table["compound"], "str"))
    else:
        known(f"{place}.", table, {"moduli", "times", "reference", "long_term", *common})
        series = _listed_arms(table, place)
    if "smoothing" in table:
        from ngwear.materials.smoothing import smooth  # SciPy's optimizers are slow to load

        series = smooth(series, misfit=typed(f"{place}.smoothing", table["smoothing"], "float"))
    if "shift" in table:
        shift = _shift(table["shift"], f"{place}.shift")
        get(table, place, "temperature")
    if "temperature" not in table:
        return series
    temperature = typed(f"{place}.temperature", table["temperature"], "float")
    if shift is None:
        raise SceneError(f"{place}.temperature", temperature, "needs a [material.prony.shift] table")
    try:
        return series.shifted(shift.factor(temperature))
    except SceneError as error:
        raise SceneError(f"{place}.temperature", temperature, error.remedy) from None


def _listed_arms(table: dict[str, Any], place: str) -> PronySeries:
    moduli, times = (_numbers(f"{place}.{key}", get(table, place, key)) for key in ("moduli", "times"))
    reference = get(table, place, "reference")
    if reference not in _REFERENCES:
        raise SceneError(
            f"{place}.reference", reference, f"must be one of {list(_REFERENCES)}: what the moduli are relative to"
        )
    if reference == "absolute":
        long_term = typed(f"{place}.long_term", get(table, place, "long_term"), "float")
        return PronySeries.from_moduli(moduli, times, long_term=long_term)
    if "long_term" in table:
        raise SceneError(f"{place}.long_term", table["long_term"], "goes with reference = 'absolute' only")
    return PronySeries(moduli, times) if reference == "long-term" else PronySeries.from_shares(moduli, times)


def _numbers(place: str, values: Any) -> tuple[float, ...]:
    if not isinstance(values, list) or not values:
        raise SceneError(place, values, "must be a list of numbers, one for each arm")
    numbers = tuple(typed(f"{place}[{i}]", value, "float") for i, value in enumerate(values))
    for i, number in enumerate(numbers):
        if not number > 0:
            raise SceneError(f"{place}[{i}]", number, "must be greater than 0")
    return numbers


def _shift(table: Any, place: str) -> WLF | Arrhenius:
    if not isinstance(table, dict):
        raise SceneError(place, table, "must be a table [material.prony.shift]")
    law = get(table, place, "law")
    if not isinstance(law, str) or law not in _SHIFTS:
        raise SceneError(f"{place}.law", law, f"must be one of {list(_SHIFTS)}")
    return record(_SHIFTS[law], place, {key: value for key, value in table.items() if key != "law"})
