"""Fit material constants to laboratory tables; each fit states its error against the data."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares, minimize_scalar, nnls

from ngwear.errors import SceneError
from ngwear.materials.measurements import Dma, Relaxation, Tension
from ngwear.materials.mooney_rivlin import MooneyRivlin
from ngwear.materials.prony import MOST_ARMS, PronySeries
from ngwear.materials.shift import WLF

Array = NDArray[np.float64]
PER_DECADE = (0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.3, 1.6)  # arms tried; more overlap: a peak is over a decade wide
NOTABLE = 0.9  # a misfit is as good as the best if the best is above this share of it: no arms for less


class PoorFitWarning(UserWarning):
    """The fit misses the requested tolerance; the best fit is returned nevertheless."""


@dataclass(frozen=True)
class PronyFit:
    """Fitted Prony series, long-term modulus, and the errors against the data.

    Attributes
    ----------
    series : PronySeries
    long_term : float
        Long-term modulus, shear or uniaxial as the data [MPa].
    data : Dma or Relaxation
    misfit : float
        Root mean square of the relative errors, of both moduli for DMA [-].
    largest : float
        Largest relative error [-].
    """

    series: PronySeries
    long_term: float
    data: Dma | Relaxation
    misfit: float
    largest: float


@dataclass(frozen=True)
class TensionFit:
    """Fitted Mooney-Rivlin model and its relative errors against the tension data: root mean square and largest [-]."""

    material: MooneyRivlin
    data: Tension
    misfit: float
    largest: float


@dataclass(frozen=True)
class ShiftFit:
    """Fitted WLF constants, and the shift factor of each curve.

    Attributes
    ----------
    shift : WLF
    temperatures, factors : array, shape (n,)
        Temperatures [K] and the factors a_T [-] found by shifting, before the law is fitted.
    misfit : float
        Root mean square of the difference of log10 a_T between factors and law [-].
    master : Dma
        Master curve: all curves shifted to the reference temperature, sorted by frequency.
    """

    shift: WLF
    temperatures: Array
    factors: Array
    misfit: float
    master: Dma


def fit_dma(data: Dma, *, arms: int | Sequence[float] | None = None, tolerance: float = 0.03) -> PronyFit:
    """Fit a Prony series to a DMA table by non-negative least squares on the relative errors of both moduli.

    A fit to the storage modulus alone gives a wrong loss factor, and so a wrong hysteresis friction.

    Parameters
    ----------
    data : Dma
    arms : int, sequence of float, or None
        Number of Maxwell arms, or their relaxation times [s]. By default the fewest arms whose misfit is as small as
        that of the best fit with up to 1.6 arms per decade, or below a tenth of ``tolerance``.
    tolerance : float
        Root mean square of the relative errors to reach [-].

    Warns
    -----
    PoorFitWarning
        If the best fit misses the tolerance.
    """
    omega = 2 * np.pi * data.frequency

    def columns(times: Array) -> tuple[Array, Array]:
        x = omega[:, None] * times
        spring = np.concatenate([1 / data.storage, np.zeros(len(omega))])
        both = np.concatenate([x * x / (1 + x * x) / data.storage[:, None], x / (1 + x * x) / data.storage[:, None]])
        # Errors of the loss count relative to itself, but no less than a hundredth of the storage.
        scale = data.storage / np.maximum(data.loss, 0.01 * data.storage)
        both[len(omega) :] *= scale[:, None]
        return np.column_stack([spring, both]), np.concatenate([np.ones(len(omega)), data.loss / data.storage * scale])

    return _fit(data, columns, 1 / omega.max(), 1 / omega.min(), arms, tolerance)


def fit_relaxation(data: Relaxation, *, arms: int | Sequence[float] | None = None, tolerance: float = 0.02) -> PronyFit:
    """Fit a Prony series to a relaxation test by its relative errors; parameters and warning as in ``fit_dma``."""

    def columns(times: Array) -> tuple[Array, Array]:
        decay = np.exp(-data.time[:, None] / times) / data.modulus[:, None]
        return np.column_stack([1 / data.modulus, decay]), np.ones(len(data.time))

    return _fit(data, columns, float(data.time.min()), float(data.time.max()), arms, tolerance)


def _fit(data: Any, columns: Any, shortest: float, longest: float, arms: Any, tolerance: float) -> PronyFit:
    if arms is not None and not isinstance(arms, int):
        found = _solve(columns, np.asarray(arms, dtype=float))
    elif arms is not None:
        if not 1 <= arms <= MOST_ARMS:
            raise SceneError("arms", arms, f"must lie between 1 and {MOST_ARMS}")
        found = _refined(columns, _spread(shortest, longest, arms))
    else:
        decades = np.log10(longest / shortest)
        counts = sorted({min(MOST_ARMS, max(1, round(decades * n))) for n in PER_DECADE})
        tried = [_refined(columns, _spread(shortest, longest, count)) for count in counts]
        enough = max(tolerance / 10, min(t[2] for t in tried) / NOTABLE)
        found = next(t for t in tried if t[2] <= enough)
    moduli, times, misfit, largest = found
    if not moduli[0] > 0:
        raise SceneError(
            "long-term modulus",
            float(moduli[0]),
            "the data reach no plateau, so that the fitted long-term modulus is zero: measure at longer times "
            "or lower frequencies",
        )
    if not (moduli[1:] > 0).any():
        raise SceneError("arms", len(times), "the data show no relaxation: use the hyperelastic model alone")
    if misfit > tolerance:
        warnings.warn(
            f"the fit's root mean square error is {misfit:.2%}, more than the {tolerance:.2%} asked for: "
            "noise, units, or more arms than were allowed?",
            PoorFitWarning,
            stacklevel=3,
        )
    used = moduli[1:] > 0
    series = PronySeries.from_moduli(moduli[1:][used].tolist(), times[used].tolist(), long_term=float(moduli[0]))
    return PronyFit(series, float(moduli[0]), data, misfit, largest)


def _spread(shortest: float, longest: float, count: int) -> Array:
    return np.geomspace(shortest, longest, count) if count > 1 else np.array([np.sqrt(shortest * longest)])


def _solve(columns: Any, times: Array) -> tuple[Array, Array, float, float]:
    """Moduli (spring first), times, misfit and largest error."""
    matrix, goal = columns(times)
    moduli, _ = nnls(matrix, goal)
    moduli[moduli < 1e-6 * moduli.sum()] = 0.0  # rounding
    error = np.abs(matrix @ moduli - goal)
    return moduli, times, float(np.sqrt(np.mean(error**2))), float(error.max())


def _refined(columns: Any, times: Array) -> tuple[Array, Array, float, float]:
    """Like ``_solve``, but the times are fitted too (variable projection: moduli follow by least squares)."""

    def errors(logs: Array) -> Array:
        matrix, goal = columns(np.exp(logs))
        return matrix @ nnls(matrix, goal)[0] - goal

    start = np.log(times)
    reach = np.log(10.0)
    found = least_squares(errors, start, bounds=(start[0] - reach, start[-1] + reach), max_nfev=60)
    moved = np.exp(np.sort(found.x))
    apart = np.concatenate([[True], np.diff(moved) > 1e-3 * moved[1:]])
    return min(_solve(columns, moved[apart]), _solve(columns, times), key=lambda s: s[2])


def fit_tension(data: Tension, *, bulk_ratio: float = 1000.0, tolerance: float = 0.05) -> TensionFit:
    """Fit Mooney-Rivlin to uniaxial tension, ``P = 2 (lambda - lambda^-2) (C10 + C01 / lambda)``, by relative errors.

    C01 is at least 0: tension alone determines it poorly, and a negative C01 is unstable in compression.

    Parameters
    ----------
    data : Tension
    bulk_ratio : float
        K / G [-]; a tension test does not determine it.
    tolerance : float
        Root mean square of the relative error above which a ``PoorFitWarning`` is given [-].
    """
    apart = np.abs(data.stretch - 1) > 1e-3
    stretch, stress = data.stretch[apart], data.stress[apart]
    strain = 2 * (stretch - stretch**-2.0)
    matrix = np.column_stack([strain / stress, strain / stretch / stress])
    (c10, c01), _ = nnls(matrix, np.ones(len(stress)))
    if not c10 > 0:
        raise SceneError("stress [MPa]", float(stress[-1]), "the data soften more than Mooney-Rivlin can: C10 = 0")
    error = np.abs(matrix @ [c10, c01] - 1)
    misfit = float(np.sqrt(np.mean(error**2)))
    if misfit > tolerance:
        warnings.warn(
            f"Mooney-Rivlin misses the data by {misfit:.1%} (root mean square), more than {tolerance:.1%}: it has no "
            "upturn at large stretch; leave out what lies beyond the stretches of use",
            PoorFitWarning,
            stacklevel=2,
        )
    bulk = bulk_ratio * 2 * (c10 + c01)
    return TensionFit(MooneyRivlin(c10=c10, c01=c01, bulk_modulus=bulk), data, misfit, float(error.max()))


def fit_wlf(curves: Sequence[Dma], *, reference: float) -> ShiftFit:
    """WLF constants from DMA curves at several temperatures.

    Each curve is shifted along log f until storage modulus and loss factor meet those of its neighbour, from the
    reference outwards; the law is then fitted to the factors, ``-(T - T_r) / log10 a_T = (C2 + T - T_r) / C1``.

    Parameters
    ----------
    curves : sequence of Dma
        At three or more temperatures, one of them the reference.
    reference : float
        T_r [K].
    """
    known = sorted(((c.temperature, c) for c in curves if c.temperature is not None), key=lambda pair: pair[0])
    if len(known) < len(curves):
        raise SceneError("temperature", None, "every curve needs its temperature [K]")
    ordered = [c for _, c in known]
    temperatures = np.array([temperature for temperature, _ in known])
    home = int(np.argmin(np.abs(temperatures - reference)))
    if abs(temperatures[home] - reference) > 0.5 or len(set(temperatures.tolist())) < 3:
        raise SceneError(
            "reference", reference, f"must be one of three or more temperatures; there are {temperatures.tolist()} K"
        )
    logs = np.zeros(len(ordered))
    for step, others in ((1, range(home + 1, len(ordered))), (-1, range(home - 1, -1, -1))):
        for i in others:
            logs[i] = logs[i - step] + _shift_between(ordered[i - step], ordered[i])
    away = np.abs(temperatures - temperatures[home]) > 0.5
    distance = temperatures[away] - temperatures[home]
    if np.any(logs[away] * distance >= 0):
        raise SceneError(
            "curves", logs.tolist(), "colder curves do not relax more slowly: are temperatures in K, in order?"
        )
    slope, offset = np.polyfit(distance, -distance / logs[away], 1)
    if not (slope > 0 and offset > 0):
        raise SceneError(
            "curves", logs.tolist(), "the factors do not follow a WLF law; use an Arrhenius law, or a wider range"
        )
    law = WLF(1 / slope, offset / slope, float(temperatures[home]))
    misfit = float(
        np.sqrt(np.mean([(np.log10(law.factor(t)) - a) ** 2 for t, a in zip(temperatures, logs, strict=True)]))
    )
    frequency = np.concatenate([c.frequency * 10**a for c, a in zip(ordered, logs, strict=True)])
    order = np.argsort(frequency, kind="stable")
    frequency = frequency[order]
    apart = np.concatenate([[True], np.diff(frequency) > 1e-9 * frequency[1:]])
    storage, loss = (np.concatenate([getattr(c, k) for c in ordered])[order][apart] for k in ("storage", "loss"))
    return ShiftFit(
        law, temperatures, 10**logs, misfit, Dma(frequency[apart], storage, loss, float(temperatures[home]))
    )


def _shift_between(fixed: Dma, moving: Dma) -> float:
    """Log10 of the frequency factor with which the moving curve agrees best with the fixed one."""
    x, y = np.log10(fixed.frequency), np.log10(moving.frequency)
    span = min(np.ptp(x), np.ptp(y))

    def mismatch(shift: float) -> float:
        low, high = max(x[0], y[0] + shift), min(x[-1], y[-1] + shift)
        if high - low < 0.15 * span:  # too little in common to tell a shift by
            return 1e3 + abs(shift)
        at = np.linspace(low, high, 50)
        parts = []
        for kind in ("storage", "loss"):
            a = np.interp(at, x, np.log10(getattr(fixed, kind)))
            b = np.interp(at, y + shift, np.log10(getattr(moving, kind)))
            parts.append(np.mean((a - b) ** 2))
        return float(sum(parts))

    reach = x[-1] - y[0], x[0] - y[-1]
    coarse = np.linspace(reach[1], reach[0], 201)
    best = coarse[int(np.argmin([mismatch(s) for s in coarse]))]
    width = 2 * (coarse[1] - coarse[0])
    found = minimize_scalar(mismatch, bounds=(best - width, best + width), method="bounded", options={"xatol": 1e-6})
    if found.fun >= 1e3:
        raise SceneError("curves", moving.temperature, f"does not overlap with the curve at {fixed.temperature} K")
    return float(found.x)
