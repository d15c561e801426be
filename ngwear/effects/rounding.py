"""Laws of contact and friction with their corners rounded off: for solves that do not converge with the corners."""

from __future__ import annotations

from typing import Any

import ngsolve as ng


class Rounding:
    """``max(0, x)`` with its corner replaced by the parabola ``(x + d)^2 / (4 d)`` between -d and d.

    The residual then has a continuous derivative, and Newton's method with damping converges where it would alternate
    between contact and none, or stick and slip (smoothing methods: Qi & Sun, *Comput. Optim. Appl.* 13 (1999) 201).

    Parameters
    ----------
    modulus : float
        Shear modulus G of the part [MPa], the scale of d.
    """

    def __init__(self, modulus: float) -> None:
        self._modulus = modulus
        self._on = ng.Parameter(0.0)
        self._width = ng.Parameter(1.0)
        self.relative = 0.0

    def set(self, relative: float) -> None:
        """Set d over G [-]; 0: the corner itself."""
        self.relative = relative
        self._on.Set(relative)
        self._width.Set(relative * self._modulus if relative > 0 else 1.0)  # a divisor, too, where it is not used

    def choose(self, rounded: Any, cornered: Any) -> Any:
        """The first expression while the corners are rounded off, else the second."""
        return ng.IfPos(self._on, rounded, cornered)

    def positive(self, x: Any) -> Any:
        """``max(0, x)``, rounded off; x in MPa."""
        d = self._width
        return ng.IfPos(x + d, ng.IfPos(x - d, x, (x + d) ** 2 / (4 * d)), 0.0)

    def square(self, x: Any) -> Any:
        """Twice the integral of ``positive`` over x [MPa²]."""
        d = self._width
        return ng.IfPos(x + d, ng.IfPos(x - d, x * x + d * d / 3, (x + d) ** 3 / (6 * d)), 0.0)
