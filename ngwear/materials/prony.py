"""Generalised Maxwell model (Prony series), relative to the long-term stiffness."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import SceneError, check_fields

Array = NDArray[np.float64]
MOST_ARMS = 40  # two a decade over twenty decades: the whole of the glass transition


@dataclass(frozen=True)
class PronySeries:
    """``G(t) / G_inf = 1 + sum_i gamma_i exp(-t / tau_i)``: a spring and n Maxwell arms in parallel.

    The same ratios apply to the whole isochoric stress of a hyperelastic model (finite linear viscoelasticity:
    Simo, Comput. Methods Appl. Mech. Eng. 60 (1987) 153; Holzapfel, *Nonlinear Solid Mechanics*, 2000,
    section 6.10). Volume changes stay elastic. The model neglects that the loss of filled rubber depends on the
    amplitude (Payne effect).

    Parameters
    ----------
    ratios : tuple of float
        gamma_i = G_i / G_inf [-], > 0: relative to the **long-term** modulus.
    times : tuple of float
        Relaxation times tau_i [s], > 0, rising.

    Raises
    ------
    SceneError
        For a ratio or time that is not positive, two equal times, or more than 40 arms.

    Examples
    --------
    >>> arms = PronySeries.from_shares([0.5], [1.0])  # half of the instantaneous stiffness relaxes
    >>> arms.ratios, arms.instantaneous
    ((1.0,), 2.0)
    """

    ratios: tuple[float, ...]
    times: tuple[float, ...]

    def __post_init__(self) -> None:
        check_fields(self, "material.prony")
        if len(self.ratios) != len(self.times):
            raise SceneError("material.prony", (len(self.ratios), len(self.times)), "give one modulus for each time")
        if len(self.times) > MOST_ARMS:
            raise SceneError("material.prony", len(self.times), f"take at most {MOST_ARMS} arms: two a decade suffice")
        for name, values in (("moduli", self.ratios), ("times", self.times)):
            for value in values:
                if not 0 < value < math.inf:
                    raise SceneError(f"material.prony.{name}", value, "must be finite and greater than 0")
        for a, b in pairwise(self.times):
            if not a < b:
                what = "is given twice: add up the two moduli" if a == b else "stands after a longer one: sort the arms"
                raise SceneError("material.prony.times", b, what)

    @classmethod
    def from_moduli(cls, moduli: Sequence[float], times: Sequence[float], *, long_term: float) -> PronySeries:
        """Series from absolute moduli, shear or uniaxial, and the long-term modulus of the same kind [MPa]."""
        if not 0 < long_term < math.inf:
            raise SceneError("material.prony.long_term", long_term, "must be finite and greater than 0 MPa")
        return cls(tuple(m / long_term for m in moduli), tuple(times))

    @classmethod
    def from_shares(cls, shares: Sequence[float], times: Sequence[float]) -> PronySeries:
        """Series from shares g_i = G_i / G_0 of the **instantaneous** modulus, as in many programs; sum < 1."""
        rest = 1 - sum(shares)
        if not rest > 0:
            raise SceneError(
                "material.prony.moduli",
                list(shares),
                f"shares of the instantaneous modulus add up to {sum(shares):.6g}; they must stay below 1",
            )
        return cls(tuple(s / rest for s in shares), tuple(times))

    @property
    def instantaneous(self) -> float:
        """G_0 / G_inf [-]."""
        return 1 + sum(self.ratios)

    def relaxation(self, time: Any) -> Array:
        """``G(t) / G_inf`` at times [s]; the shape of ``time``."""
        t = np.asarray(time, dtype=float)[..., None]
        return 1 + (np.array(self.ratios) * np.exp(-t / np.array(self.times))).sum(axis=-1)

    def creep(self, time: Any) -> Array:
        """``J(t) G_inf``: strain under a constant small stress over the long-term strain [-].

        Poles and residues of ``1 / (s G(s))``; exact for any number of arms.
        """
        ratios, times = np.array(self.ratios), np.array(self.times)
        # s G(s) = 1 + sum gamma s tau / (1 + s tau) has its zeros -1/r between the poles -1/tau, by interlacing the
        # eigenvalues of a diagonal and a rank-one matrix: diag(1/tau) (I - g g^T / G_0).
        weight = np.sqrt(ratios / self.instantaneous)
        root = 1 / np.sqrt(times)
        matrix = root[:, None] * (np.eye(len(times)) - np.outer(weight, weight)) * root[None, :]
        rates, vectors = np.linalg.eigh(matrix)
        share = (vectors.T @ (root * weight)) ** 2 / rates / self.instantaneous
        t = np.asarray(time, dtype=float)[..., None]
        return 1 / self.instantaneous + (share * -np.expm1(-rates * t)).sum(axis=-1)

    def storage(self, frequency: Any) -> Array:
        """``G'(f) / G_inf`` at frequencies f [Hz]."""
        return 1 + self._sum(frequency, 2)

    def loss(self, frequency: Any) -> Array:
        """``G''(f) / G_inf`` at frequencies f [Hz]."""
        return self._sum(frequency, 1)

    def tan_delta(self, frequency: Any) -> Array:
        """Loss factor ``G'' / G'`` at frequencies f [Hz]."""
        return self.loss(frequency) / self.storage(frequency)

    def _sum(self, frequency: Any, power: int) -> Array:
        x = 2 * np.pi * np.asarray(frequency, dtype=float)[..., None] * np.array(self.times)
        return (np.array(self.ratios) * x**power / (1 + x * x)).sum(axis=-1)

    def shifted(self, factor: float) -> PronySeries:
        """All times multiplied by the factor a_T of a time-temperature shift."""
        return PronySeries(self.ratios, tuple(factor * t for t in self.times))

    def folded(self, *, shortest: float, longest: float, tolerance: float = 1e-3) -> Folding:
        """Leave out relaxation times that are too fast or too slow for a simulation between two times.

        An arm with ``tau << shortest`` (fast) relaxes at once and is dropped: the error of stress is at most ``gamma
        tau / shortest`` for processes no faster than ``shortest``. An arm with ``tau >> longest`` (slow) does not relax
        within the simulation and becomes part of the elastic stiffness: the error is at most ``gamma longest / tau``.
        Arms are left out in the order of these bounds, as long as their sum stays below ``tolerance`` times the
        stiffness ``G(longest)``.

        Parameters
        ----------
        shortest : float
            Duration of the fastest process to resolve [s], e.g. the time in which an asperity passes, divided by 2 pi.
        longest : float
            Duration of the whole simulation [s].
        tolerance : float
            Allowed error of stress [-].
        """
        if not 0 < shortest <= longest:
            raise SceneError("time window", (shortest, longest), "the shortest time must be above 0, below the longest")
        ratios, times = np.array(self.ratios), np.array(self.times)
        gone, spring = ratios * times / shortest, ratios * longest / times
        bound = np.minimum(gone, spring)
        allowed = tolerance * float(self.relaxation(longest))
        order = np.argsort(bound, kind="stable")
        fold = np.zeros(len(times), dtype=bool)
        fold[order[np.cumsum(bound[order]) <= allowed]] = True
        slow, fast = fold & (spring < gone), fold & (spring >= gone)
        elastic = 1 + float(ratios[slow].sum())
        kept = ~fold
        return Folding(
            PronySeries(tuple((ratios[kept] / elastic).tolist()), tuple(times[kept].tolist())),
            elastic,
            tuple(times[fast].tolist()),
            tuple(times[slow].tolist()),
            float(bound[fold].sum() / self.relaxation(longest)),
        )


@dataclass(frozen=True)
class Folding:
    """Result of ``PronySeries.folded``: which relaxation times are kept and which are left out.

    Attributes
    ----------
    kept : PronySeries
        Arms that are solved, relative to the long-term stiffness times ``stiffening``.
    stiffening : float
        Factor on the long-term moduli, which adds the stiffness of the slow arms [-].
    fast, slow : tuple of float
        Relaxation times left out [s]: fast ones relax at once, slow ones are part of the elastic stiffness.
    bound : float
        Bound of the error of stress, relative to the stress after ``longest`` at the same strain [-].
    """

    kept: PronySeries
    stiffening: float
    fast: tuple[float, ...]
    slow: tuple[float, ...]
    bound: float

    def fate(self, time: float) -> str:
        """How a relaxation time [s] is treated, in words."""
        if time in self.fast:
            return "left out: it relaxes at once"
        return "part of the elastic stiffness: it does not relax in this time" if time in self.slow else "kept"
