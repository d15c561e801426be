"""What all terms with memory share: a stress whose history is one known tensor at each material point."""

from __future__ import annotations

import numpy as np

from ngwear.effects.base import Array, Unknowns, VolumeTerm
from ngwear.effects.isochoric import Invariants, respond
from ngwear.materials import Hyperelastic, PronySeries


class Memory(VolumeTerm):
    """Energy ``share psi_iso(C) + h : C / 2`` over the section, with h held fixed in a solve.

    Parameters
    ----------
    material : Hyperelastic
        Of the long-term behaviour.
    series : PronySeries

    Attributes
    ----------
    share : float
        Stiffness that the arms add to the long-term one in a solve [-].
    history : array, shape (elements, points, 4)
        h: xx, yy, xy and hoop [MPa].
    """

    def __init__(self, material: Hyperelastic, series: PronySeries) -> None:
        super().__init__()
        self.material, self.series = material, series
        self.ratios, self.times = np.array(series.ratios), np.array(series.times)
        self.share = 0.0

    def lay(self, unknowns: Unknowns) -> None:
        """Start without a history."""
        self.history = np.zeros((*unknowns.points.volumes.shape, 4))

    def response(self, strain: Array, *, tangent: bool) -> tuple[Array, Array | None]:
        at = Invariants(strain)
        stress, slope = respond(self.material, at, strain, tangent=tangent, by_j=0.0, by_jj=0.0)
        stress *= self.share
        xx, yy, xy, hoop = np.moveaxis(self.history, -1, 0)
        f = at.gradient
        for row in (0, 2):  # F h
            stress[..., row] += xx * f[row] + xy * f[row + 1]
            stress[..., row + 1] += xy * f[row] + yy * f[row + 1]
        stress[..., 4] += hoop * at.hoop
        if slope is not None:
            slope *= self.share
            for row in (0, 2):
                slope[..., row, row] += xx
                slope[..., row + 1, row + 1] += yy
                slope[..., row, row + 1] += xy
                slope[..., row + 1, row] += xy
            slope[..., 4, 4] += hoop
        return stress, slope

    def second_piola(self, strain: Array) -> Array:
        """Isochoric second Piola stress of the long-term energy, shape (..., 4) [MPa]."""
        at = Invariants(strain)
        stress, _ = respond(self.material, at, strain, tangent=False, by_j=0.0, by_jj=0.0)
        p = np.moveaxis(stress, -1, 0)
        xx, xy, yx, yy = at.gradient
        parts = (yy * p[0] - xy * p[2], xx * p[3] - yx * p[1], yy * p[1] - xy * p[3])  # F^-1 P, times the determinant
        return np.stack([*(part / (xx * yy - xy * yx) for part in parts), p[4] / at.hoop], axis=-1)


def step_factors(step: Array | float, times: Array) -> tuple[Array, Array]:
    """``E = exp(-x)`` and ``a = (1 - E) / x`` for x = step / times, exact for x from 0 to infinity."""
    x = step / times
    with np.errstate(invalid="ignore", over="ignore"):
        decay = np.exp(-x)
        mean = np.where(x < 1e-9, 1 - x / 2, -np.expm1(-x) / x)
    return decay, np.where(np.isinf(x), 0.0, mean)
