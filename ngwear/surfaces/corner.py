"""The rounded outer corner of a rigid body: a housing's wall that ends at a gap, or the edge of a groove."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ngwear.errors import SceneError, check_fields
from ngwear.surfaces.base import RigidSurface

SQUARE = 1e-6  # cosine: what rounding makes of a right angle


@dataclass(frozen=True, kw_only=True)
class Corner(RigidSurface):
    """Quarter of the plane behind two faces at right angles through ``point``, its edge rounded.

    ``normal_vector`` and ``side`` are the unit normals of the faces, out of the body; it is pushed along the first.
    With the distances a and b beyond the faces, moved back by the radius r, ``a' = a + r`` and ``b' = b + r``:
    gap = sqrt(a'^2 + b'^2) - r beside the rounded edge, where both are positive, else max(a, b).

    In the meridian plane (x axial, y radial) the air-side wall of a groove that ends at a gap of 0.1 mm above a rod of
    radius R has the point (x, R + 0.1), the normal (1, 0) and the side (0, -1).

    Parameters
    ----------
    point : (x, y)
        Where the faces would meet without the rounding [mm].
    normal_vector, side : (x, y)
    radius : float
        [mm].

    Raises
    ------
    SceneError
        For a radius that is not positive, a normal of length zero, or faces that are not at right angles.
    """

    point: tuple[float, float]
    normal_vector: tuple[float, float]
    side: tuple[float, float]
    radius: float

    def __post_init__(self) -> None:
        check_fields(self, "surface")
        if not self.radius > 0:
            raise SceneError("surface.radius", self.radius, "must be greater than 0 mm")
        for name, key in (("normal_vector", "normal"), ("side", "side")):
            x, y = getattr(self, name)
            length = math.hypot(x, y)
            if not length > 0:
                raise SceneError(f"surface.{key}", (x, y), "must be a vector longer than 0")
            object.__setattr__(self, name, (x / length, y / length))
        (nx, ny), (sx, sy) = self.normal_vector, self.side
        if abs(nx * sx + ny * sy) > SQUARE:
            raise SceneError("surface.side", self.side, f"must be at right angles to the normal {self.normal_vector}")

    def _beyond(self, x: Any, y: Any) -> tuple[Any, Any]:
        """Distances beyond both faces, moved back by the radius [mm]."""
        (px, py), (nx, ny), (sx, sy) = self.point, self.normal_vector, self.side
        return (x - px) * nx + (y - py) * ny + self.radius, (x - px) * sx + (y - py) * sy + self.radius

    def gap(self, x: Any, y: Any) -> Any:
        a, b = self._beyond(x, y)
        beside = _if_positive(b, (a * a + b * b) ** 0.5, a)
        behind = _if_positive(b, b, _if_positive(a - b, a, b))
        return _if_positive(a, beside, behind) - self.radius

    def normal(self, x: Any, y: Any) -> tuple[Any, Any]:
        a, b = self._beyond(x, y)
        distance = (a * a + b * b) ** 0.5
        found = []
        for n, s in zip(self.normal_vector, self.side, strict=True):
            beside = _if_positive(b, (n * a + s * b) / distance, n)
            found.append(_if_positive(a, beside, _if_positive(b, s, _if_positive(a - b, n, s))))
        return found[0], found[1]

    def along(self, x: Any, y: Any) -> Any:
        """Way along the face, the rounded edge and the side, from where the faces would meet [mm], for arrays."""
        a, b = self._beyond(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        (nx, ny), (sx, sy) = self.normal_vector, self.side
        regions = [(a > 0) & (b > 0), b > np.minimum(a, 0.0)]
        way = np.select(regions, [self.radius * np.arctan2(b, a), self.radius * np.pi / 2 - a], b)
        return np.copysign(1.0, nx * sy - ny * sx) * (way - self.radius)

    @property
    def approach(self) -> tuple[float, float]:
        return self.normal_vector


def _if_positive(value: Any, then: Any, otherwise: Any) -> Any:
    """One of two values, for numbers, arrays and coefficient functions."""
    if isinstance(value, float | int | np.ndarray):
        return np.where(value > 0, then, otherwise)[()]
    import ngsolve as ng  # only where a mesh is at hand

    return ng.IfPos(value, then, otherwise)
