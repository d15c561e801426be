"""Base class of viscoelastic terms: the history is one known tensor at each material point."""

from __future__ import annotations

import numpy as np

from ngwear.effects.base import Array, Unknowns, VolumeTerm
from ngwear.effects.invariants import Invariants
from ngwear.effects.isochoric import respond
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
    history : array, shape (elements, points, 4 or 6)
        h [MPa]: xx, yy, xy and hoop of a section; xx, yy, zz, xy, xz and yz of a solid.
    """

    def __init__(self, material: Hyperelastic, series: PronySeries) -> None:
        super().__init__()
        self.material, self.series = material, series
        self.ratios, self.times = np.array(series.ratios), np.array(series.times)
        self.share = 0.0

    def lay(self, unknowns: Unknowns) -> None:
        """Place the history at the material points, with the value 0."""
        self.history = np.zeros((*unknowns.points.volumes.shape, 4 if unknowns.body.mesh.dim == 2 else 6))

    def response(self, strain: Array, *, tangent: bool) -> tuple[Array, Array | None]:
        at = Invariants.of(strain)
        stress, slope = respond(self.material, at, strain, tangent=tangent, by_j=0.0, by_jj=0.0)
        stress *= self.share
        for m, part in enumerate(at.push(self.history)):
            stress[..., m] += part
        if slope is not None:
            slope *= self.share
            for (m, n), part in at.metric(self.history).items():
                slope[..., m, n] += part
                if m != n:
                    slope[..., n, m] += part
        return stress, slope

    def second_piola(self, strain: Array) -> Array:
        """Isochoric second Piola stress of the long-term energy; the shape of a history [MPa]."""
        at = Invariants.of(strain)
        stress, _ = respond(self.material, at, strain, tangent=False, by_j=0.0, by_jj=0.0)
        return at.pull(stress)


def step_factors(step: Array | float, times: Array) -> tuple[Array, Array]:
    """``E = exp(-x)`` and ``a = (1 - E) / x`` for x = step / times, exact for x from 0 to infinity."""
    x = step / times
    with np.errstate(invalid="ignore", over="ignore"):
        decay = np.exp(-x)
        mean = np.where(x < 1e-9, 1 - x / 2, -np.expm1(-x) / x)
    return decay, np.where(np.isinf(x), 0.0, mean)
