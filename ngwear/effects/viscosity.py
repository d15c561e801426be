"""Rubber's memory: a generalised Maxwell model on the isochoric energy."""

from __future__ import annotations

import math

import ngsolve as ng
import numpy as np

from ngwear.effects.base import Array, Unknowns, VolumeTerm
from ngwear.effects.isochoric import Invariants, respond
from ngwear.errors import SceneError
from ngwear.materials import Hyperelastic, PronySeries


class Viscosity(VolumeTerm):
    """Arms ``dQ_i/dt + Q_i / tau_i = gamma_i dS_iso/dt`` besides the long-term energy (finite linear viscoelasticity).

    With S_iso (second Piola, of the long-term isochoric energy) linear over a time step dt the arms integrate
    exactly, for every dt (Simo, Comput. Methods Appl. Mech. Eng. 60 (1987) 153; Taylor, Pister & Goudreau, Int.
    J. Numer. Methods Eng. 2 (1970) 45):

        Q_i1 = E_i Q_i0 + gamma_i a_i (S_1 - S_0),   E_i = exp(-dt/tau_i),   a_i = (1 - E_i) tau_i / dt.

    So a step has the energy ``(sum gamma_i a_i) psi_iso(C) + h : C / 2`` with one known tensor
    ``h = sum (E_i Q_i0 - gamma_i a_i S_0)``, whatever the number of arms. What is kept is not Q_i but what has
    relaxed, ``q_i = gamma_i S - Q_i``: a slow arm has q near 0, a fast one q near gamma S, and neither is hurt by a
    transfer to another mesh.

    A time step of infinity, as at first, is the long-term equilibrium.

    Parameters
    ----------
    material : Hyperelastic
        Of the long-term behaviour.
    series : PronySeries
    """

    def __init__(self, material: Hyperelastic, series: PronySeries) -> None:
        super().__init__()
        self.material, self.series = material, series
        self._ratios, self._times = np.array(series.ratios), np.array(series.times)
        self.time_step = math.inf

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        shape = unknowns.points.volumes.shape
        self.relaxed = np.zeros((len(self._times), *shape, 4))  # q_i: xx, yy, xy, hoop [MPa]
        self._start = np.zeros((*shape, 4))  # S_0
        self.set_time_step(math.inf)

    def set_time_step(self, step: float) -> None:
        """Length of the step that is solved next [s], > 0; infinity for the long-term equilibrium."""
        if not step > 0:
            raise SceneError("time step", step, "must be greater than 0 s")
        self.time_step = step
        self._decay, self._mean = step_factors(step, self._times)
        self.share = float(self._ratios @ self._mean)
        history = np.tensordot(self._decay, self.relaxed, axes=1)
        self._history = -history - float(self._ratios @ (self._mean - self._decay)) * self._start

    def response(self, strain: Array, *, tangent: bool) -> tuple[Array, Array | None]:
        at = Invariants(strain)
        stress, slope = respond(self.material, at, strain, tangent=tangent, by_j=0.0, by_jj=0.0)
        stress *= self.share
        xx, yy, xy, hoop = np.moveaxis(self._history, -1, 0)
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

    def commit(self, strain: Array) -> None:
        now = self._second_piola(strain)
        for q, ratio, decay, mean in zip(self.relaxed, self._ratios, self._decay, self._mean, strict=True):
            q *= decay
            q += ratio * ((1 - mean) * now + (mean - decay) * self._start)
        self._start = now
        self.set_time_step(self.time_step)

    def overstress(self) -> Array:
        """Q_i of the arms at the last committed state, shape (arms, elements, points, 4) [MPa]."""
        return self._ratios[:, None, None, None] * self._start - self.relaxed

    def _second_piola(self, strain: Array) -> Array:
        """S_iso, shape (elements, points, 4)."""
        at = Invariants(strain)
        stress, _ = respond(self.material, at, strain, tangent=False, by_j=0.0, by_jj=0.0)
        p = np.moveaxis(stress, -1, 0)
        xx, xy, yx, yy = at.gradient
        parts = (yy * p[0] - xy * p[2], xx * p[3] - yx * p[1], yy * p[1] - xy * p[3])  # F^-1 P, times the determinant
        return np.stack([*(part / (xx * yy - xy * yx) for part in parts), p[4] / at.hoop], axis=-1)


def step_factors(step: float, times: Array) -> tuple[Array, Array]:
    """``E = exp(-x)`` and ``a = (1 - E) / x`` for x = step / times, exact for x from 0 to infinity."""
    x = step / times
    with np.errstate(invalid="ignore", over="ignore"):
        decay = np.exp(-x)
        mean = np.where(x < 1e-9, 1 - x / 2, -np.expm1(-x) / x)
    return decay, np.where(np.isinf(x), 0.0, mean)
