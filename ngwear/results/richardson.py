"""Richardson extrapolation: error of the finest of two or three runs with a fixed ratio of their settings.

A quantity is an array of values at the same strokes of each run; its norm is the root mean square. With q1, q2, q4 at
settings with the ratio r = 2, an error c h^p gives ``q2 - q4 = r^p (q1 - q2)``. If both differences have the same
direction, the ratio of their norms gives p, and the error is

    |q1 - q| = |q1 - q2| / (r^p - 1).

p is limited to the range from 1 to 3/2. At the end of a contact the pressure falls as a square root, and the strains of
quadratic elements converge with 3/2 there. A larger observed order comes from levels that are too coarse, or from
chance.

If the differences have opposite directions, or grow, there is no order. Such quantities, as the largest nodal pressure
or the end of a contact, scatter about their limit with the positions of the nodes, in proportion to the element edge:
q_i = q + s h_i N(0, 1). The weights 1/h_i² give the best q, and the differences from it an unbiased s. If differences
grow, the part of the last one that scatter does not explain counts as a trend of first order:

    q = sum q_i / h_i² / sum 1 / h_i²,                s² = sum |q_i - q|² / h_i² / (n - 1),
    t² = (|q1 - q2|² - (1 + r²) s²) / (r - 1)² >= 0,  |q1 - q|² = t² + s².

With scatter alone, the last difference would be 2.2 s, most of it from the coarser run. Two runs give neither order nor
scatter: first order is assumed unless an order is given. Where two runs are all there are, as for parts with room to
move, the error is stated with the order 3/2 and the factor of safety of two grids, ``SAFETY`` (Roache, J. Fluids Eng.
116 (1994) 405). A coarsest run that differs by more than a third has too few elements and is not used: on the shipped
seal, with two or three elements across the lip, its peak pressure is 57 % off.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

LOWEST, HIGHEST = 1.0, 1.5  # order of convergence, see above; the lower limit was chosen on ``verify error_estimates``
SAFETY = 3.0  # of two grids, whose order is not observed
FAR = 1 / 3  # relative difference beyond which the coarsest run is not used; chosen on the rod seal
Quantities = Mapping[str, Mapping[str, ArrayLike]]


def observed_order(fine: ArrayLike, coarse: ArrayLike, coarsest: ArrayLike, *, ratio: float = 2.0) -> float | None:
    """Observed order of convergence, within its limits; None if the differences change direction, or grow."""
    last, before = np.subtract(fine, coarse), np.subtract(coarse, coarsest)
    if np.vdot(last, before) <= 0 or _square(before) < _square(last):
        return None
    return float(np.clip(0.5 * math.log(_square(before) / _square(last), ratio), LOWEST, HIGHEST))


def error_of_finest(
    fine: ArrayLike, coarse: ArrayLike, coarsest: ArrayLike | None = None, *, ratio: float = 2.0, order: float = 1.0
) -> float:
    """Error of ``fine``, as root mean square over its values.

    Parameters
    ----------
    fine, coarse : array_like, shape (n,)
        Values of the run, and of a run ``ratio`` times as coarse.
    coarsest : array_like, shape (n,), or None
        Values of a run ``ratio²`` times as coarse; not used if they differ too much (``FAR``).
    ratio : float
        Ratio of the settings of two runs, > 1.
    order : float
        Order of convergence if there are two runs only.

    Examples
    --------
    >>> round(error_of_finest(1.01, 1.02, 1.04), 9)  # first order: the limit is 1
    0.01
    """
    last = np.subtract(fine, coarse)
    if coarsest is not None and _square(np.subtract(coarse, coarsest)) > FAR**2 * _square(fine):
        coarsest = None
    if coarsest is None:
        return math.sqrt(_square(last)) / (ratio**order - 1)
    order_found = observed_order(fine, coarse, coarsest, ratio=ratio)
    if order_found is not None:
        return math.sqrt(_square(last)) / (ratio**order_found - 1)
    weights = [1.0, ratio**-2, ratio**-4]
    runs = np.array([fine, coarse, coarsest], dtype=float)
    best = np.average(runs, axis=0, weights=weights)
    scatter = sum(w * _square(q - best) for w, q in zip(weights, runs, strict=True)) / (len(weights) - 1)
    turns = np.vdot(last, np.subtract(coarse, coarsest)) < 0
    trend = 0.0 if turns else max(0.0, _square(last) - (1 + ratio**2) * scatter) / (ratio - 1) ** 2
    return math.sqrt(trend + scatter)


def relative_errors(
    fine: Quantities,
    coarse: Quantities,
    coarsest: Quantities | None = None,
    *,
    ratio: float = 2.0,
    orders: Mapping[str, float] | None = None,
) -> dict[str, float]:
    """Relative error of each kind of quantity: the largest over its quantities.

    ``fine``, ``coarse`` and ``coarsest`` map the name of the error, and the name of the quantity, to values. ``orders``
    are used for two runs instead of first order, by name of the error. Errors are relative to the largest quantity of
    their kind, so that a vanishing force component does no harm.
    """
    out = {}
    for error, values in fine.items():
        known = {name: np.atleast_1d(v) for name, v in values.items()}
        coarser = [level[error] for level in (coarse, coarsest) if level is not None]
        order = (orders or {}).get(error, 1.0)
        off = [
            error_of_finest(v, *(level.get(n, 0.0 * v) for level in coarser), ratio=ratio, order=order)
            for n, v in known.items()
        ]
        scale = math.sqrt(max((_square(v) for v in known.values()), default=0.0))
        out[error] = max(off) / scale if scale > 0 else 0.0
    return out


def _square(values: ArrayLike) -> float:
    """Mean square."""
    return float(np.mean(np.square(values)))
