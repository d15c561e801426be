"""Sliding distances of the strokes of a step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ngwear.laws import WearRate

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Strokes:
    """Strokes of one kind that one solve represents, with the other strokes of the cycle between them.

    Their friction is the law's at ``middle``: of second order in the step, and exact where the law is linear.

    Parameters
    ----------
    start : float
        Sliding distance at which the first begins [mm].
    travel, cycle : float
        Sliding distance of one, and of a whole cycle [mm].
    repeats : int
        Number of strokes; 0 for the state at ``start``, without sliding.
    """

    start: float
    travel: float
    cycle: float
    repeats: int = 0

    @property
    def distance(self) -> float:
        """Sliding distance of all strokes [mm]."""
        return self.repeats * self.travel

    @property
    def starts(self) -> Array:
        """Sliding distance at which each begins [mm], shape (repeats,)."""
        return self.start + self.cycle * np.arange(self.repeats, dtype=float)

    def worn_distance(self, rate: WearRate) -> float:
        """``int k ds`` over the highest k [mm], exact: the distance over which the highest k gives the same wear."""
        return self.distance if not rate.varies else rate.worn_distance(self.starts, self.travel)

    def worn_depth(self, rate: WearRate) -> float:
        """``int k ds``: depth over pressure [mm/MPa]."""
        return rate.highest * self.worn_distance(rate)

    def wear_rate(self, rate: WearRate) -> float:
        """Mean of k [mm²/N]."""
        return self.worn_depth(rate) / self.distance if self.repeats else rate.at(self.start)

    @property
    def middle(self) -> float:
        """Sliding distance halfway from the first one's start to the last one's end [mm]."""
        return self.start + (0.5 * ((self.repeats - 1) * self.cycle + self.travel) if self.repeats else 0.0)
