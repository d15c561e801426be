"""A rigid half-space; in an axisymmetric scene also a rod, a bore or a shoulder."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Real
from typing import Any

from ngwear.errors import SceneError, check_fields
from ngwear.surfaces.base import RigidSurface


@dataclass(frozen=True, kw_only=True)
class Plane(RigidSurface):
    """Half-space with the surface point ``point`` and the unit ``normal_vector``, which points at the rubber.

    gap = (X - point) . normal. In the meridian plane (x axial, y radial) a rod of radius R is the plane
    through (0, R) with normal (0, 1), a bore that with normal (0, -1), a shoulder one with normal (+-1, 0).

    Raises
    ------
    SceneError
        For a normal of length zero.
    """

    point: tuple[float, float]
    normal_vector: tuple[float, float]

    def __post_init__(self) -> None:
        check_fields(self, "surface")
        length = math.hypot(*self.normal_vector)
        if not length > 0:
            raise SceneError("surface.normal", self.normal_vector, "must be a vector longer than 0")
        nx, ny = self.normal_vector
        object.__setattr__(self, "normal_vector", (nx / length, ny / length))

    def gap(self, x: Any, y: Any) -> Any:
        nx, ny = self.normal_vector
        return (x - self.point[0]) * nx + (y - self.point[1]) * ny

    def normal(self, x: Any, y: Any) -> tuple[Any, Any]:
        return self.normal_vector

    def along(self, x: Any, y: Any) -> Any:
        nx, ny = self.normal_vector
        return (y - self.point[1]) * nx - (x - self.point[0]) * ny

    @property
    def approach(self) -> tuple[float, float]:
        return self.normal_vector


def rod(diameter: float) -> Plane:
    """Shaft of the given diameter [mm] on the axis of an axisymmetric scene.

    Raises
    ------
    SceneError
        For a diameter that is not positive.
    """
    return _around_axis(diameter, outwards=1.0)


def bore(diameter: float) -> Plane:
    """Hole of the given diameter [mm] around the axis of an axisymmetric scene.

    Raises
    ------
    SceneError
        For a diameter that is not positive.
    """
    return _around_axis(diameter, outwards=-1.0)


def _around_axis(diameter: float, *, outwards: float) -> Plane:
    if not (isinstance(diameter, Real) and diameter > 0):
        raise SceneError("surface.diameter", diameter, "must be greater than 0 mm")
    return Plane(point=(0.0, diameter / 2), normal_vector=(0.0, outwards))
