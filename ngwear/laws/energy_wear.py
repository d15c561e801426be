"""Wear in proportion to the work of friction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ngwear.laws.wear_law import NO_FRICTION, Choice, WearLaw, if_positive


@dataclass(frozen=True)
class FrictionalEnergyWear(WearLaw):
    """``phi = mu``: depth over sliding distance ``k_E mu p``, in proportion to the work of friction.

    The dissipated energy of S. Fouvry, Ph. Kapsa and L. Vincent (Wear 200 (1996) 186), without a threshold. A contact's
    specific wear rate is then k_E, worn volume per work [mm³/mJ = mm²/N]. mu is that of the contact's law of friction
    at the present distance, speed and pressure.

    The whole work of friction counts, also the part by hysteresis.
    """

    needs_friction = True

    def factor(self, pressure: Any, friction: tuple[Any, Any] = NO_FRICTION, choose: Choice = if_positive) -> Any:
        return friction[0]

    def slope(self, pressure: Any, friction: tuple[Any, Any] = NO_FRICTION, choose: Choice = if_positive) -> Any:
        mu, rise = friction
        return mu + pressure * rise

    @property
    def words(self) -> str:
        return "by frictional energy, k mu p"
