"""A law of friction, evaluated in a finite element form."""

from __future__ import annotations

from typing import Any

import ngsolve as ng

from ngwear.errors import SceneError
from ngwear.laws import Constant, FrictionLaw


class Coefficient:
    """Coefficient of friction in the form of a term: ``coefficient(pressure)``.

    The numbers that the law computes from distance and speed are parameters of the form; ``set_state`` changes them
    between solves. A constant law stays a number.

    Parameters
    ----------
    contact : str
        Name of the contact, for error messages.
    law : FrictionLaw or float
    speed : float or None
        First sliding speed [mm/s], at the distance 0.

    Raises
    ------
    SceneError
        For a negative coefficient.
    """

    def __init__(self, contact: str, law: FrictionLaw | float, *, speed: float | None = None) -> None:
        if not isinstance(law, FrictionLaw) and not law >= 0:
            raise SceneError(f"contact {contact}.friction", law, "must be at least 0")
        self.law = law if isinstance(law, FrictionLaw) else Constant(value=law)
        self._held = [ng.Parameter(number) for number in self.law.held(0.0, speed)]

    def set_state(self, distance: float, speed: float | None = None) -> None:
        """Set the sliding distance [mm] and the speed [mm/s]; None if the law needs no speed."""
        for parameter, number in zip(self._held, self.law.held(distance, speed), strict=True):
            parameter.Set(number)

    def with_slope(self, pressure: Any) -> tuple[Any, Any]:
        """Coefficient mu [-] and dmu/dp [1/MPa] under a Cauchy pressure >= 0 [MPa]: a field, a number or an array."""
        held = self._held
        if not isinstance(pressure, ng.CoefficientFunction):
            held = [parameter.Get() for parameter in held]
        return self.law.of_pressure(held, pressure), self.law.slope_of_pressure(held, pressure)

    def __call__(self, pressure: Any) -> Any:
        """Coefficient mu [-] under a Cauchy pressure [MPa], one below 0 taken as 0: a number or a field."""
        if not self.law.depends_on_pressure:
            return self.law.of_pressure(self._held, 0.0)
        return self.law.of_pressure(self._held, ng.IfPos(pressure, pressure, 0.0))
