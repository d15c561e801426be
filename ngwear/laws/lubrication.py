"""Friction over the sliding distance since the contact was lubricated."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ngwear.errors import check_fields
from ngwear.files.columns import read_columns
from ngwear.laws.base import FrictionLaw
from ngwear.laws.table import check_table

DISTANCE, COEFFICIENT = "sliding distance [mm]", "friction coefficient [-]"


@dataclass(frozen=True, kw_only=True)
class Lubrication(FrictionLaw):
    """Table of mu over the sliding distance, linear between its rows and constant beyond its ends.

    A contact that loses its lubricant passes four phases (Bekesi, 10.5772/50498): a film that separates the surfaces
    (soft elastohydrodynamic, constant), mixed lubrication (rising), boundary lubrication (rising), dry (constant).

    Neglects that wear, speed and pressure change how fast the lubricant is used up: a table is valid for one set-up.

    Parameters
    ----------
    distance : tuple of float
        Sliding distance [mm], >= 0, rising.
    coefficient : tuple of float
        mu there [-], >= 0.

    Raises
    ------
    SceneError
        For distances that do not rise or coefficients below 0.
    """

    distance: tuple[float, ...]
    coefficient: tuple[float, ...]

    def __post_init__(self) -> None:
        check_fields(self, "friction")
        check_table("friction", "coefficient", self.distance, self.coefficient, unit="")

    @classmethod
    def four_phases(cls, *, film: float, boundary: float, dry: float, ends: tuple[float, float, float]) -> Lubrication:
        """Film, mixed and boundary lubrication, and dry sliding.

        Parameters
        ----------
        film : float
            mu while a film separates the surfaces [-].
        boundary : float
            mu where mixed lubrication turns into boundary lubrication [-].
        dry : float
            mu without lubricant [-].
        ends : tuple of float
            Where the film, mixed and boundary lubrication end [mm], > 0, rising.
        """
        return cls(distance=(0.0, *ends), coefficient=(film, film, boundary, dry))

    @classmethod
    def read(cls, path: Path | str) -> Lubrication:
        """Read the columns ``sliding distance [mm]`` and ``friction coefficient [-]`` of a CSV file."""
        columns = read_columns(path, (DISTANCE, COEFFICIENT))
        return cls(distance=tuple(columns[DISTANCE].tolist()), coefficient=tuple(columns[COEFFICIENT].tolist()))

    @property
    def breaks(self) -> tuple[float, ...]:
        return self.distance

    def held(self, distance: float, speed: float | None) -> tuple[float, ...]:
        return (float(np.interp(distance, self.distance, self.coefficient)),)

    @property
    def words(self) -> str:
        return f"by lubrication, {len(self.distance)} rows to {self.distance[-1]:g} mm"
