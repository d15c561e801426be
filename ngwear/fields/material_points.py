"""The integration points of a section: strain there from the unknowns, nodal forces and stiffness back.

All points are treated at once, as arrays. A symbolic energy in NGSolve is evaluated element by element once
for each pair of strain components: five times the time for the same numbers (``tests/unit/test_material_points.py``
compares both), and assembly is half of a run.
"""

from __future__ import annotations

from functools import cached_property

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.fields.kinematics import Kinematics
from ngwear.geometry.body import Body

Array = NDArray[np.float64]
Index = NDArray[np.int64]
STRAINS = 6  # F_xx - 1, F_xy, F_yx, F_yy - 1, hoop stretch - 1 (0 in plane strain), volumetric stress


class MaterialPoints:
    """Strains at the points, and their transpose.

    The strain of a point is ``(F_xx - 1, F_xy, F_yx, F_yy - 1, hoop - 1, p)`` with F the deformation gradient of
    the section and p the volumetric stress [MPa]. It is linear in the unknowns; the matrix B of that map and
    the reference volumes follow the body's outline as it moves.

    Parameters
    ----------
    body : Body
    kinematics : Kinematics
    order : int
        Polynomial order of the displacement; the volumetric stress has one less.
    displacement, pressure : slice
        Where both stand in the vector of unknowns.
    """

    def __init__(self, body: Body, kinematics: Kinematics, *, order: int, displacement: slice, pressure: slice) -> None:
        self.body, self.kinematics = body, kinematics
        self._rule = rule = ng.IntegrationRule(ng.TRIG, 2 * order)
        self._points = body.mesh.MapToAllElements(rule, ng.VOL)
        self._rule_weights = np.array(rule.weights)
        moving, self._shapes, self._slopes = _shapes(body.mesh, order, rule)
        stressed, self._stress_shapes, _ = _shapes(body.mesh, order - 1, rule)
        half = (displacement.stop - displacement.start) // 2
        first = displacement.start
        self.unknowns = np.concatenate([first + moving, first + half + moving, pressure.start + stressed], axis=1)
        self._measure()

    def follow(self) -> None:
        """Measure anew if the outline has moved."""
        if self._contour is not self.body.contour:
            self._measure()

    def _measure(self) -> None:
        self._contour = self.body.contour
        elements, points = self._slopes.shape[:2]
        shape = (elements, points)
        jacobian = np.asarray(ng.specialcf.JacobianMatrix(2)(self._points)).reshape(*shape, 2, 2)
        slopes = self._slopes @ np.linalg.inv(jacobian)
        weight = np.broadcast_to(np.asarray(self.kinematics.weight(self._points)).reshape(-1), (elements * points,))
        self._areas = self._rule_weights * np.abs(np.linalg.det(jacobian))
        self.volumes = self._areas * weight.reshape(shape)
        n = self._slopes.shape[2]
        B = np.zeros((*shape, STRAINS, self.unknowns.shape[1]))
        B[:, :, 0, :n], B[:, :, 1, :n] = slopes[..., 0], slopes[..., 1]
        B[:, :, 2, n : 2 * n], B[:, :, 3, n : 2 * n] = slopes[..., 0], slopes[..., 1]
        self.radius: Array | None = None
        if self.kinematics.axisymmetric:
            self.radius = np.asarray(ng.y(self._points)).reshape(shape)
            B[:, :, 4, n : 2 * n] = self._shapes / self.radius[..., None]
        B[:, :, 5, 2 * n :] = self._stress_shapes
        self._B = B
        self._flat = B.reshape(elements, points * STRAINS, -1)
        weighted = (B * self.volumes[..., None, None]).reshape(self._flat.shape)
        self._transposed = np.ascontiguousarray(weighted.swapaxes(1, 2))  # times the volumes

    def strain(self, vector: Array) -> Array:
        """Strains of a vector of unknowns, shape (elements, points, 6)."""
        return (self._flat @ vector[self.unknowns][:, :, None]).reshape(*self.volumes.shape, STRAINS)

    def forces(self, stress: Array) -> Array:
        """Element vectors of a stress conjugate to the strain per reference volume; shape (elements, unknowns)."""
        return (self._transposed @ stress.reshape(len(stress), -1, 1))[:, :, 0]

    @property
    def places(self) -> Array:
        """Reference coordinates of the points [mm], shape (elements, points, 2)."""
        places = np.stack([np.asarray(c(self._points)) for c in (ng.x, ng.y)], axis=-1)
        return places.reshape(*self.volumes.shape, 2)

    @property
    def centres(self) -> Array:
        """Centres of the elements [mm], shape (elements, 2)."""
        return self.places.mean(axis=1)

    @property
    def edges(self) -> Array:
        """Edge of the equilateral triangle of each element's area [mm], shape (elements,)."""
        return np.sqrt(4 / np.sqrt(3) * self._areas.sum(axis=1))

    def recovered(self, values: Array) -> Array:
        """Values at the points, shape (elements, points, k), smoothed: averaged to the vertices and interpolated."""
        vertices, shapes, fit = self._corners
        plane = fit @ values
        area = self._areas.sum(axis=1)
        total = np.zeros((self.body.mesh.nv, values.shape[-1]))
        weight = np.bincount(vertices.ravel(), np.repeat(area, 3), minlength=len(total))
        for k in range(values.shape[-1]):
            total[:, k] = np.bincount(vertices.ravel(), (plane[..., k] * area[:, None]).ravel(), minlength=len(total))
        return shapes @ (total / weight[:, None])[vertices]

    @cached_property
    def _corners(self) -> tuple[Index, Array, Array]:
        """Vertices of the elements, the shape functions of a plane, and the least-squares plane through the points."""
        vertices, shapes, _ = _shapes(self.body.mesh, 1, self._rule)
        return vertices, shapes, np.linalg.pinv(shapes)

    def stiffness(self, tangent: Array) -> Array:
        """Element matrices of d stress / d strain, shape (elements, points, 6, 6); shape (elements, n, n)."""
        return self._transposed @ (tangent @ self._B).reshape(self._flat.shape)


def _shapes(mesh: ng.Mesh, order: int, rule: ng.IntegrationRule) -> tuple[Index, Array, Array]:
    """Unknowns of each element in a scalar space, and its shape functions and their slopes at the rule's points.

    Shapes (elements, n), (elements, points, n) and (elements, points, n, 2), on the reference triangle. They
    depend on the order of an element's vertex numbers only.
    """
    space = ng.H1(mesh, order=order)
    elements = [ng.ElementId(ng.VOL, i) for i in range(mesh.ne)]
    unknowns = np.array([space.GetDofNrs(element) for element in elements], dtype=np.int64)
    ranks = [tuple(np.argsort([v.nr for v in mesh[element].vertices])) for element in elements]
    kinds = {rank: i for i, rank in reversed(list(enumerate(ranks)))}
    values, slopes = {}, {}
    for rank, i in kinds.items():
        element = space.GetFE(elements[i])
        values[rank] = np.array([element.CalcShape(*p) for p in np.array(rule.points)[:, :2]])
        slopes[rank] = np.array([np.array(element.CalcDShape(*p)) for p in np.array(rule.points)[:, :2]])
    return unknowns, np.array([values[r] for r in ranks]), np.array([slopes[r] for r in ranks])
