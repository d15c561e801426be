"""The error of the finest of two or three runs, each so many times coarser than the one before in every setting.

A reading is an array: what was read off at the same places of each run; its length is its root mean square. With q1,
q2, q4 on settings r = 2 times apart, an error c h^p makes ``q2 - q4 = r^p (q1 - q2)``: both differences point the same
way, the ratio of their lengths tells p, and what is left is (Richardson)

    |q1 - q| = |q1 - q2| / (r^p - 1).

p is kept between 0.7 and 2. A ratio near 1 would promise any error; and a last difference that is small by chance must
not promise more than second order, which is about what the contacts' free ends leave of quadratic elements.

Readings whose differences point against each other, or grow, show no order. They lie about a trend by where a mesh
happens to put its nodes, as the highest nodal pressure or the end of a contact does, by an amount that falls with the
element edge: q_i = q + s h_i N(0, 1). The weights 1/h_i² give the best q, and what the readings differ from it gives s
without bias. What of the last difference is more than scatter explains is the trend, taken as of first order:

    q = sum q_i / h_i² / sum 1 / h_i²,                s² = sum |q_i - q|² / h_i² / (n - 1),
    t² = (|q1 - q2|² - (1 + r²) s²) / (r - 1)² >= 0,  |q1 - q|² = t² + s².

The last difference alone would be 2.2 s where there is nothing but scatter, most of it the coarser run's. Two runs tell
neither an order nor scatter: the first order is taken.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

LOWEST, HIGHEST = 0.7, 2.0  # order of convergence
Reading = Mapping[str, Mapping[str, ArrayLike]]


def order_seen(fine: ArrayLike, coarse: ArrayLike, coarsest: ArrayLike, *, ratio: float = 2.0) -> float | None:
    """Order in which readings converge, within its bounds; None if their differences turn round, or grow."""
    last, before = np.subtract(fine, coarse), np.subtract(coarse, coarsest)
    if np.vdot(last, before) <= 0 or _square(before) < _square(last):
        return None
    return float(np.clip(0.5 * math.log(_square(before) / _square(last), ratio), LOWEST, HIGHEST))


def error_of_finest(
    fine: ArrayLike, coarse: ArrayLike, coarsest: ArrayLike | None = None, *, ratio: float = 2.0
) -> float:
    """Error of the reading ``fine``, in the mean square of its places.

    Parameters
    ----------
    fine, coarse : array_like, shape (n,)
        Of the run, and of one ``ratio`` times as coarse.
    coarsest : array_like, shape (n,), or None
        Of one ``ratio²`` times as coarse; None if there is none.
    ratio : float
        > 1.

    Examples
    --------
    >>> round(error_of_finest(1.01, 1.04, 1.16), 9)  # second order: the limit is 1
    0.01
    """
    last = _square(np.subtract(fine, coarse))
    if coarsest is None:
        return math.sqrt(last) / (ratio - 1)
    order = order_seen(fine, coarse, coarsest, ratio=ratio)
    if order is not None:
        return math.sqrt(last) / (ratio**order - 1)
    weights = [1.0, ratio**-2, ratio**-4]
    readings = np.array([fine, coarse, coarsest], dtype=float)
    best = np.average(readings, axis=0, weights=weights)
    scatter = sum(w * _square(q - best) for w, q in zip(weights, readings, strict=True)) / (len(weights) - 1)
    trend = max(0.0, last - (1 + ratio**2) * scatter) / (ratio - 1) ** 2
    return math.sqrt(trend + scatter)


def relative_errors(
    fine: Reading, coarse: Reading, coarsest: Reading | None = None, *, ratio: float = 2.0
) -> dict[str, float]:
    """Error of each quantity from readings by its name and that of what was read: of the worst of these.

    Errors of forces and pressures are taken relative to the largest of their kind: a component that vanishes has none.
    """
    out = {}
    for error, values in fine.items():
        known = {name: np.atleast_1d(v) for name, v in values.items()}
        coarser = [level[error] for level in (coarse, coarsest) if level is not None]
        off = [error_of_finest(v, *(level.get(n, 0.0 * v) for level in coarser), ratio=ratio) for n, v in known.items()]
        scale = math.sqrt(max((_square(v) for v in known.values()), default=0.0))
        out[error] = max(off) / scale if scale > 0 else 0.0
    return out


def _square(values: ArrayLike) -> float:
    """Mean square."""
    return float(np.mean(np.square(values)))
