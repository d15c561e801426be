"""Nearly incompressible hyperelasticity with the pressure as an unknown of its own."""

from __future__ import annotations

import ngsolve as ng

from ngwear.effects.base import Term, Unknowns
from ngwear.geometry.body import Body
from ngwear.materials import Hyperelastic

PRESSURE = "volumetric stress"


class Elasticity(Term):
    """Energy ``psi_iso(I1_bar, I2_bar) + p (J - 1) - p^2 / (2K)`` over the section.

    The unknown p [MPa] is the volumetric Cauchy stress K (J - 1). With displacements of order 2 and p of
    order 1 (Taylor-Hood) no locking appears for any K/G. The perturbed Lagrangian is that of
    Simo, Taylor & Pister, Comput. Methods Appl. Mech. Eng. 51 (1985) 177.
    """

    def __init__(self, material: Hyperelastic, *, order: int = 2) -> None:
        super().__init__()
        self.material, self.order = material, order

    def spaces(self, body: Body) -> dict[str, ng.FESpace]:
        return {PRESSURE: ng.H1(body.mesh, order=self.order - 1)}

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        self._state = unknowns.state
        u, p = unknowns.u, unknowns.trial[PRESSURE]
        kinematics = unknowns.kinematics
        i1, i2, j = kinematics.invariants(u, ng.Grad(u))
        psi = self.material.isochoric_energy(j ** (-2 / 3) * i1, j ** (-4 / 3) * i2)
        psi = psi + p * (j - 1) - p * p / (2 * self.material.bulk_modulus)
        form += ng.Variation((psi * kinematics.weight).Compile() * ng.dx)

    def volume_ratio(self) -> ng.CoefficientFunction:
        """J = 1 + p / K of the present state [-]."""
        return 1 + self._state[PRESSURE] / self.material.bulk_modulus
