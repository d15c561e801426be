"""Nearly incompressible hyperelasticity with the pressure as an unknown of its own."""

from __future__ import annotations

import math
from typing import Any

import ngsolve as ng

from ngwear.effects.base import DISPLACEMENT, Term, Unknowns
from ngwear.fields.kinematics import Kinematics
from ngwear.geometry.body import Body
from ngwear.materials import Hyperelastic

PRESSURE = "volumetric stress"
POINTWISE = 10.0  # Ks / G


class Elasticity(Term):
    """Energy ``psi_iso + Ks/2 (J - 1)^2 + p (J - 1) - p^2 / (2 (K - Ks))`` over the section.

    The unknown p [MPa] carries all but a small part Ks = 10 G of the volumetric stiffness. With displacements
    of order 2 and p of order 1 (Taylor-Hood) no locking appears for any K/G (perturbed Lagrangian of
    Simo, Taylor & Pister, Comput. Methods Appl. Mech. Eng. 51 (1985) 177).

    Ks is there for stability: without it such pairs, volume kept in the mean only, have spurious
    wrinkles of the mesh's wavelength once the pressure exceeds a few G (Auricchio et al., Comput. Methods
    Appl. Mech. Eng. 194 (2005) 1075): under a lip at p = 3.5 G one load had several discrete solutions, which
    differed by 3 µm and 15 % of the peak pressure. The sum of both parts is the exact energy K/2 (J - 1)^2.
    """

    def __init__(self, material: Hyperelastic, *, order: int = 2) -> None:
        super().__init__()
        self.material, self.order = material, order

    @property
    def split(self) -> tuple[float, float]:
        """The bulk modulus in two [MPa]: the part taken pointwise, and the part carried by the unknown."""
        bulk = self.material.bulk_modulus
        pointwise = min(POINTWISE * self.material.shear_modulus, bulk / 2)
        return pointwise, bulk - pointwise

    def spaces(self, body: Body) -> dict[str, ng.FESpace]:
        return {PRESSURE: ng.H1(body.mesh, order=self.order - 1)}

    def energy(self, kinematics: Kinematics, u: Any, p: Any, *, hoop: Any = None) -> Any:
        """Energy per reference volume [MPa] of a trial or known displacement and volumetric stress."""
        i1, i2, j = kinematics.invariants(u, ng.Grad(u), hoop=hoop)
        pointwise, rest = self.split
        scale, change = j ** (-2 / 3), j - 1  # a power and a division cost more than the rest: one of each, or none
        psi = self.material.isochoric_energy(scale * i1, scale * scale * i2)
        return psi + pointwise / 2 * change * change + p * change - 1 / (2 * rest) * p * p

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        self._state, self._kinematics, self._body = unknowns.state, unknowns.kinematics, unknowns.body
        psi = self.energy(unknowns.kinematics, unknowns.u, unknowns.trial[PRESSURE])
        form += ng.Variation((psi * unknowns.kinematics.weight).Compile() * ng.dx)

    def hoop_force(self) -> float:
        """Radial resultant of the hoop tension of an axisymmetric part, ``2 pi int P_hoop dA`` [N]."""
        u, p = self._state[DISPLACEMENT], self._state[PRESSURE]
        hoop = self._kinematics.hoop_stretch(u).MakeVariable()
        stress = self.energy(self._kinematics, u, p, hoop=hoop).Diff(hoop)
        return 2 * math.pi * ng.Integrate(stress.Compile(), self._body.mesh, order=4)

    def volume_ratio(self) -> ng.CoefficientFunction:
        """J = 1 + p / K of the present state [-]."""
        return 1 + self._state[PRESSURE] / self.split[1]
