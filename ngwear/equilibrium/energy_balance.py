"""Energy balance of a run in time: stored in the long-term rubber, stored in the Maxwell arms, turned into heat."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.elasticity import Elasticity
from ngwear.effects.invariants import Invariants
from ngwear.effects.viscosity import Viscosity
from ngwear.equilibrium.problem import Problem
from ngwear.errors import SceneError

Array = NDArray[np.float64]
# The trapezoid errs by x²/12, the exact integral by rounding over x² or so: both by about 1e-9 to 1e-8 here.
SHORT = 1e-4  # of a relaxation time: below, the exact integral over a step loses more digits than the trapezoid


class EnergyBook:
    """Energies of a problem with elasticity and memory, in mJ (mJ/mm in plane strain).

    The external work is ``work = elastic + arms + heat``, from a start at rest. An arm of the
    shear modulus ``gamma_i G`` under the Kirchhoff stress ``T = dev(F Q_i F^T)`` stores ``T : T / (4 gamma_i G)`` and
    turns ``T : T / (2 gamma_i G tau_i)`` a second into heat. Both hold at small strain; finite linear viscoelasticity
    has no closed form (Holzapfel, *Nonlinear Solid Mechanics*, 2000, section 6.10; ``ngwear verify memory``: the
    balance has an error of 2 % of the work at a strain of 20 %). The work of friction is not included: it is
    ``FullSliding.force`` times the distance.

    Parameters
    ----------
    problem : Problem
    elasticity : Elasticity
    memory : Viscosity
        With its history at the problem's own points.

    Attributes
    ----------
    heat : float
        Heat since this object was made.
    """

    def __init__(self, problem: Problem, elasticity: Elasticity, memory: Viscosity) -> None:
        if memory.background is not None:
            raise SceneError("memory", memory.background, "the energy balance needs a memory without background")
        self.problem, self.elasticity, self.memory = problem, elasticity, memory
        self.heat = 0.0
        self._overstress = self._look()

    def add(self) -> None:
        """Add the step that was accepted last; call it after each step (``advance(..., on_step=...)``)."""
        before, after = self._overstress, self._look()
        step, memory = self.memory.time_step, self.memory
        for start, end, ratio, time in zip(before, after, memory.ratios, memory.times, strict=True):
            self.heat += self._squared(start, end, step, time) / (2 * ratio * memory.material.shear_modulus * time)
        self._overstress = after

    @property
    def elastic(self) -> float:
        """Energy of the long-term rubber."""
        return float((self.problem.points.volumes * self.elasticity.energy(self._strain())).sum())

    @property
    def arms(self) -> float:
        """Energy of the arms' springs."""
        stiffness = 4 * self.memory.ratios * self.memory.material.shear_modulus
        return sum(self._integral(q, q) / k for q, k in zip(self._overstress, stiffness, strict=True))

    def _strain(self) -> Array:
        return self.problem.points.strain(self.problem.state.vec.FV().NumPy())

    def _look(self) -> Array:
        """Present T of each arm as F^T T F^-T, shape (arms, elements, points, 3, 3) [MPa]."""
        strain = self._strain()
        stress, stretching = self.memory.second_piola(strain), Invariants.of(strain).stretching
        overstress = self.memory.ratios[:, None, None, None] * stress - self.memory.relaxed
        mixed = _matrix(stretching, 0.5) @ _matrix(overstress, 1.0)
        return mixed - np.trace(mixed, axis1=-2, axis2=-1)[..., None, None] * np.eye(3) / 3

    def _integral(self, a: Array, b: Array) -> float:
        """``int T_a : T_b dV``."""
        return float((self.problem.points.volumes * np.einsum("...ij,...ji", a, b)).sum())

    def _squared(self, start: Array, end: Array, step: float, time: float) -> float:
        """``int int T : T dV dt`` over a step, in which T tends from its start to a limit with the arm's time."""
        if step < SHORT * time:
            return 0.5 * step * (self._integral(start, start) + self._integral(end, end))
        once, twice = -np.expm1(-step / time), -np.expm1(-2 * step / time)
        limit = (end - (1 - once) * start) / once
        away = start - limit
        total = 2 * time * once * self._integral(limit, away) + 0.5 * time * twice * self._integral(away, away)
        # In a step without end the limit is zero.
        return total + (step * self._integral(limit, limit) if np.isfinite(step) else 0.0)


def _matrix(symmetric: Array, off: float) -> Array:
    """Components (xx, yy, xy, hoop) or (xx, yy, zz, xy, xz, yz) as matrices; ``off`` times those off the diagonal."""
    parts = np.moveaxis(symmetric, -1, 0)
    out = np.zeros((*symmetric.shape[:-1], 3, 3))
    diagonal = (0, 1, 3) if len(parts) == 4 else (0, 1, 2)
    for k, part in enumerate(diagonal):
        out[..., k, k] = parts[part]
    beside = {(0, 1): 2} if len(parts) == 4 else {(0, 1): 3, (0, 2): 4, (1, 2): 5}
    for (i, j), part in beside.items():
        out[..., i, j] = out[..., j, i] = off * parts[part]
    return out
