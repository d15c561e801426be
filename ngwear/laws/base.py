"""Base class of all laws of friction."""

from __future__ import annotations

import abc
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any

from ngwear.errors import SceneError


@dataclass(frozen=True)
class Curve:
    """A coefficient over the sliding distance; (nearly) linear between the distances ``breaks`` [mm]."""

    value: Callable[[float], float]
    breaks: tuple[float, ...]

    def _places(self, start: float, end: float) -> list[float]:
        return [start, *(s for s in self.breaks if start < s < end), end]

    def extremes(self, start: float, end: float) -> tuple[float, float]:
        """Lowest and highest value between two distances [mm]."""
        values = [self.value(s) for s in self._places(start, end)]
        return min(values), max(values)

    def mean(self, start: float, end: float) -> float:
        """Mean value between two distances [mm], start < end."""
        parts = pairwise(self._places(start, end))
        return sum(0.5 * (self.value(a) + self.value(b)) * (b - a) for a, b in parts) / (end - start)


class FrictionLaw(abc.ABC):
    """Coefficient of friction mu(s, v, p) over sliding distance, speed and Cauchy pressure.

    Distance and speed are constant in a solve, the pressure is not. So a law is evaluated in two steps: ``held``
    computes numbers from distance and speed, ``of_pressure`` computes mu from these numbers and a pressure. The second
    step uses plain arithmetic, so that numbers, arrays and NGSolve's coefficient functions are allowed.
    """

    @property
    def depends_on_speed(self) -> bool:
        """Whether mu depends on the speed."""
        return False

    @property
    def depends_on_pressure(self) -> bool:
        """Whether mu depends on the pressure."""
        return False

    @property
    def breaks(self) -> tuple[float, ...]:
        """Sliding distances at which the slope of mu changes [mm]: extremes lie there, or at the ends of a range.

        Empty for a law that does not depend on the distance.
        """
        return ()

    @abc.abstractmethod
    def held(self, distance: float, speed: float | None) -> tuple[float, ...]:
        """Numbers of the law at a sliding distance [mm] and a speed [mm/s]; speed None for a law without it."""

    def of_pressure(self, held: Sequence[Any], pressure: Any) -> Any:
        """Coefficient mu [-] from the numbers of ``held`` and a Cauchy pressure >= 0 [MPa]."""
        return held[0]

    def slope_of_pressure(self, held: Sequence[Any], pressure: Any) -> Any:
        """Derivative dmu/dp [1/MPa]; arguments as of ``of_pressure``."""
        return 0.0

    def mu(self, distance: float, speed: float | None = None, pressure: Any = 0.0) -> Any:
        """Coefficient of friction [-]; it has the shape of the pressure [MPa] if the law depends on it."""
        return self.of_pressure(self.held(distance, speed), pressure)

    def curve(self, speed: float | None = None) -> Curve:
        """Coefficient over the sliding distance, at a speed [mm/s] and at pressure 0."""
        return Curve(partial(self.mu, speed=speed), self.breaks)

    @property
    @abc.abstractmethod
    def words(self) -> str:
        """The law in one line of text."""


def require_number(place: str, value: float, *, above: float | None = None) -> None:
    """Require a finite number: at least 0, or greater than ``above`` if given.

    Raises
    ------
    SceneError
    """
    if above is not None and not above < value < math.inf:
        raise SceneError(place, value, f"must be finite and greater than {above:g}")
    if not 0 <= value < math.inf:
        raise SceneError(place, value, "must be at least 0, and finite")
