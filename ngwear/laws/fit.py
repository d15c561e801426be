"""Fit the four phases of lubrication to a measured friction coefficient over sliding distance."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize, nnls

from ngwear.errors import SceneError
from ngwear.laws.lubrication import Lubrication

Array = NDArray[np.float64]
TRIED = 16  # places tried for the ends of the phases before the best are refined: 560 starts for three ends


@dataclass(frozen=True)
class LubricationFit:
    """Fitted four phases and their errors against the data.

    Attributes
    ----------
    law : Lubrication
    data : Lubrication
        The measured rows.
    misfit, largest : float
        Root mean square and largest difference of mu [-].
    """

    law: Lubrication
    data: Lubrication
    misfit: float
    largest: float


def fit_lubrication(data: Lubrication | Path | str) -> LubricationFit:
    """Fit a constant film, rising mixed and boundary lubrication, and constant dry friction, by least squares.

    For given ends of the phases mu is a sum of ramps with non-negative heights (NNLS), so that it never falls. The
    three ends are searched on a grid and refined by the simplex method of Nelder & Mead.

    Parameters
    ----------
    data : Lubrication, or path of a CSV file for ``Lubrication.read``
        At least eight rows.

    Raises
    ------
    SceneError
        For a table that is too short or friction that does not rise.
    """
    data = data if isinstance(data, Lubrication) else Lubrication.read(data)
    s, mu = np.array(data.distance), np.array(data.coefficient)
    if len(s) < 8:
        raise SceneError("friction.distance", len(s), "four phases need at least eight rows; use the table as it is")
    span = s[-1] - s[0]

    def heights(ends: Array) -> tuple[Array, float]:
        ends = np.sort(ends)
        if ends[0] <= 0 or ends[-1] > s[-1] or np.diff(ends).min() < 1e-3 * span:
            return np.zeros(3), np.inf
        ramps = [np.clip((s - a) / (b - a), 0.0, 1.0) for a, b in pairwise(ends)]
        return nnls(np.column_stack([np.ones_like(s), *ramps]), mu)

    grid = s[0] + span * np.arange(1, TRIED + 1) / TRIED
    start = min(combinations(grid, 3), key=lambda ends: heights(np.array(ends))[1])
    corners = np.array(start) + 0.5 * span / TRIED * np.vstack([np.zeros(3), -np.eye(3)])
    options = {"initial_simplex": corners, "xatol": 1e-6 * span, "fatol": 1e-9, "maxiter": 2000}
    ends = np.sort(minimize(lambda x: heights(x)[1], start, method="Nelder-Mead", options=options).x)
    (film, mixed, boundary), _ = heights(ends)
    if not film < film + mixed + boundary:
        raise SceneError("friction.coefficient", float(mu[-1]), "does not rise: the data show no starving lubrication")
    law = Lubrication.four_phases(
        film=float(film), boundary=float(film + mixed), dry=float(film + mixed + boundary), ends=tuple(ends.tolist())
    )
    off = np.array([law.mu(x) for x in s]) - mu
    return LubricationFit(law, data, float(np.sqrt(np.mean(off**2))), float(np.abs(off).max()))
