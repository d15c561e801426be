"""What every rigid counter-surface offers."""

from __future__ import annotations

import abc
import math
from dataclasses import dataclass
from typing import Any

from ngwear.errors import SceneError


@dataclass(frozen=True, kw_only=True)
class RigidSurface(abc.ABC):
    """A rigid body given by its signed distance: positive outside it, where the rubber may be.

    A place is two coordinates (x, y), of a solid three, as floats, arrays or coefficient functions; in an
    axisymmetric scene x is the axial and y the radial coordinate. Surfaces know no mesh.
    """

    @abc.abstractmethod
    def gap(self, *place: Any) -> Any:
        """Signed distance of a place from the surface [mm]."""

    @abc.abstractmethod
    def normal(self, *place: Any) -> tuple[Any, ...]:
        """Unit normal at the foot of a place, pointing out of the rigid body: the gradient of the gap."""

    @property
    @abc.abstractmethod
    def approach(self) -> tuple[float, ...]:
        """Unit direction in which the body is pushed into the rubber."""

    def tangent(self, *place: Any) -> tuple[Any, ...]:
        """Unit tangent: the normal turned clockwise, so that a normal (0, 1) has the tangent (1, 0)."""
        nx, ny = self.normal(*place)
        return ny, -1 * nx

    def along(self, *place: Any) -> Any:
        """Coordinate along the surface of the foot of a place [mm], growing along the approach turned by +90 degrees.

        Raises
        ------
        SceneError
            For a surface that is no curve.
        """
        raise SceneError("surface", type(self).__name__, "has no coordinate along it, and so no worn profile")

    def motion(self, *place: Any) -> tuple[Any, ...]:
        """Velocity of the body that carries the surface, over its own speed along a track [-].

        Raises
        ------
        SceneError
            For a surface that runs along no track.
        """
        raise SceneError("surface", type(self).__name__, "runs along no track")

    @property
    def length(self) -> float:
        """Once around a closed curve [mm]; infinite for an open one."""
        return math.inf

    def tangents(self, *place: Any) -> tuple[tuple[Any, ...], ...]:
        """Unit vectors along the surface: the tangent, and in three dimensions the normal's cross product with it."""
        along = self.tangent(*place)
        if len(place) == 2:
            return (along,)
        n = self.normal(*place)
        return along, tuple(n[i - 2] * along[i - 1] - n[i - 1] * along[i - 2] for i in range(3))
