"""The integration points of a part: strain there from the unknowns, nodal forces and stiffness back.

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
from ngwear.geometry.meshed import Meshed

Array = NDArray[np.float64]
Index = NDArray[np.int64]
CELLS = {2: ng.TRIG, 3: ng.TET}
EXACT = {2: 2.0, 3: 1.0}  # order of the rule over that of the displacement: 4 points suffice in a tetrahedron


class MaterialPoints:
    """Strains at the points, and their transpose.

    The strain of a point of a section is ``(F_xx - 1, F_xy, F_yx, F_yy - 1, hoop - 1, p)`` with F the deformation
    gradient and p the volumetric stress [MPa]; of a solid, ``(F_xx - 1, F_xy, ..., F_zz - 1, p)``. It is linear in the
    unknowns; the matrix B of that map and the reference volumes follow the body's outline as it moves.

    Parameters
    ----------
    body : Meshed
    kinematics : Kinematics
    order : int
        Polynomial order of the displacement; the volumetric stress has one less.
    displacement, pressure : slice
        Where both stand in the vector of unknowns.
    """

    def __init__(
        self, body: Meshed, kinematics: Kinematics, *, order: int, displacement: slice, pressure: slice
    ) -> None:
        self.body, self.kinematics = body, kinematics
        dim = self._dim = body.mesh.dim
        self._rule = rule = ng.IntegrationRule(CELLS[dim], int(EXACT[dim] * order))
        self.strains = dim * dim + (dim == 2) + 1
        self._points = body.mesh.MapToAllElements(rule, ng.VOL)
        self._rule_weights = np.array(rule.weights)
        moving, self._shapes, self._slopes = _shapes(body.mesh, order, rule)
        stressed, self._stress_shapes, _ = _shapes(body.mesh, order - 1, rule)
        component = (displacement.stop - displacement.start) // dim
        moved = [displacement.start + i * component + moving for i in range(dim)]
        self.unknowns = np.concatenate([*moved, pressure.start + stressed], axis=1)
        self._measure()

    def follow(self) -> None:
        """Measure anew if the outline has moved."""
        if self._moves != self.body.moves:
            self._measure()

    def _measure(self) -> None:
        self._moves = self.body.moves
        elements, points = self._slopes.shape[:2]
        shape, dim = (elements, points), self._dim
        jacobian = np.asarray(ng.specialcf.JacobianMatrix(dim)(self._points)).reshape(*shape, dim, dim)
        slopes = self._slopes @ np.linalg.inv(jacobian)
        weight = np.broadcast_to(np.asarray(self.kinematics.weight(self._points)).reshape(-1), (elements * points,))
        self._sizes = self._rule_weights * np.abs(np.linalg.det(jacobian))
        self.volumes = self._sizes * weight.reshape(shape)
        n = self._slopes.shape[2]
        B = np.zeros((*shape, self.strains, self.unknowns.shape[1]))
        for i in range(dim):
            for j in range(dim):
                B[:, :, dim * i + j, i * n : (i + 1) * n] = slopes[..., j]
        self.radius: Array | None = None
        if self.kinematics.axisymmetric:
            self.radius = np.asarray(ng.y(self._points)).reshape(shape)
            B[:, :, 4, n : 2 * n] = self._shapes / self.radius[..., None]
        B[:, :, -1, dim * n :] = self._stress_shapes
        self._B = B
        self._flat = B.reshape(elements, points * self.strains, -1)
        weighted = (B * self.volumes[..., None, None]).reshape(self._flat.shape)
        self._transposed = np.ascontiguousarray(weighted.swapaxes(1, 2))  # times the volumes

    def strain(self, vector: Array) -> Array:
        """Strains of a vector of unknowns, shape (elements, points, strains)."""
        return (self._flat @ vector[self.unknowns][:, :, None]).reshape(*self.volumes.shape, self.strains)

    def forces(self, stress: Array) -> Array:
        """Element vectors of a stress conjugate to the strain per reference volume; shape (elements, unknowns)."""
        return (self._transposed @ stress.reshape(len(stress), -1, 1))[:, :, 0]

    @property
    def places(self) -> Array:
        """Reference coordinates of the points [mm], shape (elements, points, dim)."""
        places = np.stack([np.asarray(c(self._points)) for c in (ng.x, ng.y, ng.z)[: self._dim]], axis=-1)
        return places.reshape(*self.volumes.shape, self._dim)

    @property
    def centres(self) -> Array:
        """Centres of the elements [mm], shape (elements, dim)."""
        return self.places.mean(axis=1)

    @property
    def edges(self) -> Array:
        """Edge of the equilateral triangle of each element's area [mm], shape (elements,)."""
        return np.sqrt(4 / np.sqrt(3) * self._sizes.sum(axis=1))

    def recovered(self, values: Array) -> Array:
        """Values at the points, shape (elements, points, k), smoothed: averaged to the vertices and interpolated."""
        vertices, shapes, fit = self._corners
        plane = fit @ values
        area = self._sizes.sum(axis=1)
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
        """Element matrices, shape (elements, n, n), of d stress / d strain, (elements, points, strains, strains)."""
        return self._transposed @ (tangent @ self._B).reshape(self._flat.shape)


def _shapes(mesh: ng.Mesh, order: int, rule: ng.IntegrationRule) -> tuple[Index, Array, Array]:
    """Unknowns of each element in a scalar space, and its shape functions and their slopes at the rule's points.

    Shapes (elements, n), (elements, points, n) and (elements, points, n, dim), on the reference element. They
    depend on the order of an element's vertex numbers only.
    """
    space = ng.H1(mesh, order=order)
    elements = [ng.ElementId(ng.VOL, i) for i in range(mesh.ne)]
    unknowns = np.array([space.GetDofNrs(element) for element in elements], dtype=np.int64)
    vertices = np.array([[v.nr for v in mesh[element].vertices] for element in elements])
    ranks = [tuple(rank) for rank in np.argsort(vertices, axis=1).tolist()]
    kinds = {rank: i for i, rank in reversed(list(enumerate(ranks)))}
    values, slopes = {}, {}
    for rank, i in kinds.items():
        element = space.GetFE(elements[i])
        values[rank] = np.array([element.CalcShape(*p) for p in np.array(rule.points)[:, : mesh.dim]])
        slopes[rank] = np.array([np.array(element.CalcDShape(*p)) for p in np.array(rule.points)[:, : mesh.dim]])
    return unknowns, np.array([values[r] for r in ranks]), np.array([slopes[r] for r in ranks])
