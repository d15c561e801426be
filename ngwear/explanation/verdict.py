"""Verdict on a neglected effect."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """Text and numbers about a neglected effect.

    Parameters
    ----------
    words : str
        The reason.
    matters : bool or None
        Whether the scene should include it; None if it cannot be judged from the scene.
    numbers : mapping of str to float
        Named ``"quantity [unit]"``.
    """

    words: str
    matters: bool | None
    numbers: Mapping[str, float] = field(default_factory=dict)

    def as_dict(self) -> dict[str, Any]:
        """The numbers, ``"verdict"`` and ``"matters"``."""
        return {**self.numbers, "verdict": self.words, "matters": self.matters}


def onset(number: Callable[[float], float], limit: float, *, low: float = 1e-9, high: float = 1e12) -> float:
    """Argument at which an increasing function reaches a limit, by bisection of its logarithm to nine digits.

    Infinite if the function is below the limit at ``high``; ``low`` if it is above it there.
    """
    if number(high) < limit:
        return math.inf
    a, b = math.log(low), math.log(high)
    while b - a > 1e-9:
        middle = 0.5 * (a + b)
        a, b = (middle, b) if number(math.exp(middle)) < limit else (a, middle)
    return math.exp(b)
