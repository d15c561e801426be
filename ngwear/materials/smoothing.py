"""Replace a Prony series of few arms by a smooth spectrum, whose loss factor does not undulate."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, least_squares

from ngwear.errors import SceneError
from ngwear.materials.prony import MOST_ARMS, PronySeries

Array = NDArray[np.float64]
PER_DECADE = 3  # arms: of n a decade the loss undulates by 2 / cosh(pi² n / ln 10): 5 % with 1, 1e-5 with 3
SAMPLES = 20  # frequencies a decade: a Debye peak is over a decade wide, so that more tell no more
STRENGTHS = (1e-5, 1e2)  # of the smoothing, searched between: it changes next to nothing, and flattens all


def smooth(series: PronySeries, *, misfit: float) -> PronySeries:
    """The smoothest spectrum with three arms per decade whose moduli agree with the series within a given misfit.

    With one arm per decade, tan delta undulates by about 10 % around that of a rubber, whose spectrum is continuous,
    and a friction coefficient follows the undulation. The new spectrum minimises the curvature of log(modulus) over
    log(time). The root mean square of the relative differences of its storage and loss modulus from the old ones is
    ``misfit``, between the frequencies ``1 / (2 pi tau)`` of the longest and the shortest arm (nonlinear
    regularisation: Honerkamp & Weese, Rheol. Acta 32 (1993) 65; its strength by the discrepancy principle).

    Parameters
    ----------
    series : PronySeries
        At least three arms.
    misfit : float
        Root mean square of the relative differences [-]; use the misfit of the series to its data, or less.

    Raises
    ------
    SceneError
        For fewer than three arms, more than 13 decades, or a misfit that no spectrum reaches.
    """
    if len(series.times) < 3:
        raise SceneError("material.prony.smoothing", len(series.times), "needs at least three arms")
    start, stop = np.log10(series.times[0]) - 0.5, np.log10(series.times[-1]) + 0.5
    count = round(PER_DECADE * (stop - start))
    if count > MOST_ARMS:
        raise SceneError("material.prony.smoothing", count, f"makes more than {MOST_ARMS} arms: drop some at the ends")
    edges = np.linspace(start, stop, count + 1)
    times = 10 ** (0.5 * (edges[1:] + edges[:-1]))
    fit = _Fit(series, times)

    def excess(log_strength: float) -> float:
        return fit.misfit(fit.solve(10**log_strength)) - misfit

    low, high = np.log10(STRENGTHS)
    bounds = [fit.misfit(fit.solve(strength)) for strength in STRENGTHS]
    if not bounds[0] < misfit < bounds[1]:
        raise SceneError(
            "material.prony.smoothing", misfit, f"must lie between {bounds[0]:.2g} and {bounds[1]:.2g} for these arms"
        )
    found = fit.solve(10 ** brentq(excess, low, high, xtol=1e-3))
    return PronySeries(tuple(found.tolist()), tuple(times.tolist()))


class _Fit:
    """Arms with given times, fitted to a series with the same long-term modulus."""

    def __init__(self, series: PronySeries, times: Array) -> None:
        ends = -np.log10(2 * np.pi * np.array([series.times[-1], series.times[0]]))
        f = np.logspace(ends[0], ends[1], round(SAMPLES * np.ptp(ends)))
        x = 2 * np.pi * f[:, None] * times
        storage, loss = series.storage(f), series.loss(f)
        matrix = np.vstack([x**2 / (1 + x * x) / storage[:, None], x / (1 + x * x) / loss[:, None]])
        self.matrix = matrix / np.sqrt(len(matrix))
        self.wanted = np.r_[1 - 1 / storage, np.ones(len(f))] / np.sqrt(len(matrix))
        self.bend = np.diff(np.eye(len(times)), n=2, axis=0) * PER_DECADE**2 / np.sqrt(len(times))
        self.guess = np.interp(np.log(times), np.log(series.times), np.log(series.ratios)) - np.log(PER_DECADE)

    def misfit(self, ratios: Array) -> float:
        """Root mean square of the relative errors of both moduli."""
        return float(np.linalg.norm(self.matrix @ ratios - self.wanted))

    def solve(self, strength: float) -> Array:
        """Ratios with the least sum of squared errors and ``strength`` times squared curvature."""

        def residual(logs: Array) -> Array:
            return np.r_[self.matrix @ np.exp(logs) - self.wanted, strength * self.bend @ logs]

        def slope(logs: Array) -> Array:
            return np.vstack([self.matrix * np.exp(logs), strength * self.bend])

        return np.exp(least_squares(residual, self.guess, slope, x_scale="jac").x)
