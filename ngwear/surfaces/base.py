"""Base class of all rigid counter-surfaces."""

from __future__ import annotations

import abc
import math
from dataclasses import dataclass
from typing import Any

from ngwear.errors import SceneError


@dataclass(frozen=True, kw_only=True)
class RigidSurface(abc.ABC):
    """A rigid body, given by the signed distance from it: positive outside, on the side of the rubber.

    A place is given by the coordinates x and y [mm], for a solid x, y and z, as floats, arrays or coefficient
    functions. In an axisymmetric scene x is the axial and y the radial coordinate. Surfaces do not use a mesh.
    """

    @abc.abstractmethod
    def gap(self, *place: Any) -> Any:
        """Signed distance of a place from the surface [mm]."""

    @abc.abstractmethod
    def normal(self, *place: Any) -> tuple[Any, ...]:
        """Unit normal at the nearest surface point, out of the rigid body: the gradient of the gap."""

    @property
    @abc.abstractmethod
    def approach(self) -> tuple[float, ...]:
        """Unit direction in which the body is pushed into the rubber."""

    def tangent(self, *place: Any) -> tuple[Any, ...]:
        """Unit tangent: the normal turned clockwise, so that a normal (0, 1) has the tangent (1, 0)."""
        nx, ny = self.normal(*place)
        return ny, -1 * nx

    def along(self, *place: Any) -> Any:
        """Coordinate along the surface of its point nearest to a place [mm]; it grows along ``approach`` turned by
        +90°.

        Raises
        ------
        SceneError
            For a surface that is not a curve.
        """
        raise SceneError("surface", type(self).__name__, "has no coordinate along it and cannot have a worn profile")

    def motion(self, *place: Any) -> tuple[Any, ...]:
        """Velocity of the rigid body over its speed along the track [-].

        Raises
        ------
        SceneError
            For a surface without a track.
        """
        raise SceneError("surface", type(self).__name__, "does not move along a track")

    @property
    def length(self) -> float:
        """Length of a closed curve [mm]; infinite for an open one."""
        return math.inf

    def tangents(self, *place: Any) -> tuple[tuple[Any, ...], ...]:
        """Unit vectors along the surface: the tangent, and in three dimensions the normal's cross product with it."""
        along = self.tangent(*place)
        if len(place) == 2:
            return (along,)
        n = self.normal(*place)
        return along, tuple(n[i - 2] * along[i - 1] - n[i - 1] * along[i - 2] for i in range(3))
