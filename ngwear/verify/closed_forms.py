"""Closed forms that several cases compare with."""

from __future__ import annotations

import math

from scipy.integrate import quad


def expanding_pressure(shear: float, inner: float, outer: float, bore: float) -> float:
    """Pressure that expands a ring's bore from ``inner`` to ``bore`` [MPa], incompressible and plane strain.

    Mooney-Rivlin or neo-Hooke of shear modulus G: with the hoop stretch L = r/R, radial equilibrium and
    ``r^2 = R^2 + bore^2 - inner^2`` give ``p = int G (L^2 - L^-2) / r dr`` over the deformed wall (Rivlin,
    Phil. Trans. R. Soc. A 242 (1949) 173).
    """
    grown = bore**2 - inner**2

    def integrand(r: float) -> float:
        hoop2 = r * r / (r * r - grown)
        return shear * (hoop2 - 1 / hoop2) / r

    return quad(integrand, bore, math.sqrt(outer**2 + grown), epsabs=0, epsrel=1e-12)[0]
