"""Base class of all rubber models."""

from __future__ import annotations

import abc
import math
from dataclasses import dataclass
from typing import Any

from ngwear.errors import SceneError


@dataclass(frozen=True, kw_only=True)
class Hyperelastic(abc.ABC):
    """Isotropic, nearly incompressible hyperelasticity with a split energy.

    ``psi = psi_iso(I1_bar, I2_bar) + K/2 (J - 1)^2`` in MPa, with ``I1_bar = J^(-2/3) I1`` and
    ``I2_bar = J^(-4/3) I2`` of the right Cauchy-Green tensor C (Flory 1961; Holzapfel,
    *Nonlinear Solid Mechanics*, 2000, section 6.4). Models do not use a mesh: the same energy takes floats and arrays.

    Parameters
    ----------
    bulk_modulus : float
        K [MPa].
    """

    bulk_modulus: float

    @abc.abstractmethod
    def isochoric_energy(self, i1_bar: Any, i2_bar: Any) -> Any:
        """Energy psi_iso [MPa] of the isochoric invariants; zero at (3, 3)."""

    @abc.abstractmethod
    def isochoric_slopes(self, i1_bar: Any, i2_bar: Any) -> tuple[Any, Any, Any, Any, Any]:
        """First and second derivatives of psi_iso: by 1, 2, 11, 12 and 22, for I1_bar and I2_bar [MPa]."""

    @property
    @abc.abstractmethod
    def shear_modulus(self) -> float:
        """Initial shear modulus G [MPa]."""

    @property
    def young_modulus(self) -> float:
        """Initial Young's modulus E = 9KG / (3K + G) [MPa]."""
        k, g = self.bulk_modulus, self.shear_modulus
        return 9 * k * g / (3 * k + g)

    @property
    def poisson_ratio(self) -> float:
        """Initial Poisson's ratio [-]."""
        k, g = self.bulk_modulus, self.shear_modulus
        return (3 * k - 2 * g) / (2 * (3 * k + g))

    @property
    def plane_strain_modulus(self) -> float:
        """E* = E / (1 - nu^2) against a rigid body [MPa]."""
        return self.young_modulus / (1 - self.poisson_ratio**2)

    def uniaxial_stress(self, stretch: Any) -> Any:
        """Nominal stress of the incompressible material in uniaxial tension [MPa].

        ``P = d psi_iso / d stretch`` with the transverse stretches ``stretch^(-1/2)``, by a central
        difference of the energy (relative step 1e-5).
        """

        def energy(lam: Any) -> Any:
            return self.isochoric_energy(lam**2 + 2 / lam, 2 * lam + 1 / lam**2)

        step = 1e-5 * stretch
        return (energy(stretch + step) - energy(stretch - step)) / (2 * step)

    def _require_positive(self, **values: float) -> None:
        for name, value in values.items():
            if not 0 < value < math.inf:
                raise SceneError(f"material.{name}", value, "a modulus must be finite and greater than 0 MPa")
