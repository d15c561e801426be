"""Stress and tangent of an isochoric energy at many points at once."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ngwear.materials import Hyperelastic

Array = NDArray[np.float64]


def isochoric_energy(material: Hyperelastic, at: Invariants) -> Array:
    """psi_iso per reference volume [MPa]."""
    with np.errstate(invalid="ignore"):
        scale = at.j ** (-2 / 3)
    return material.isochoric_energy(scale * at.i1, scale * scale * at.i2)


def respond(
    material: Hyperelastic, at: Invariants, strain: Array, *, tangent: bool, by_j: Array | float, by_jj: float
) -> tuple[Array, Array | None]:
    """First and second derivatives of ``psi_iso + g(J)`` by the strain; those by p are left at zero.

    ``by_j`` and ``by_jj`` are the derivatives of g. Shapes (..., 6) and (..., 6, 6), not a number where J <= 0.
    """
    i1, i2, j, gj = at.i1, at.i2, at.j, at.gj
    with np.errstate(invalid="ignore", divide="ignore"):  # not a number where J <= 0: the solver sees it
        a = j ** (-2 / 3)
        a_j, b_j = -2 / 3 * a / j, -4 / 3 * a * a / j
    d1, d2, d11, d12, d22 = material.isochoric_slopes(a * i1, a * a * i2)
    # By the chain rule: psi depends on I1, I2 and J with the slopes f1, f2 and fj.
    f1, f2, fj = d1 * a, d2 * a * a, d1 * a_j * i1 + d2 * b_j * i2 + by_j
    stress = np.empty_like(strain)
    for k in range(5):
        stress[..., k] = f1 * at.g1[k] + f2 * at.g2[k] + fj * gj[k]
    stress[..., 5] = 0.0
    if not tangent:
        return stress, None
    # Second derivatives: products of slopes here, the invariants' own second derivatives after.
    twice = (f1 * 10 / 9 * i1 + f2 * 28 / 9 * i2) / (j * j) + by_jj
    mixed = [d1 * a_j * at.g1[k] + d2 * b_j * at.g2[k] + 0.5 * twice * gj[k] for k in range(5)]
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
    return stress, slope


class Invariants:
    """``q = (F_xx, F_xy, F_yx, F_yy, hoop)``, p, the invariants I1, I2 of C and J = det F, and their slopes by q.

    Components come first, each an array over the points: a point's small matrices would cost several times as much.
    """

    def __init__(self, strain: Array) -> None:
        parts = np.ascontiguousarray(np.moveaxis(strain, -1, 0))
        parts[[0, 3, 4]] += 1.0
        self.gradient, self.hoop, self.p = parts[:4], parts[4], parts[5]
        xx, xy, yx, yy = self.gradient
        hoop = self.hoop
        self._trace, self._det = xx * xx + xy * xy + yx * yx + yy * yy, xx * yy - xy * yx
        self._square = hoop * hoop
        self._cofactor = (yy, -yx, -xy, xx)
        self.i1, self.i2 = self._trace + self._square, self._det * self._det + self._square * self._trace
        self.j = self._det * hoop
        self.g1 = [2 * f for f in self.gradient] + [2 * hoop]
        det2, square2 = 2 * self._det, 2 * self._square
        self.g2 = [det2 * c + square2 * f for c, f in zip(self._cofactor, self.gradient, strict=True)]
        self.g2.append(2 * hoop * self._trace)
        self.gj = [hoop * c for c in self._cofactor] + [self._det]

    def curvature(self, f1: Any, f2: Any, fj: Any) -> dict[tuple[int, int], Any]:
        """Entries of ``f1 I1'' + f2 I2'' + fj J''``, the second derivatives by q, in and above the diagonal."""
        f, c, hoop = self.gradient, self._cofactor, self.hoop
        entries = {(m, n): 2 * f2 * c[m] * c[n] for m in range(4) for n in range(m, 4)}
        for k in range(4):
            entries[k, k] += 2 * f1 + 2 * f2 * self._square
            entries[k, 4] = 4 * f2 * hoop * f[k] + fj * c[k]
        across = 2 * f2 * self._det + fj * hoop
        entries[0, 3] += across
        entries[1, 2] -= across
        entries[4, 4] = 2 * f1 + 2 * f2 * self._trace
        return entries
