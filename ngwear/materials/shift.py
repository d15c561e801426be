"""Time-temperature superposition: factor a_T on all relaxation times at another temperature."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ngwear.errors import SceneError, check_fields

GAS_CONSTANT = 8.31446261815324  # J/(mol K), exact since 2019 (SI)
MOST_DECADES = 30.0  # of a shift: beyond the whole of the glass transition


@dataclass(frozen=True)
class WLF:
    """``log10 a_T = -C1 (T - T_r) / (C2 + T - T_r)`` (Williams, Landel & Ferry, J. Am. Chem. Soc. 77 (1955) 3701).

    Valid from the glass transition to about 100 K above it.

    Parameters
    ----------
    c1 : float
        [-], > 0.
    c2 : float
        [K], > 0.
    reference : float
        T_r [K].
    """

    c1: float
    c2: float
    reference: float

    def __post_init__(self) -> None:
        check_fields(self, "material.prony.shift")
        for name, value in (("c1", self.c1), ("c2", self.c2), ("reference", self.reference)):
            if not 0 < value < math.inf:
                raise SceneError(f"material.shift.{name}", value, "must be finite and greater than 0")

    @classmethod
    def above_glass(cls, glass: float, reference: float) -> WLF:
        """Law with the universal constants 17.44 and 51.6 K at the glass temperature, for another reference [K]."""
        return cls(17.44, 51.6, glass).moved(reference)

    def moved(self, reference: float) -> WLF:
        """The same law with another reference temperature [K]."""
        distance = self._above_the_pole(reference)
        return WLF(self.c1 * self.c2 / distance, distance, reference)

    def factor(self, temperature: float) -> float:
        """``a_T = tau(T) / tau(T_r)``, above 1 when colder; temperature in K."""
        exponent = -self.c1 * (temperature - self.reference) / self._above_the_pole(temperature)
        if not exponent < MOST_DECADES:
            raise SceneError(
                "temperature",
                temperature,
                f"slows relaxation by {exponent:.3g} decades: the rubber is a glass there, and the WLF law has no "
                "meaning; give it in K",
            )
        return 10**exponent

    def _above_the_pole(self, temperature: float) -> float:
        distance = self.c2 + temperature - self.reference
        if not distance > 0:
            raise SceneError(
                "temperature",
                temperature,
                f"at {self.reference - self.c2:.4g} K and below the WLF law has no meaning (glass); give it in K",
            )
        return distance


@dataclass(frozen=True)
class Arrhenius:
    """``ln a_T = E_a / R (1/T - 1/T_r)``, for temperatures far above the glass transition.

    Parameters
    ----------
    activation_energy : float
        E_a [J/mol], > 0.
    reference : float
        T_r [K].
    """

    activation_energy: float
    reference: float

    def __post_init__(self) -> None:
        check_fields(self, "material.prony.shift")
        for name, value in (("activation_energy", self.activation_energy), ("reference", self.reference)):
            if not 0 < value < math.inf:
                raise SceneError(f"material.shift.{name}", value, "must be finite and greater than 0")

    def factor(self, temperature: float) -> float:
        """``a_T = tau(T) / tau(T_r)``, above 1 when colder; temperature in K."""
        if not temperature > 0:
            raise SceneError("temperature", temperature, "must be greater than 0 K")
        exponent = self.activation_energy / GAS_CONSTANT * (1 / temperature - 1 / self.reference)
        if not exponent < MOST_DECADES * math.log(10):
            raise SceneError("temperature", temperature, "slows relaxation by more than 30 decades; give it in K")
        return math.exp(exponent)
