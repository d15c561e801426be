"""Friction over speed: Stribeck's curve."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ngwear.errors import SceneError, check_fields
from ngwear.laws.base import FrictionLaw, require_number


@dataclass(frozen=True, kw_only=True)
class Stribeck(FrictionLaw):
    """``mu = full + (boundary - full) exp(-(v / speed)^exponent) + viscous v``.

    Boundary lubrication at rest, mixed lubrication near ``speed``, above it a film whose shear grows with v (Tustin
    1947 with exponent 1; Bo & Pavelescu, Wear 82 (1982) 277 with a free one; reviewed by Armstrong-Helouvry, Dupont &
    Canudas de Wit, Automatica 30 (1994) 1083).

    Valid for steady sliding at one viscosity and mean pressure, to which ``speed`` belongs (Hersey's number, viscosity
    times speed over pressure, is what counts). Neglects the lag of friction behind speed.

    Parameters
    ----------
    boundary : float
        mu of boundary lubrication, v -> 0 [-], >= 0.
    full : float
        mu of the film without its viscous part [-], >= 0.
    speed : float
        Speed at which the boundary term has fallen to 1/e [mm/s], > 0.
    exponent : float
        [-], > 0.
    viscous : float
        Slope of mu with speed [s/mm], >= 0.

    Raises
    ------
    SceneError
        For a value out of range.
    """

    boundary: float
    full: float
    speed: float
    exponent: float = 1.0
    viscous: float = 0.0

    def __post_init__(self) -> None:
        check_fields(self, "friction")
        for name in ("boundary", "full", "viscous"):
            require_number(f"friction.{name}", getattr(self, name))
        for name in ("speed", "exponent"):
            require_number(f"friction.{name}", getattr(self, name), above=0.0)

    @property
    def depends_on_speed(self) -> bool:
        return True

    def held(self, distance: float, speed: float | None) -> tuple[float, ...]:
        if speed is None:
            raise SceneError("friction", "Stribeck", "depends on the speed: give one [mm/s]")
        gone = math.exp(-((speed / self.speed) ** self.exponent))
        return (self.full + (self.boundary - self.full) * gone + self.viscous * speed,)

    @property
    def words(self) -> str:
        return f"by speed (Stribeck), from {self.boundary:g} at rest, scale {self.speed:g} mm/s"
