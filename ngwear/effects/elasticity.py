"""Nearly incompressible hyperelasticity with the volumetric stress as a separate unknown."""

from __future__ import annotations

import ngsolve as ng

from ngwear.effects.base import VOLUMETRIC_STRESS, Array, Unknowns, VolumeTerm
from ngwear.effects.invariants import Invariants
from ngwear.effects.isochoric import isochoric_energy, respond
from ngwear.fields.displacements import stress_order
from ngwear.geometry.meshed import Meshed
from ngwear.materials import Hyperelastic

POINTWISE = 3.0  # Ks / G: 0 and 10 make wrinkles, see ``Elasticity``; settled on ``verify sliding_roller``


class Elasticity(VolumeTerm):
    """Energy ``psi_iso + Ks/2 (J - 1)^2 + p (J - 1) - p^2 / (2 (K - Ks))`` over the section, Ks = 3 G.

    The unknown p [MPa] carries all but a small part Ks of the volumetric stiffness. With displacements of order 2 or 3
    and p of one less (Taylor-Hood), or of order 1 with bubbles and p of order 1 (see ``fields.displacements``), no
    locking appears for any K/G (perturbed Lagrangian of Simo, Taylor & Pister, Comput. Methods Appl. Mech. Eng. 51
    (1985) 177; ``verify locking``).

    Ks is necessary for stability: without it such pairs, which conserve the volume in the mean only, have spurious
    wrinkles of the mesh's wavelength once the pressure exceeds a few G (Auricchio et al., Comput. Methods Appl. Mech.
    Eng. 194 (2005) 1075): under a lip at p = 3.5 G one load had several discrete solutions, which differed by 3 µm and
    15 % of the peak pressure. The sum of both parts is the exact energy K/2 (J - 1)^2.

    Under tractions of about G along the surface a large Ks is harmful: at 10 G the pressure of ``verify
    sliding_roller`` has wrinkles of the mesh's wavelength from mu = 0.9 on, on elements of 0.025 mm, and none at 3 G.

    Parameters
    ----------
    material : Hyperelastic
    order : int
        Polynomial order of the displacement.
    """

    def __init__(self, material: Hyperelastic, *, order: int = 2) -> None:
        super().__init__()
        self.material, self.order = material, order

    @property
    def split(self) -> tuple[float, float]:
        """Two parts of the bulk modulus [MPa]: the pointwise part Ks and the part K - Ks of the unknown."""
        bulk = self.material.bulk_modulus
        pointwise = min(POINTWISE * self.material.shear_modulus, bulk / 2)
        return pointwise, bulk - pointwise

    def spaces(self, body: Meshed) -> dict[str, ng.FESpace]:
        return {VOLUMETRIC_STRESS: ng.H1(body.mesh, order=stress_order(self.order))}

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        self._state = unknowns.state

    def energy(self, strain: Array) -> Array:
        """Energy per reference volume [MPa] at strains of shape (..., n + 1)."""
        at = Invariants.of(strain)
        pointwise, rest = self.split
        psi = isochoric_energy(self.material, at)
        return psi + (at.j - 1) * (pointwise / 2 * (at.j - 1) + at.p) - at.p * at.p / (2 * rest)

    def response(self, strain: Array, *, tangent: bool) -> tuple[Array, Array | None]:
        at = Invariants.of(strain)
        pointwise, rest = self.split
        volumetric = pointwise * (at.j - 1) + at.p
        stress, slope = respond(self.material, at, strain, tangent=tangent, by_j=volumetric, by_jj=pointwise)
        stress[..., -1] = at.j - 1 - at.p / rest
        if slope is not None:
            for m, by_q in enumerate(at.gj):
                slope[..., m, -1] = slope[..., -1, m] = by_q
            slope[..., -1, -1] = -1 / rest
        return stress, slope

    def volume_ratio(self) -> ng.CoefficientFunction:
        """J = 1 + p / K of the present state [-]."""
        return 1 + self._state[VOLUMETRIC_STRESS] / self.split[1]
