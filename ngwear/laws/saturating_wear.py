"""Wear that saturates with the pressure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ngwear.errors import check_fields
from ngwear.laws.base import require_number
from ngwear.laws.wear_law import NO_FRICTION, Choice, WearLaw, if_positive


@dataclass(frozen=True, kw_only=True)
class SaturatingWear(WearLaw):
    """``phi = 1 / (1 + p / p_s)``: depth over distance ``k p / (1 + p / p_s)``, at most ``k p_s``.

    Phenomenological: the real contact area of rubber saturates, as in Thirion's law of friction (Rev. Gen. Caoutch. 23
    (1946) 101), and a higher pressure then does not wear more. Far below p_s it is Archard's law.

    Parameters
    ----------
    pressure : float
        p_s [MPa], > 0.

    Raises
    ------
    SceneError
        For a value out of range.
    """

    pressure: float

    def __post_init__(self) -> None:
        check_fields(self, "wear_law")
        require_number("wear_law.pressure", self.pressure, above=0.0)

    def factor(self, pressure: Any, friction: tuple[Any, Any] = NO_FRICTION, choose: Choice = if_positive) -> Any:
        return 1 / (1 + pressure / self.pressure)

    def slope(self, pressure: Any, friction: tuple[Any, Any] = NO_FRICTION, choose: Choice = if_positive) -> Any:
        return self.factor(pressure) ** 2

    @property
    def words(self) -> str:
        return f"saturating, k p / (1 + p / {self.pressure:g} MPa)"
