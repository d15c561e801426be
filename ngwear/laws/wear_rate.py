"""Archard's specific wear rate over the sliding distance."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import check_fields
from ngwear.files.columns import read_columns
from ngwear.laws.base import Curve
from ngwear.laws.table import area_below, check_table

Array = NDArray[np.float64]
DISTANCE, RATE = "sliding distance [mm]", "specific wear rate [mm^2/N]"


@dataclass(frozen=True, kw_only=True)
class WearRate:
    """Table of k over the sliding distance, linear between its rows and constant beyond its ends.

    A step of wear uses the exact ``int k ds``, written as the highest rate times an equivalent distance.

    Parameters
    ----------
    distance : tuple of float
        Sliding distance [mm], >= 0, rising. A number as a contact's ``specific_wear_rate`` means one row.
    rate : tuple of float
        k there [mm²/N], >= 0.

    Raises
    ------
    SceneError
        For distances that do not rise or rates below 0.
    """

    distance: tuple[float, ...]
    rate: tuple[float, ...]

    def __post_init__(self) -> None:
        check_fields(self, "specific_wear_rate")
        check_table("specific_wear_rate", "rate", self.distance, self.rate, unit=" mm²/N")

    @classmethod
    def read(cls, path: Path | str) -> WearRate:
        """Read the columns ``sliding distance [mm]`` and ``specific wear rate [mm^2/N]`` of a CSV file."""
        columns = read_columns(path, (DISTANCE, RATE))
        return cls(distance=tuple(columns[DISTANCE].tolist()), rate=tuple(columns[RATE].tolist()))

    @property
    def curve(self) -> Curve:
        """The rate over the distance."""
        return Curve(self.at, self.distance)

    @property
    def varies(self) -> bool:
        """Whether k changes with the distance."""
        return min(self.rate) < max(self.rate)

    @property
    def highest(self) -> float:
        """Highest k [mm²/N]."""
        return max(self.rate)

    def at(self, distance: float) -> float:
        """Return k at a sliding distance [mm²/N]."""
        return float(np.interp(distance, self.distance, self.rate))

    def worn_distance(self, starts: Array, travel: float) -> float:
        """``sum int k ds / highest`` [mm] of strokes with one travel [mm] that begin at ``starts`` [mm]."""
        ends = area_below(self.distance, self.rate, starts + travel)
        return float((ends - area_below(self.distance, self.rate, starts)).sum() / self.highest)
