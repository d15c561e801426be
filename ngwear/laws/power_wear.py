"""Wear by a power law of the pressure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ngwear.errors import check_fields
from ngwear.laws.base import require_number
from ngwear.laws.wear_law import NO_FRICTION, Choice, WearLaw, if_positive


@dataclass(frozen=True, kw_only=True)
class PowerWear(WearLaw):
    """``phi = (p / p_ref)^(m - 1)``: depth over distance ``k p_ref (p / p_ref)^m``.

    Rhee's wear equation for polymers at one speed (S.K. Rhee, Wear 16 (1970) 431), common for the abrasion of rubber.
    With the scale p_ref the unit of k is mm²/N: at p = p_ref the law equals Archard's with the same k.

    Valid in the range of pressures in which m was measured. For m < 1 the slope of the wear rate is large near p = 0.

    Parameters
    ----------
    exponent : float
        m [-], > 0; 1 is Archard's law.
    reference_pressure : float
        p_ref [MPa], > 0.

    Raises
    ------
    SceneError
        For a value out of range.
    """

    exponent: float
    reference_pressure: float = 1.0

    def __post_init__(self) -> None:
        check_fields(self, "wear_law")
        require_number("wear_law.exponent", self.exponent, above=0.0)
        require_number("wear_law.reference_pressure", self.reference_pressure, above=0.0)

    def factor(self, pressure: Any, friction: tuple[Any, Any] = NO_FRICTION, choose: Choice = if_positive) -> Any:
        return (pressure / self.reference_pressure) ** (self.exponent - 1)

    def slope(self, pressure: Any, friction: tuple[Any, Any] = NO_FRICTION, choose: Choice = if_positive) -> Any:
        return self.exponent * self.factor(pressure)

    @property
    def words(self) -> str:
        return f"power of the pressure, k p (p / {self.reference_pressure:g} MPa)^{self.exponent - 1:g}"
