"""The error of the finest of two or three runs, each so many times coarser than the one before in every setting.

A reading is an array: what was read off at the same places of each run; its length is its root mean square. With q1,
q2, q4 on settings r = 2 times apart, an error c h^p makes ``q2 - q4 = r^p (q1 - q2)``: both differences point the same
way, the ratio of their lengths tells p, and what is left is (Richardson)

    |q1 - q| = |q1 - q2| / (r^p - 1).

p is kept between 1 and 3/2. At the free end of a contact pressures fall as a square root, and the strains of quadratic
elements converge with 3/2 there; what seems to converge faster comes from levels too coarse for their ratio to be
believed, or from chance, and a ratio near 1 would promise any error.

Readings whose differences point against each other, or grow, show no order. They lie about their limit by where a mesh
happens to put its nodes, as the highest nodal pressure or the end of a contact does, by an amount that falls with the
element edge: q_i = q + s h_i N(0, 1). The weights 1/h_i² give the best q, and what the readings differ from it gives s
without bias. Where differences grow, what of the last is more than scatter explains counts as a trend, of first order:

    q = sum q_i / h_i² / sum 1 / h_i²,                s² = sum |q_i - q|² / h_i² / (n - 1),
    t² = (|q1 - q2|² - (1 + r²) s²) / (r - 1)² >= 0,  |q1 - q|² = t² + s².

The last difference alone would be 2.2 s where there is nothing but scatter, most of it the coarser run's. Two runs tell
neither an order nor scatter: the order is told, or taken as the first. A coarsest run that is off by more than a third
of what is read has too few elements to tell either, and is left out: the shipped seal's, with two or three across its
lip, shows a peak pressure 57 % off.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

LOWEST, HIGHEST = 1.0, 1.5  # order of convergence: see above; the lower settled on ``verify error_estimates``
FAR = 1 / 3  # of the reading: a coarsest run further off tells nothing of the finest; settled on the rod seal's peak
Reading = Mapping[str, Mapping[str, ArrayLike]]


def order_seen(fine: ArrayLike, coarse: ArrayLike, coarsest: ArrayLike, *, ratio: float = 2.0) -> float | None:
    """Order in which readings converge, within its bounds; None if their differences turn round, or grow."""
    last, before = np.subtract(fine, coarse), np.subtract(coarse, coarsest)
    if np.vdot(last, before) <= 0 or _square(before) < _square(last):
        return None
    return float(np.clip(0.5 * math.log(_square(before) / _square(last), ratio), LOWEST, HIGHEST))


def error_of_finest(
    fine: ArrayLike, coarse: ArrayLike, coarsest: ArrayLike | None = None, *, ratio: float = 2.0, order: float = 1.0
) -> float:
    """Error of the reading ``fine``, in the mean square of its places.

    Parameters
    ----------
    fine, coarse : array_like, shape (n,)
        Of the run, and of one ``ratio`` times as coarse.
    coarsest : array_like, shape (n,), or None
        Of one ``ratio²`` times as coarse; None if there is none. Left out if it is too far off (``FAR``).
    ratio : float
        > 1.
    order : float
        Of convergence; three runs tell it themselves.

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
    seen = order_seen(fine, coarse, coarsest, ratio=ratio)
    if seen is not None:
        return math.sqrt(_square(last)) / (ratio**seen - 1)
    weights = [1.0, ratio**-2, ratio**-4]
    readings = np.array([fine, coarse, coarsest], dtype=float)
    best = np.average(readings, axis=0, weights=weights)
    scatter = sum(w * _square(q - best) for w, q in zip(weights, readings, strict=True)) / (len(weights) - 1)
    turns = np.vdot(last, np.subtract(coarse, coarsest)) < 0
    trend = 0.0 if turns else max(0.0, _square(last) - (1 + ratio**2) * scatter) / (ratio - 1) ** 2
    return math.sqrt(trend + scatter)


def relative_errors(
    fine: Reading,
    coarse: Reading,
    coarsest: Reading | None = None,
    *,
    ratio: float = 2.0,
    orders: Mapping[str, float] | None = None,
) -> dict[str, float]:
    """Error of each quantity from readings by its name and that of what was read: of the worst of these.

    ``orders`` are those of two runs, by the names of errors, where they are not the first. Errors of forces and
    pressures are taken relative to the largest of their kind: a component that vanishes has none.
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
