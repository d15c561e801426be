"""Plane strain, axisymmetry and solids: how a displacement becomes strain, area and volume."""

from __future__ import annotations

import abc
import math
from typing import Any

import ngsolve as ng


class Kinematics(abc.ABC):
    """Strain measures of a part with displacement u, of a section also with a hoop stretch.

    All quantities are per reference measure; integrals over the part or its surface have the factor ``weight``:
    1 for a solid and for plane strain (per mm of thickness), 2 pi R for axisymmetry.
    """

    axisymmetric: bool

    @property
    @abc.abstractmethod
    def weight(self) -> Any:
        """Reference thickness: 1 [-], or the circumference 2 pi R [mm]."""

    def hoop_stretch(self, u: Any) -> Any:
        """Stretch out of the section's plane: 1, or 1 + u_r / R."""
        return ng.CF(1.0)

    def area_vector(self, u: Any, trace_grad_u: Any) -> Any:
        """Spatial outward normal times da/dA on the outline (Nanson), shape (2,).

        ``trace_grad_u`` is the tangential gradient of u there.
        """
        n = ng.specialcf.normal(2)
        along = ng.CF((-n[1], n[0]))
        pushed = along + trace_grad_u * along
        return self.hoop_stretch(u) * ng.CF((pushed[1], -pushed[0]))

    def area_stretch(self, u: Any, trace_grad_u: Any) -> Any:
        """da/dA on the outline [-]."""
        return ng.Norm(self.area_vector(u, trace_grad_u))


class PlaneStrain(Kinematics):
    """No strain out of the plane; forces are per mm of thickness."""

    axisymmetric = False

    @property
    def weight(self) -> Any:
        return ng.CF(1.0)


class Solid(Kinematics):
    """Three dimensions."""

    axisymmetric = False

    @property
    def weight(self) -> Any:
        return ng.CF(1.0)

    def area_vector(self, u: Any, trace_grad_u: Any) -> Any:
        n = ng.specialcf.normal(3)
        across = [ng.CF((0, -n[2], n[1])), ng.CF((n[2], 0, -n[0])), ng.CF((-n[1], n[0], 0))]
        x, y, z = (t + trace_grad_u * t for t in across)  # F (n x e_k): tangents, all that the trace knows
        # cof F ((n x e_a) x (n x e_b)) = n_c cof F n for cyclic a, b, c.
        return n[0] * ng.Cross(y, z) + n[1] * ng.Cross(z, x) + n[2] * ng.Cross(x, y)


class Axisymmetric(Kinematics):
    """Rotation about the x axis: x is axial, y is the radius R; no torsion."""

    axisymmetric = True

    @property
    def weight(self) -> Any:
        return 2 * math.pi * ng.y

    def hoop_stretch(self, u: Any) -> Any:
        return 1 + u[1] / ng.y
