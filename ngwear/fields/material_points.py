"""Integration points of a part: strains from the unknowns, nodal forces and stiffness from stresses.

All points are treated at once, as arrays. A symbolic energy in NGSolve is evaluated element by element once
for each pair of strain components: five times the time for the same numbers (``test_material_points.py``
compares both), and assembly is half of a run.
"""

from __future__ import annotations

from functools import cached_property

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.fields.element_shapes import Cells
from ngwear.fields.kinematics import Kinematics
from ngwear.fields.reference_elements import ReferenceElements
from ngwear.geometry.meshed import Meshed

Array = NDArray[np.float64]
Index = NDArray[np.int64]
EXACT = {2: 2.0, 3: 1.0}  # order of the rule over that of the displacement: 4 points suffice in a tetrahedron
BUBBLES = 2  # integration order for displacements of order 1, so that their bubbles are integrated


class MaterialPoints:
    """Strains at the points, and their transpose.

    The strain of a point of a section is ``(F_xx - 1, F_xy, F_yx, F_yy - 1, hoop - 1, p)`` with F the deformation
    gradient and p the volumetric stress [MPa]; of a solid, ``(F_xx - 1, F_xy, ..., F_zz - 1, p)``. It is linear in the
    unknowns; the matrix B of that map and the reference volumes follow the body's outline as it moves.

    Where a section has triangles and quadrilaterals, triangles are filled up to as many points: copies of a point of
    theirs with no volume (see ``fields.element_shapes``).

    Parameters
    ----------
    body : Meshed
    kinematics : Kinematics
    moving, stressed : ng.FESpace
        Of a component of the displacement and of the volumetric stress.
    displacement, pressure : slice
        Where both stand in the vector of unknowns.
    """

    def __init__(
        self,
        body: Meshed,
        kinematics: Kinematics,
        moving: ng.FESpace,
        stressed: ng.FESpace,
        *,
        displacement: slice,
        pressure: slice,
    ) -> None:
        self.body, self.kinematics = body, kinematics
        dim = self._dim = body.mesh.dim
        self._cells = Cells(body.mesh, int(EXACT[dim] * max(moving.globalorder, BUBBLES)))
        self.strains = dim * dim + (dim == 2) + 1
        self._points = self._cells.points
        self._stressed = stressed
        moves, shapes, slopes = self._cells.shapes(moving)
        stresses, stress_shapes, _ = self._cells.shapes(stressed)
        component = (displacement.stop - displacement.start) // dim
        moved = [displacement.start + i * component + moves for i in range(dim)]
        self.unknowns = np.concatenate([*moved, pressure.start + stresses], axis=1)
        arrays, hoop = (shapes, slopes, stress_shapes, self._cells.kinds), kinematics.axisymmetric
        self._elements = ReferenceElements(*arrays, strains=self.strains, hoop=hoop)
        self._measure()

    def follow(self) -> None:
        """Update B and the volumes if the outline has moved."""
        if self._moves != self.body.moves:
            self._measure()

    def _measure(self) -> None:
        self._moves = self.body.moves
        shape, dim = self._cells.weights.shape, self._dim
        jacobian = np.asarray(ng.specialcf.JacobianMatrix(dim)(self._points)).reshape(*shape, dim, dim)
        weight = np.broadcast_to(np.asarray(self.kinematics.weight(self._points)).reshape(-1), (shape[0] * shape[1],))
        self._sizes = self._cells.weights * np.abs(np.linalg.det(jacobian))
        self.volumes = self._sizes * weight.reshape(shape)
        self.radius: Array | None = None
        if self.kinematics.axisymmetric:
            self.radius = np.asarray(ng.y(self._points)).reshape(shape)
        self._elements.place(np.linalg.inv(jacobian), self.volumes, self.radius)

    def strain(self, vector: Array) -> Array:
        """Strains of a vector of unknowns, shape (elements, points, strains)."""
        return self._elements.strain(vector[self.unknowns])

    def forces(self, stress: Array) -> Array:
        """Element vectors of a stress conjugate to the strain per reference volume; shape (elements, unknowns)."""
        return self._elements.forces(stress)

    @property
    def nbytes(self) -> int:
        """Memory of the arrays stored at the points [bytes]."""
        return self._elements.nbytes + self.volumes.nbytes + self.unknowns.nbytes

    @property
    def places(self) -> Array:
        """Reference coordinates of the points [mm], shape (elements, points, dim)."""
        places = np.stack([np.asarray(c(self._points)) for c in (ng.x, ng.y, ng.z)[: self._dim]], axis=-1)
        return places.reshape(*self.volumes.shape, self._dim)

    @property
    def centres(self) -> Array:
        """Centres of the elements [mm], shape (elements, dim)."""
        return self.places.mean(axis=1, where=self._cells.real[..., None])

    @property
    def edges(self) -> Array:
        """Edge of the equilateral triangle, or of the square, of each element's area [mm], shape (elements,)."""
        return np.sqrt(np.where(self._cells.quads, 1.0, 4 / np.sqrt(3)) * self._sizes.sum(axis=1))

    def recovered(self, values: Array) -> Array:
        """Values at the points, shape (elements, points, k), smoothed: made continuous, as the volumetric stress is.

        Its unknowns are fitted to the values of each element, and averaged between elements.
        """
        unknowns, shapes, _ = self._smooth
        return shapes @ self._recovered_unknowns(values)[unknowns]

    def recovered_at_vertices(self, values: Array) -> Array:
        """The same at the mesh's vertices, shape (vertices, k)."""
        return self._recovered_unknowns(values)[: self.body.mesh.nv]

    def _recovered_unknowns(self, values: Array) -> Array:
        unknowns, shapes, fit = self._smooth
        fitted = fit @ values
        area = self._sizes.sum(axis=1)[:, None] * shapes.any(axis=1)  # of the element, at each of its unknowns
        total = np.zeros((self._stressed.ndof, values.shape[-1]))
        weight = np.bincount(unknowns.ravel(), area.ravel(), minlength=len(total))
        for k in range(values.shape[-1]):
            total[:, k] = np.bincount(unknowns.ravel(), (fitted[..., k] * area).ravel(), minlength=len(total))
        return total / weight[:, None]

    @cached_property
    def _smooth(self) -> tuple[Index, Array, Array]:
        """Unknowns and shape functions of the volumetric stress, and their least-squares fit to the points."""
        unknowns, shapes, _ = self._cells.shapes(self._stressed)
        return unknowns, shapes, np.linalg.pinv(shapes * self._cells.real[..., None])

    def stiffness(self, tangent: Array) -> Array:
        """Element matrices, shape (elements, n, n), of d stress / d strain, (elements, points, strains, strains)."""
        return self._elements.stiffness(tangent)
