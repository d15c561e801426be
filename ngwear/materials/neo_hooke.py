"""Neo-Hooke rubber: one shear modulus."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ngwear.errors import SceneError, check_fields
from ngwear.materials.base import Hyperelastic


@dataclass(frozen=True, kw_only=True)
class NeoHooke(Hyperelastic):
    """``psi_iso = G/2 (I1_bar - 3)`` (Treloar 1943): good to about 50 % of strain.

    Parameters
    ----------
    shear : float
        G [MPa], > 0.

    Raises
    ------
    SceneError
        For a modulus that is not positive.

    Examples
    --------
    >>> NeoHooke(shear=1.0, bulk_modulus=1000.0).uniaxial_stress(2.0).__round__(4)
    1.75
    """

    shear: float

    def __post_init__(self) -> None:
        check_fields(self, "material")
        self._require_positive(shear=self.shear, bulk_modulus=self.bulk_modulus)

    @classmethod
    def from_young(cls, young: float, poisson: float) -> NeoHooke:
        """Return the model with Young's modulus ``young`` [MPa] and ratio ``poisson`` < 0.5."""
        if not -1 < poisson < 0.5:
            raise SceneError("material.poisson", poisson, "must lie between -1 and 0.5")
        return cls(shear=young / (2 * (1 + poisson)), bulk_modulus=young / (3 * (1 - 2 * poisson)))

    @property
    def shear_modulus(self) -> float:
        return self.shear

    def isochoric_energy(self, i1_bar: Any, i2_bar: Any) -> Any:
        return 0.5 * self.shear * (i1_bar - 3)

    def isochoric_slopes(self, i1_bar: Any, i2_bar: Any) -> tuple[Any, Any, Any, Any, Any]:
        return 0.5 * self.shear, 0.0, 0.0, 0.0, 0.0
