"""Constant coefficient of friction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ngwear.errors import check_fields
from ngwear.laws.base import FrictionLaw, require_number


@dataclass(frozen=True, kw_only=True)
class Constant(FrictionLaw):
    """Coulomb's law with a constant mu [-], >= 0. A number as ``friction`` of a contact means this law.

    Raises
    ------
    SceneError
        For a negative coefficient.
    """

    value: float

    def __post_init__(self) -> None:
        check_fields(self, "friction")
        require_number("friction", self.value)

    def held(self, distance: float, speed: float | None) -> tuple[float, ...]:
        return ()

    def of_pressure(self, held: Sequence[Any], pressure: Any) -> Any:
        return self.value

    @property
    def words(self) -> str:
        return f"mu = {self.value:g}"


def law_of(friction: FrictionLaw | float) -> FrictionLaw | None:
    """The law for a contact's ``friction``; None without friction."""
    law = friction if isinstance(friction, FrictionLaw) else Constant(value=friction)
    return None if law == Constant(value=0.0) else law
