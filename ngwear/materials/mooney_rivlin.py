"""Mooney-Rivlin rubber: two moduli."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ngwear.errors import SceneError, check_fields
from ngwear.materials.base import Hyperelastic


@dataclass(frozen=True, kw_only=True)
class MooneyRivlin(Hyperelastic):
    """``psi_iso = C10 (I1_bar - 3) + C01 (I2_bar - 3)`` (Rivlin & Saunders 1951).

    Good to about 100 % of strain; it has no upturn at large stretch. ``G = 2 (C10 + C01)``.

    Parameters
    ----------
    c10, c01 : float
        Moduli [MPa]; c10 > 0, c01 >= 0 (a negative C01 loses stability in compression).

    Raises
    ------
    SceneError
        For a modulus out of range.

    Examples
    --------
    >>> MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1000.0).shear_modulus
    1.5
    """

    c10: float
    c01: float

    def __post_init__(self) -> None:
        check_fields(self, "material")
        self._require_positive(c10=self.c10, bulk_modulus=self.bulk_modulus)
        if not 0 <= self.c01 < math.inf:
            raise SceneError("material.c01", self.c01, "must be at least 0 MPa; for C01 = 0 use neo-hooke")

    @property
    def shear_modulus(self) -> float:
        return 2 * (self.c10 + self.c01)

    def isochoric_energy(self, i1_bar: Any, i2_bar: Any) -> Any:
        return self.c10 * (i1_bar - 3) + self.c01 * (i2_bar - 3)

    def isochoric_slopes(self, i1_bar: Any, i2_bar: Any) -> tuple[Any, Any, Any, Any, Any]:
        return self.c10, self.c01, 0.0, 0.0, 0.0
