"""Tables over the sliding distance: linear between their rows, constant beyond the ends."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import SceneError

Array = NDArray[np.float64]


def check_table(place: str, name: str, distance: Sequence[float], values: Sequence[float], *, unit: str) -> None:
    """Require a table with rising distances and values of at least 0.

    Raises
    ------
    SceneError
        Names the row, the value found there and the remedy.
    """
    if len(distance) != len(values):
        raise SceneError(
            f"{place}.{name}", len(values), f"the table needs one value for each of its {len(distance)} distances"
        )
    if len(distance) == 0:
        raise SceneError(f"{place}.distance", list(distance), "give at least one row")
    for i, s in enumerate(distance):
        if not 0 <= s < math.inf:
            raise SceneError(f"{place}.distance[{i}]", s, "a sliding distance must be at least 0 mm, and finite")
        if i > 0 and not s > distance[i - 1]:
            raise SceneError(
                f"{place}.distance[{i}]", s, f"must rise: the row before has {distance[i - 1]:g} mm; sort the rows"
            )
    for i, value in enumerate(values):
        if not 0 <= value < math.inf:
            raise SceneError(f"{place}.{name}[{i}]", value, f"must be at least 0{unit}, and finite")


def area_below(distance: Sequence[float], values: Sequence[float], end: Array) -> Array:
    """Exact integral of a table from 0 to each of the distances ``end``; unit of the values times mm."""
    s, v = np.asarray(distance), np.asarray(values)
    if s[0] > 0:
        s, v = np.insert(s, 0, 0.0), np.insert(v, 0, v[0])
    below = np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]) * np.diff(s))])
    row = np.clip(np.searchsorted(s, end, side="right") - 1, 0, len(s) - 1)
    return below[row] + 0.5 * (v[row] + np.interp(end, s, v)) * (end - s[row])
