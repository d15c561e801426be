"""Replace subnormal numbers by 0: many programs read them slowly, as 0, or not at all."""

from __future__ import annotations

from typing import Any

import numpy as np

SMALLEST = float(np.finfo(float).tiny)  # 2.2e-308


def without_subnormals(value: Any) -> Any:
    """The same value with 0 for each number between 0 and ``SMALLEST``; also in lists, tuples, dicts and arrays."""
    if isinstance(value, float):
        return 0.0 if 0.0 < abs(value) < SMALLEST else value
    if isinstance(value, dict):
        return {key: without_subnormals(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return type(value)(without_subnormals(item) for item in value)
    if isinstance(value, np.ndarray) and value.dtype.kind == "f":
        small = (value != 0) & (np.abs(value) < np.finfo(value.dtype).tiny)
        return np.where(small, value.dtype.type(0), value) if small.any() else value
    return value
