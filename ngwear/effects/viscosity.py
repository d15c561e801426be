"""Viscoelasticity: a generalised Maxwell model on the isochoric energy."""

from __future__ import annotations

import math

import ngsolve as ng
import numpy as np

from ngwear.effects.base import Array, Unknowns
from ngwear.effects.memory import Memory, step_factors
from ngwear.errors import SceneError
from ngwear.fields.background_mesh import Background
from ngwear.materials import Hyperelastic, PronySeries


class Viscosity(Memory):
    """Arms ``dQ_i/dt + Q_i / tau_i = gamma_i dS_iso/dt`` besides the long-term energy (finite linear viscoelasticity).

    With S_iso (second Piola, of the long-term isochoric energy) linear over a time step dt the arms integrate
    exactly, for every dt (Simo, Comput. Methods Appl. Mech. Eng. 60 (1987) 153; Taylor, Pister & Goudreau, Int.
    J. Numer. Methods Eng. 2 (1970) 45):

        Q_i1 = E_i Q_i0 + gamma_i a_i (S_1 - S_0),   E_i = exp(-dt/tau_i),   a_i = (1 - E_i) tau_i / dt.

    So a step has the energy ``(sum gamma_i a_i) psi_iso(C) + h : C / 2`` with one known tensor
    ``h = sum (E_i Q_i0 - gamma_i a_i S_0)``, whatever the number of arms. The stored variable is not Q_i but the
    relaxed stress ``q_i = gamma_i S - Q_i``: it is near 0 for a slow arm and near gamma S for a fast one, which makes
    its transfer to another mesh accurate.

    A time step of infinity, as at first, is the long-term equilibrium.

    Parameters
    ----------
    material : Hyperelastic
        Of the long-term behaviour.
    series : PronySeries
    background : Background or None
        Store the history at its points instead of the body's own, so that it can be used with another mesh (``take``).
    """

    def __init__(self, material: Hyperelastic, series: PronySeries, *, background: Background | None = None) -> None:
        super().__init__(material, series)
        self.background = background
        self.time_step = math.inf

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        self.lay(unknowns)
        self._seat = None if self.background is None else unknowns.seat(self.background)
        shape = self.history.shape if self.background is None else (*self.background.shape, 4)
        self.relaxed = np.zeros((len(self.times), *shape))  # q_i [MPa]
        self._start = np.zeros(shape)  # S_0
        self.set_time_step(math.inf)

    def take(self, before: Viscosity) -> None:
        """Take over the history from the term of a body that this one replaces; with the same background and arms."""
        if self.background is None or self.background is not before.background:
            raise SceneError("background", self.background, "memory moves to another mesh by a background of both")
        self.relaxed, self._start = before.relaxed.copy(), before._start.copy()
        self.set_time_step(self.time_step)

    def set_time_step(self, step: float) -> None:
        """Length of the step that is solved next [s], > 0; infinity for the long-term equilibrium."""
        if not step > 0:
            raise SceneError("time step", step, "must be greater than 0 s")
        self.time_step = step
        self._decay, self._mean = step_factors(step, self.times)
        self.share = float(self.ratios @ self._mean)
        history = np.tensordot(self._decay, self.relaxed, axes=1)
        history = -history - float(self.ratios @ (self._mean - self._decay)) * self._start
        self.history = history if self._seat is None else self._seat.at_points(history)

    def commit(self, strain: Array) -> None:
        now = self.second_piola(strain if self._seat is None else self._seat.strain())
        for q, ratio, decay, mean in zip(self.relaxed, self.ratios, self._decay, self._mean, strict=True):
            q *= decay
            q += ratio * ((1 - mean) * now + (mean - decay) * self._start)
        self._start = now
        self.set_time_step(self.time_step)
