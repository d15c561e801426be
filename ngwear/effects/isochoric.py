"""Stress and tangent of an isochoric energy at many points at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.invariants import Invariants
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

    ``by_j`` and ``by_jj`` are the derivatives of g. Shapes (..., n + 1) and
    (..., n + 1, n + 1), not a number where J <= 0.
    """
    i1, i2, j, gj = at.i1, at.i2, at.j, at.gj
    with np.errstate(invalid="ignore", divide="ignore"):  # not a number where J <= 0: the solver sees it
        a = j ** (-2 / 3)
        a_j, b_j = -2 / 3 * a / j, -4 / 3 * a * a / j
    d1, d2, d11, d12, d22 = material.isochoric_slopes(a * i1, a * a * i2)
    # By the chain rule: psi depends on I1, I2 and J with the slopes f1, f2 and fj.
    f1, f2, fj = d1 * a, d2 * a * a, d1 * a_j * i1 + d2 * b_j * i2 + by_j
    stress = np.empty_like(strain)
    components = range(len(gj))
    for k in components:
        stress[..., k] = f1 * at.g1[k] + f2 * at.g2[k] + fj * gj[k]
    stress[..., -1] = 0.0
    if not tangent:
        return stress, None
    # Second derivatives: products of slopes here, the invariants' own second derivatives after.
    twice = (f1 * 10 / 9 * i1 + f2 * 28 / 9 * i2) / (j * j) + by_jj
    mixed = [d1 * a_j * at.g1[k] + d2 * b_j * at.g2[k] + 0.5 * twice * gj[k] for k in components]
    size = strain.shape[-1]
    slope = np.moveaxis(np.zeros((size, size, *strain.shape[:-1])), (0, 1), (-2, -1))  # components apart in memory
    own = at.curvature(f1, f2, fj)
    curved = np.any(d11) or np.any(d12) or np.any(d22)
    b1 = [a * at.g1[k] + a_j * i1 * gj[k] for k in components] if curved else []
    b2 = [a * a * at.g2[k] + b_j * i2 * gj[k] for k in components] if curved else []
    for m in components:
        for n in components[m:]:
            entry = mixed[m] * gj[n] + mixed[n] * gj[m] + own.get((m, n), 0.0)
            if curved:
                entry += d11 * b1[m] * b1[n] + d12 * (b1[m] * b2[n] + b2[m] * b1[n]) + d22 * b2[m] * b2[n]
            slope[..., m, n] = slope[..., n, m] = entry
    return stress, slope
