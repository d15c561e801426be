"""Nearly incompressible hyperelasticity with the pressure as an unknown of its own."""

from __future__ import annotations

from typing import Any

import ngsolve as ng
import numpy as np

from ngwear.effects.base import VOLUMETRIC_STRESS, Array, Unknowns, VolumeTerm
from ngwear.geometry.body import Body
from ngwear.materials import Hyperelastic

POINTWISE = 10.0  # Ks / G


class Elasticity(VolumeTerm):
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
        return {VOLUMETRIC_STRESS: ng.H1(body.mesh, order=self.order - 1)}

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        self._state, self._points = unknowns.state, unknowns.points

    def energy(self, strain: Array) -> Array:
        """Energy per reference volume [MPa] at strains of shape (..., 6)."""
        at = _Invariants(strain)
        pointwise, rest = self.split
        with np.errstate(invalid="ignore"):
            scale = at.j ** (-2 / 3)
        psi = self.material.isochoric_energy(scale * at.i1, scale * scale * at.i2)
        return psi + (at.j - 1) * (pointwise / 2 * (at.j - 1) + at.p) - at.p * at.p / (2 * rest)

    def response(self, strain: Array, *, tangent: bool) -> tuple[Array, Array | None]:
        at = _Invariants(strain)
        i1, i2, j, gj = at.i1, at.i2, at.j, at.gj
        pointwise, rest = self.split
        with np.errstate(invalid="ignore", divide="ignore"):  # not a number where J <= 0: the solver sees it
            a = j ** (-2 / 3)
            a_j, b_j = -2 / 3 * a / j, -4 / 3 * a * a / j
        d1, d2, d11, d12, d22 = self.material.isochoric_slopes(a * i1, a * a * i2)
        volumetric = pointwise * (j - 1) + at.p
        # By the chain rule: psi depends on I1, I2 and J with the slopes f1, f2 and fj.
        f1, f2, fj = d1 * a, d2 * a * a, d1 * a_j * i1 + d2 * b_j * i2 + volumetric
        stress = np.empty_like(strain)
        for k in range(5):
            stress[..., k] = f1 * at.g1[k] + f2 * at.g2[k] + fj * gj[k]
        stress[..., 5] = j - 1 - at.p / rest
        if not tangent:
            return stress, None
        # Second derivatives: products of slopes here, the invariants' own second derivatives after.
        by_jj = (f1 * 10 / 9 * i1 + f2 * 28 / 9 * i2) / (j * j) + pointwise
        mixed = [d1 * a_j * at.g1[k] + d2 * b_j * at.g2[k] + 0.5 * by_jj * gj[k] for k in range(5)]
        slope = np.zeros((*strain.shape, strain.shape[-1]))
        own = at.curvature(f1, f2, fj)
        curved = np.any(d11) or np.any(d12) or np.any(d22)
        b1 = [a * at.g1[k] + a_j * i1 * gj[k] for k in range(5)] if curved else []
        b2 = [a * a * at.g2[k] + b_j * i2 * gj[k] for k in range(5)] if curved else []
        for m in range(5):
            for n in range(m, 5):
                entry = mixed[m] * gj[n] + mixed[n] * gj[m] + own.get((m, n), 0.0)
                if curved:
                    entry += d11 * b1[m] * b1[n] + d12 * (b1[m] * b2[n] + b2[m] * b1[n]) + d22 * b2[m] * b2[n]
                slope[..., m, n] = slope[..., n, m] = entry
            slope[..., m, 5] = slope[..., 5, m] = gj[m]
        slope[..., 5, 5] = -1 / rest
        return stress, slope

    def hoop_force(self, vector: Array) -> float:
        """Radial resultant of the hoop tension of an axisymmetric part, ``2 pi int P_hoop dA`` [N]."""
        stress, _ = self.response(self._points.strain(vector), tangent=False)
        # The volumes are 2 pi R dA.
        return float((self._points.volumes * stress[..., 4] / self._points.radius).sum())

    def volume_ratio(self) -> ng.CoefficientFunction:
        """J = 1 + p / K of the present state [-]."""
        return 1 + self._state[VOLUMETRIC_STRESS] / self.split[1]


class _Invariants:
    """``q = (F_xx, F_xy, F_yx, F_yy, hoop)``, p, the invariants I1, I2 of C and J = det F, and their slopes by q.

    Components come first, each an array over the points: a point's small matrices would cost several times as much.
    """

    def __init__(self, strain: Array) -> None:
        parts = np.ascontiguousarray(np.moveaxis(strain, -1, 0))
        parts[[0, 3, 4]] += 1.0
        self._F, self._hoop, self.p = parts[:4], parts[4], parts[5]
        xx, xy, yx, yy = self._F
        hoop = self._hoop
        self._trace, self._det = xx * xx + xy * xy + yx * yx + yy * yy, xx * yy - xy * yx
        self._square = hoop * hoop
        self._cofactor = (yy, -yx, -xy, xx)
        self.i1, self.i2 = self._trace + self._square, self._det * self._det + self._square * self._trace
        self.j = self._det * hoop
        self.g1 = [2 * f for f in self._F] + [2 * hoop]
        det2, square2 = 2 * self._det, 2 * self._square
        self.g2 = [det2 * c + square2 * f for c, f in zip(self._cofactor, self._F, strict=True)]
        self.g2.append(2 * hoop * self._trace)
        self.gj = [hoop * c for c in self._cofactor] + [self._det]

    def curvature(self, f1: Any, f2: Any, fj: Any) -> dict[tuple[int, int], Any]:
        """Entries of ``f1 I1'' + f2 I2'' + fj J''``, the second derivatives by q, in and above the diagonal."""
        f, c, hoop = self._F, self._cofactor, self._hoop
        entries = {(m, n): 2 * f2 * c[m] * c[n] for m in range(4) for n in range(m, 4)}
        for k in range(4):
            entries[k, k] += 2 * f1 + 2 * f2 * self._square
            entries[k, 4] = 4 * f2 * hoop * f[k] + fj * c[k]
        across = 2 * f2 * self._det + fj * hoop
        entries[0, 3] += across
        entries[1, 2] -= across
        entries[4, 4] = 2 * f1 + 2 * f2 * self._trace
        return entries
