"""A rubber whose slowest relaxation times are part of the elastic stiffness."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ngwear.errors import SceneError
from ngwear.materials.base import Hyperelastic


@dataclass(frozen=True, kw_only=True)
class Stiffened(Hyperelastic):
    """``factor`` times the isochoric energy of another material, with the same bulk modulus.

    Parameters
    ----------
    material : Hyperelastic
    factor : float
        [-], > 0.

    Raises
    ------
    SceneError
        For a factor that is not positive.
    """

    material: Hyperelastic
    factor: float

    def __post_init__(self) -> None:
        if not 0 < self.factor < math.inf:
            raise SceneError("material.factor", self.factor, "must be finite and greater than 0")

    @property
    def shear_modulus(self) -> float:
        return self.factor * self.material.shear_modulus

    def isochoric_energy(self, i1_bar: Any, i2_bar: Any) -> Any:
        return self.factor * self.material.isochoric_energy(i1_bar, i2_bar)

    def isochoric_slopes(self, i1_bar: Any, i2_bar: Any) -> tuple[Any, Any, Any, Any, Any]:
        d1, d2, d11, d12, d22 = self.material.isochoric_slopes(i1_bar, i2_bar)
        return self.factor * d1, self.factor * d2, self.factor * d11, self.factor * d12, self.factor * d22
