"""A law of wear that is not linear in the pressure, inside a contact."""

from __future__ import annotations

from typing import Any

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.effects.coefficient import Coefficient
from ngwear.laws import WearLaw
from ngwear.laws.wear_law import NO_FRICTION

Array = NDArray[np.float64]
LEAST = 1e-6  # of the shear modulus: pressures below wear in proportion, so that no slope is infinite


class PressureWear:
    """The closure ``K r(p)`` of a gap by wear, r = p phi(p), as its tangent at the state that is tried.

        r(p) = r(p_0) + r'(p_0) (p - p_0)

    ``slope`` is r'(p_0) and ``rest`` what is left at p = 0, r(p_0) - r'(p_0) p_0. The pressure P_0 follows the present
    state in each residual. So the contact's energy stays quadratic and its tangent symmetric; at p = p_0 the closure is
    the law's, and what the tangent leaves out is of second order.

    Parameters
    ----------
    law : WearLaw
    modulus : float
        Shear modulus of the body [MPa].
    coefficient : Coefficient or None
        Of the contact's friction, for a law that needs it.
    """

    def __init__(self, law: WearLaw, *, modulus: float, coefficient: Coefficient | None = None) -> None:
        self._law, self._coefficient, self._least = law, coefficient, LEAST * modulus

    def tangent(self, pressure: ng.GridFunction, stretch: Any) -> tuple[Any, Any, Any]:
        """``slope`` [-], ``rest`` [MPa] and ``steepest`` [-] of the state's nominal pressure; ``stretch`` da/dA.

        ``steepest`` is the larger of r' and r / p, for the scale of the contact's method: where r' falls with the
        pressure, a tangent overshoots to p < 0, and with a scale as small contact would be lost there.
        """
        self._state, self._tried = pressure, ng.GridFunction(pressure.space)
        p, least, law = self._tried / stretch, self._least, self._law
        above = ng.IfPos(p - least, p, least)
        friction = NO_FRICTION
        if law.needs_friction:
            friction = self._coefficient(above), self._coefficient.slope(above)
        factor, rise = (ng.CF(f(above, friction, ng.IfPos)) for f in (law.factor, law.slope))
        slope = ng.IfPos(p - least, rise, factor)
        return slope, ng.IfPos(p - least, p * (factor - rise), 0.0), ng.IfPos(slope - factor, slope, factor)

    def gather(self) -> None:
        """Take the present state's pressure for P_0."""
        self._tried.vec.data = self._state.vec

    def factor(self, pressure: Array) -> Array:
        """The law's phi of Cauchy pressures [MPa], in their shape [-]."""
        above = np.maximum(pressure, self._least)
        friction = NO_FRICTION
        if self._law.needs_friction:
            friction = self._coefficient.numbers(above), 0.0
        return np.asarray(self._law.factor(above, friction), dtype=float)
