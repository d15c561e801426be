"""What is said of an effect that is left out."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """Numbers and words about an absent effect.

    Parameters
    ----------
    words : str
        The verdict.
    matters : bool or None
        Whether the scene should not leave it out; None if what the scene says cannot tell.
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
    """Argument at which a rising function reaches a limit, by bisection of its logarithm to nine digits.

    Infinite if it is still below at ``high``; ``low`` if it is above already there.
    """
    if number(high) < limit:
        return math.inf
    a, b = math.log(low), math.log(high)
    while b - a > 1e-9:
        middle = 0.5 * (a + b)
        a, b = (middle, b) if number(math.exp(middle)) < limit else (a, middle)
    return math.exp(b)
