"""Product of several laws of friction."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from ngwear.errors import SceneError
from ngwear.laws.base import FrictionLaw


@dataclass(frozen=True, kw_only=True)
class Product(FrictionLaw):
    """Product of laws, for example one by lubrication times one by pressure with ``light = 1``.

    Assumes that the effects are independent, which holds near one state only.

    Parameters
    ----------
    factors : tuple of FrictionLaw
        At least two.

    Raises
    ------
    SceneError
        For fewer than two factors.
    """

    factors: tuple[FrictionLaw, ...]

    def __post_init__(self) -> None:
        laws = isinstance(self.factors, Sequence) and all(isinstance(law, FrictionLaw) for law in self.factors)
        if not laws:
            raise SceneError("friction.factors", self.factors, "must be a list of laws of friction")
        object.__setattr__(self, "factors", tuple(self.factors))
        if len(self.factors) < 2:
            raise SceneError("friction.factors", len(self.factors), "a product needs at least two laws")

    @property
    def depends_on_speed(self) -> bool:
        return any(law.depends_on_speed for law in self.factors)

    @property
    def depends_on_pressure(self) -> bool:
        return any(law.depends_on_pressure for law in self.factors)

    @property
    def breaks(self) -> tuple[float, ...]:
        return tuple(sorted({s for law in self.factors for s in law.breaks}))

    def held(self, distance: float, speed: float | None) -> tuple[float, ...]:
        return tuple(number for law in self.factors for number in law.held(distance, speed))

    def of_pressure(self, held: Sequence[Any], pressure: Any) -> Any:
        product = 1.0
        for law, mine in self._shared(held):
            product = product * law.of_pressure(mine, pressure)
        return product

    def slope_of_pressure(self, held: Sequence[Any], pressure: Any) -> Any:
        product, slope = 1.0, 0.0
        for law, mine in self._shared(held):
            value = law.of_pressure(mine, pressure)
            slope = slope * value + product * law.slope_of_pressure(mine, pressure)
            product = product * value
        return slope

    def _shared(self, held: Sequence[Any]) -> Iterator[tuple[FrictionLaw, Sequence[Any]]]:
        """Each law with its part of ``held``."""
        rest = list(held)
        for law in self.factors:
            mine = len(law.held(0.0, 1.0))
            yield law, rest[:mine]
            rest = rest[mine:]

    @property
    def words(self) -> str:
        return " times ".join(law.words for law in self.factors)
