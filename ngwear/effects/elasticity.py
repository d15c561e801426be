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
        _, p, (i1, i2, j), _ = _invariants(strain)
        pointwise, rest = self.split
        with np.errstate(invalid="ignore"):
            scale = j ** (-2 / 3)
        psi = self.material.isochoric_energy(scale * i1, scale * scale * i2)
        return psi + (j - 1) * (pointwise / 2 * (j - 1) + p) - p * p / (2 * rest)

    def response(self, strain: Array, *, tangent: bool) -> tuple[Array, Array | None]:
        q, p, (i1, i2, j), (g1, g2, gj) = _invariants(strain)
        pointwise, rest = self.split
        with np.errstate(invalid="ignore", divide="ignore"):  # not a number where J <= 0: the solver sees it
            a = j ** (-2 / 3)
            a_j, b_j = -2 / 3 * a / j, -4 / 3 * a * a / j
        d1, d2, d11, d12, d22 = self.material.isochoric_slopes(a * i1, a * a * i2)
        b1 = _times(a, g1) + _times(a_j * i1, gj)  # slopes of the isochoric invariants
        b2 = _times(a * a, g2) + _times(b_j * i2, gj)
        volumetric = pointwise * (j - 1) + p
        stress = np.empty_like(strain)
        stress[..., :5] = _times(d1, b1) + _times(d2, b2) + _times(volumetric, gj)
        stress[..., 5] = j - 1 - p / rest
        if not tangent:
            return stress, None
        # The second derivative: products of slopes, then the slopes times the invariants' own second derivatives.
        by_j = d1 * a_j * i1 + d2 * b_j * i2 + volumetric
        by_jj = (d1 * a * 10 / 9 * i1 + d2 * a * a * 28 / 9 * i2) / (j * j) + pointwise
        mixed = _times(d1 * a_j, g1) + _times(d2 * b_j, g2) + _times(0.5 * by_jj, gj)
        half = mixed[..., :, None] * gj[..., None, :]
        if np.any(d11) or np.any(d12) or np.any(d22):
            half += (_times(0.5 * d11, b1) + _times(d12, b2))[..., :, None] * b1[..., None, :]
            half += _times(0.5 * d22, b2)[..., :, None] * b2[..., None, :]
        slope = np.zeros((*strain.shape, strain.shape[-1]))
        slope[..., :5, :5] = half + half.swapaxes(-1, -2)
        _add_curvature(slope, q, d1 * a, d2 * a * a, by_j)
        slope[..., :5, 5] = slope[..., 5, :5] = gj
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


def _times(scale: Any, vectors: Array) -> Array:
    return np.asarray(scale)[..., None] * vectors


def _invariants(strain: Array) -> tuple[Array, Array, tuple[Array, Array, Array], tuple[Array, Array, Array]]:
    """``q = (F_xx, F_xy, F_yx, F_yy, hoop)``, p, the invariants I1, I2 of C and J = det F, and their slopes by q."""
    q = strain[..., :5] + np.array([1.0, 0.0, 0.0, 1.0, 1.0])
    hoop, trace, det, cofactor = _in_plane(q)
    square = hoop * hoop
    g2, gj = np.empty_like(q), np.empty_like(q)
    g2[..., :4] = _times(2 * det, cofactor) + _times(2 * square, q[..., :4])
    g2[..., 4] = 2 * hoop * trace
    gj[..., :4], gj[..., 4] = _times(hoop, cofactor), det
    return q, strain[..., 5], (trace + square, det * det + square * trace, det * hoop), (2 * q, g2, gj)


def _in_plane(q: Array) -> tuple[Array, Array, Array, Array]:
    """Hoop stretch; trace of C, determinant and cofactor (xx, xy, yx, yy) of F in the section's plane."""
    xx, xy, yx, yy, hoop = np.moveaxis(q, -1, 0)
    cofactor = np.stack([yy, -yx, -xy, xx], axis=-1)
    return hoop, xx * xx + xy * xy + yx * yx + yy * yy, xx * yy - xy * yx, cofactor


def _add_curvature(slope: Array, q: Array, f1: Any, f2: Any, fj: Array) -> None:
    """Add ``f1 I1'' + f2 I2'' + fj J''``, the second derivatives by q, to the tangents."""
    hoop, trace, det, cofactor = _in_plane(q)
    slope[..., :4, :4] += _times(2 * f2, cofactor)[..., :, None] * cofactor[..., None, :]
    for k in range(4):
        slope[..., k, k] += 2 * f1 + 2 * f2 * hoop * hoop
    across = 2 * f2 * det + fj * hoop
    for i, j, sign in ((0, 3, 1.0), (1, 2, -1.0)):
        slope[..., i, j] += sign * across
        slope[..., j, i] += sign * across
    out = _times(4 * f2 * hoop, q[..., :4]) + _times(fj, cofactor)
    slope[..., :4, 4] += out
    slope[..., 4, :4] += out
    slope[..., 4, 4] += 2 * f1 + 2 * f2 * trace
