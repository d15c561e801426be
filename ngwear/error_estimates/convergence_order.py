"""Observed order of convergence in one parameter, and the error of the finest value."""

from __future__ import annotations

import math
from collections.abc import Sequence

LOWEST, HIGHEST = 0.05, 8.0  # a lower order shows no convergence; no parameter has a higher one
RATIO_BITS = 60  # halvings: to rounding


def observed_order(values: Sequence[float], results: Sequence[float]) -> float | None:
    """Order p of ``result = limit + c value^p`` through the three finest runs; None if there is none.

    Solves ``(a^p - b^p) / (b^p - c^p) = (q_a - q_b) / (q_b - q_c)`` for p; a value may be 0.

    Parameters
    ----------
    values : sequence of float
        Values of the parameter, decreasing.
    results : sequence of float
        Result with each value.
    """
    if len(values) < 3:
        return None
    a, b, c = values[-3:]
    first, second = (results[-3] - results[-2]), (results[-2] - results[-1])
    if second == 0 or first / second <= 0:
        return None
    wanted = first / second

    def residual(p: float) -> float:
        """Residual of the equation above; increases with p."""
        return ((a / b) ** p - 1) / (1 - (c / b) ** p) - wanted

    low, high = LOWEST, HIGHEST
    if residual(low) > 0 or residual(high) < 0:
        return None
    for _ in range(RATIO_BITS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if residual(middle) > 0 else (middle, high)
    return 0.5 * (low + high)


def relative(result: float, reference: float) -> float:
    """Relative difference; 0 if both are 0."""
    if result == reference:
        return 0.0
    return abs(result - reference) / abs(reference) if reference else math.inf


def reference_error(values: Sequence[float], results: Sequence[float], *, smooth: bool = True) -> float | None:
    """Estimated relative error of the finest result; None for a single result.

    The last change, extrapolated with the observed order; the whole change without an order; 0 if the value is 0.

    Parameters
    ----------
    values, results : sequence of float
        As in ``observed_order``.
    smooth : bool
        Whether the result can have an order of convergence in this parameter.
    """
    if values[-1] == 0:
        return 0.0
    if len(values) < 2:
        return None
    change = relative(results[-2], results[-1])
    p = observed_order(values, results) if smooth else None
    return change if p is None else min(change, change / ((values[-2] / values[-1]) ** max(p, 0.5) - 1))
