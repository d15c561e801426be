"""A law of wear that is not linear in the pressure, in the equations of a contact."""

from __future__ import annotations

from typing import Any

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.effects.coefficient import Coefficient
from ngwear.errors import SceneError
from ngwear.laws import WearLaw
from ngwear.laws.wear_law import NO_FRICTION

Array = NDArray[np.float64]
LEAST = 1e-8  # of the shear modulus: pressures below wear in proportion, so that no slope is infinite; no load
FADES = 0.25  # from one tangent of a solve to the next: 1e-6 after ten; checked by ``verify wear_laws``


class PressureWear:
    """Wear depth ``K r(p)`` in the gap, r = p phi(p), linearised at the present state.

        r(p) = r(p_0) + slope (p - p_0),    slope = max(r'(p_0), b)

    ``rest`` is what is left at p = 0. The pressure P_0 follows the present state in each residual: the contact's energy
    stays quadratic and its tangent symmetric, and at p = p_0 the closure is the law's. The bound b is r' at the peak of
    the state that a solve starts from, and fades to nothing: without b, where a law wears almost nothing at low
    pressures, the first iteration at a new contact point would overshoot far.

    Parameters
    ----------
    law : WearLaw
    modulus : float
        Shear modulus of the body [MPa].
    coefficient : Coefficient or None
        Of the contact's friction, for a law that needs it.

    Raises
    ------
    SceneError
        If the law needs friction and there is none.
    """

    def __init__(self, law: WearLaw, *, modulus: float, coefficient: Coefficient | None = None) -> None:
        if law.needs_friction and coefficient is None:
            raise SceneError("contact.wear_law", law, "wears by the work of friction: the contact needs a friction")
        self._law, self._least = law, LEAST * modulus
        self._coefficient = coefficient if law.needs_friction else None
        self._bound = ng.Parameter(0.0)

    def tangent(self, pressure: ng.GridFunction, stretch: Any) -> tuple[Any, Any, Any]:
        """``slope`` [-], ``rest`` [MPa] and ``steepest`` [-] of the state's nominal pressure; ``stretch`` da/dA.

        ``steepest`` is the larger of r' and r / p, for the scale of the contact's method: where r' falls with the
        pressure, a tangent overshoots to p < 0, and a scale as small as r' would lose the contact there.
        """
        self._state, self._tried = pressure, ng.GridFunction(pressure.space)
        p, least, law = self._tried / stretch, self._least, self._law
        above = ng.IfPos(p - least, p, least)
        friction = self._friction(above)
        factor, slope = (ng.CF(f(above, friction, ng.IfPos)) for f in (law.factor, law.slope))
        slope = ng.IfPos(p - least, slope, factor)
        slope = ng.IfPos(slope - self._bound, slope, self._bound)
        return slope, p * (factor - slope), ng.IfPos(slope - factor, slope, factor)

    def prepare(self, peak: float) -> None:
        """Begin a solve at a state whose highest Cauchy pressure is ``peak`` [MPa]."""
        above = max(peak, self._least)
        self._bound.Set(float(self._law.slope(above, self._friction(above))) / FADES)

    def gather(self) -> None:
        """Take the present state's pressure for P_0."""
        self._bound.Set(FADES * self._bound.Get())
        self._tried.vec.data = self._state.vec

    def factor(self, pressure: Array) -> Array:
        """The law's phi of Cauchy pressures [MPa], in their shape [-]."""
        above = np.maximum(pressure, self._least)
        return self._law.factor(above, self._friction(above)) + np.zeros_like(above)

    def _friction(self, pressure: Any) -> tuple[Any, Any]:
        """Coefficient mu [-] and its slope [1/MPa], for a law that needs them."""
        return NO_FRICTION if self._coefficient is None else self._coefficient.with_slope(pressure)
