"""A rigid disc in the plane: a roller across a plane strain sheet."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ngwear.errors import SceneError, check_fields
from ngwear.surfaces.base import RigidSurface


@dataclass(frozen=True, kw_only=True)
class Cylinder(RigidSurface):
    """Disc of ``radius`` [mm] around ``centre``, pushed along ``push`` (unit vector).

    gap = |X - centre| - radius.

    Raises
    ------
    SceneError
        For a radius that is not positive or a direction of length zero.
    """

    centre: tuple[float, float]
    radius: float
    push: tuple[float, float] = (0.0, -1.0)

    def __post_init__(self) -> None:
        check_fields(self, "surface")
        if not self.radius > 0:
            raise SceneError("surface.radius", self.radius, "must be greater than 0 mm")
        length = math.hypot(*self.push)
        if not length > 0:
            raise SceneError("surface.push", self.push, "must be a vector longer than 0")
        object.__setattr__(self, "push", (self.push[0] / length, self.push[1] / length))

    def _distance(self, x: Any, y: Any) -> Any:
        return ((x - self.centre[0]) ** 2 + (y - self.centre[1]) ** 2) ** 0.5

    def gap(self, x: Any, y: Any) -> Any:
        return self._distance(x, y) - self.radius

    def normal(self, x: Any, y: Any) -> tuple[Any, Any]:
        distance = self._distance(x, y)
        return (x - self.centre[0]) / distance, (y - self.centre[1]) / distance

    def along(self, x: Any, y: Any) -> Any:
        """Arc from the foremost point [mm], for floats and arrays."""
        px, py = self.push
        x, y = x - self.centre[0], y - self.centre[1]
        return self.radius * np.arctan2(y * px - x * py, x * px + y * py)

    @property
    def length(self) -> float:
        return 2 * math.pi * self.radius

    @property
    def approach(self) -> tuple[float, float]:
        return self.push
