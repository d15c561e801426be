"""A rigid ball: the end of a pin on a sheet."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ngwear.errors import SceneError
from ngwear.surfaces.base import RigidSurface

STRAIGHT = math.inf


@dataclass(frozen=True, kw_only=True)
class Sphere(RigidSurface):
    """Ball of ``radius`` [mm] around ``centre``, pushed along -z; it moves along +x or around a track.

    gap = |X - centre| - radius.

    Parameters
    ----------
    centre : tuple of 3 float
        [mm].
    radius : float
        [mm].
    track_radius : float
        Radius of the circular track [mm]; the ball moves counter-clockwise, and the vertical axis of the circle lies at
        this distance on its left. Infinite for a straight track.

    Raises
    ------
    SceneError
        For a radius that is not positive.
    """

    centre: tuple[float, float, float]
    radius: float
    track_radius: float = STRAIGHT

    def __post_init__(self) -> None:
        for name in ("radius", "track_radius"):
            if not getattr(self, name) > 0:
                raise SceneError(f"surface.{name}", getattr(self, name), "must be greater than 0 mm")

    def _from_centre(self, *place: Any) -> tuple[Any, ...]:
        return tuple(p - c for p, c in zip(place, self.centre, strict=True))

    def gap(self, *place: Any) -> Any:
        return sum(d * d for d in self._from_centre(*place)) ** 0.5 - self.radius

    def normal(self, *place: Any) -> tuple[Any, ...]:
        apart = self._from_centre(*place)
        distance = sum(d * d for d in apart) ** 0.5
        return tuple(d / distance for d in apart)

    def motion(self, *place: Any) -> tuple[Any, ...]:
        x, y, _ = self._from_centre(*place)
        return 1.0 - y / self.track_radius, x / self.track_radius, 0.0 * x

    def tangent(self, *place: Any) -> tuple[Any, ...]:
        """Unit direction in which the ball moves, projected on its surface."""
        motion = self.motion(*place)
        nx, ny, nz = self.normal(*place)
        off = motion[0] * nx + motion[1] * ny
        along = (motion[0] - off * nx, motion[1] - off * ny, -1 * off * nz)
        length = sum(a * a for a in along) ** 0.5
        return tuple(a / length for a in along)

    @property
    def approach(self) -> tuple[float, ...]:
        return (0.0, 0.0, -1.0)
