"""Wear above a threshold of the pressure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ngwear.errors import check_fields
from ngwear.laws.base import require_number
from ngwear.laws.wear_law import NO_FRICTION, Choice, WearLaw, if_positive


@dataclass(frozen=True, kw_only=True)
class ThresholdWear(WearLaw):
    """``phi = max(0, 1 - p_0 / p)``: depth over distance ``k max(0, p - p_0)``.

    Phenomenological: below p_0 nothing wears, above it wear grows with p - p_0. A contact under constant force whose
    mean pressure is below p_0 stops wearing before its pressure is even.

    Parameters
    ----------
    pressure : float
        p_0 [MPa], >= 0; 0 is Archard's law.

    Raises
    ------
    SceneError
        For a value out of range.
    """

    pressure: float

    def __post_init__(self) -> None:
        check_fields(self, "wear_law")
        require_number("wear_law.pressure", self.pressure)

    def factor(self, pressure: Any, friction: tuple[Any, Any] = NO_FRICTION, choose: Choice = if_positive) -> Any:
        return choose(pressure - self.pressure, 1 - self.pressure / pressure, 0.0)

    def slope(self, pressure: Any, friction: tuple[Any, Any] = NO_FRICTION, choose: Choice = if_positive) -> Any:
        return choose(pressure - self.pressure, 1.0, 0.0)

    @property
    def words(self) -> str:
        return f"above a threshold, k (p - {self.pressure:g} MPa)"
