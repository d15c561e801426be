"""Friction that falls with pressure, as on rubber."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ngwear.errors import check_fields
from ngwear.laws.base import FrictionLaw, require_number


@dataclass(frozen=True, kw_only=True)
class ByPressure(FrictionLaw):
    """``mu = limit + (light - limit) / (1 + p / pressure)^exponent``: adhesion with a saturating real contact area.

    With ``exponent = 1`` and ``limit = 0`` it is Thirion's law, 1/mu linear in p (Rev. Gen. Caoutch. 23 (1946) 101);
    with 1/3 it tends, far above ``pressure``, to the p^(-1/3) of elastic asperities (Schallamach, Proc. Phys. Soc.
    B 65 (1952) 657). At p = 0 mu is finite, so that the traction mu p starts in proportion to p.

    Valid for dry rubber and moderate pressures (Thirion measured below 1 MPa); neglects speed and temperature.

    Parameters
    ----------
    light : float
        mu at pressure 0 [-], >= 0.
    limit : float
        mu at very high pressure [-], >= 0.
    pressure : float
        Scale of the Cauchy pressure [MPa], > 0.
    exponent : float
        [-], > 0.

    Raises
    ------
    SceneError
        For a value out of range.
    """

    light: float
    pressure: float
    limit: float = 0.0
    exponent: float = 1.0

    def __post_init__(self) -> None:
        check_fields(self, "friction")
        require_number("friction.light", self.light)
        require_number("friction.limit", self.limit)
        require_number("friction.pressure", self.pressure, above=0.0)
        require_number("friction.exponent", self.exponent, above=0.0)

    @property
    def depends_on_pressure(self) -> bool:
        return True

    def held(self, distance: float, speed: float | None) -> tuple[float, ...]:
        return ()

    def of_pressure(self, held: Sequence[Any], pressure: Any) -> Any:
        return self.limit + (self.light - self.limit) * (1 + pressure / self.pressure) ** -self.exponent

    def slope_of_pressure(self, held: Sequence[Any], pressure: Any) -> Any:
        fall = self.exponent * (self.limit - self.light) / self.pressure
        return fall * (1 + pressure / self.pressure) ** (-self.exponent - 1)

    @property
    def words(self) -> str:
        return f"by pressure, from {self.light:g} at 0 to {self.limit:g}, scale {self.pressure:g} MPa"
