"""Viscoelastic history on a mesh that never changes: fixed points of the unworn section."""

from __future__ import annotations

from typing import Any

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.fields.kinematics import Kinematics
from ngwear.fields.locator import Locator
from ngwear.fields.material_points import MaterialPoints
from ngwear.geometry.body import Body
from ngwear.geometry.meshed import Meshed

Array = NDArray[np.float64]
RULE = 6  # order of the rule: 12 points a triangle; with 6 the fit is unstable


class Background:
    """Integration points of a mesh of the unworn section, twelve in each triangle.

    Material points do not move in the reference configuration, and the worn section is a part of the unworn one: the
    history stored here is never transferred to another mesh and does not diffuse.

    Parameters
    ----------
    body : Body
        Unmoved, as it was meshed; with elements as small as those of the contact patch wherever the contact may come.

    Attributes
    ----------
    places : array, shape (elements, 12, 2)
        Reference coordinates of the points [mm].
    areas : array, shape (elements, 12)
        Section area that belongs to each [mm²].
    """

    def __init__(self, body: Body) -> None:
        self.body = body
        rule = ng.IntegrationRule(ng.TRIG, RULE)
        points = body.mesh.MapToAllElements(rule, ng.VOL)
        self.shape = (body.mesh.ne, len(rule.points))
        self.places = np.stack([np.asarray(c(points)) for c in (ng.x, ng.y)], axis=-1).reshape(*self.shape, 2)
        jacobian = np.asarray(ng.specialcf.JacobianMatrix(2)(points)).reshape(*self.shape, 2, 2)
        self.areas = np.array(rule.weights) * np.abs(np.linalg.det(jacobian))
        self._fit = np.linalg.pinv(_quadratic(*np.array(rule.points)[:, :2].T))

    def to_data(self) -> dict[str, Any]:
        """Data from which ``from_data`` restores the background exactly."""
        return {"body": self.body}

    @classmethod
    def from_data(cls, data: dict[str, Any]) -> Background:
        """Restore the background."""
        return cls(data["body"])

    def fitted(self, values: Array) -> Array:
        """Coefficients of the quadratic in each element, by least squares; shape (elements, 6, k)."""
        return self._fit @ values


class Seat:
    """A body on a background: positions of the points of each in the mesh of the other.

    Parameters
    ----------
    background : Background
    body : Meshed
    kinematics : Kinematics
    points : MaterialPoints
        Of the body.
    displacement : GridFunction
        Of the body's problem.
    """

    def __init__(
        self,
        background: Background,
        *,
        body: Meshed,
        kinematics: Kinematics,
        points: MaterialPoints,
        displacement: ng.GridFunction,
    ) -> None:
        self.background, self.body, self.points = background, body, points
        self._weight = 2 * np.pi * background.places[..., 1] if kinematics.axisymmetric else 1.0
        self._gradient, self._hoop = ng.Grad(displacement), kinematics.hoop_stretch(displacement)
        self._places = background.places.reshape(-1, 2)
        self._on_body = Locator(body.mesh, self._places)
        # Both start from the body as it was meshed, so that a resumed run gives exactly the same numbers.
        active = body.mesh.deformation
        body.mesh.UnsetDeformation()
        self._on_background = Locator(background.body.mesh, points.places.reshape(-1, 2))
        if active is not None:
            body.mesh.SetDeformation(active)
        self._moves = -1

    def _follow(self) -> None:
        """Find the points anew if the outline has moved."""
        if self._moves != self.body.moves:
            self._moves = self.body.moves
            self._on_body.follow(self._places)
            self._on_background.follow(self.points.places.reshape(-1, 2))

    @property
    def volumes(self) -> Array:
        """Reference volume that belongs to each of the background's points, shape (elements, 12); 0 if worn away."""
        self._follow()
        return self.background.areas * self._weight * self._on_body.inside.reshape(self.background.shape)

    def strain(self) -> Array:
        """Strain at the background's points, as ``MaterialPoints`` has it, without the volumetric stress.

        Shape (elements, 12, 6); at a point that is worn away, that of the nearest one left.
        """
        self._follow()
        strain = np.zeros((len(self._places), 6))
        strain[:, :4] = np.asarray(self._gradient(self._on_body.mapped))
        strain[:, 4] = np.asarray(self._hoop(self._on_body.mapped)).ravel() - 1
        return strain.reshape(*self.background.shape, 6)

    def at_points(self, values: Array) -> Array:
        """Values given at the background's points, shape (elements, 12, k), at the body's material points."""
        self._follow()
        found = self._on_background.mapped
        terms = _quadratic(found["x"], found["y"])
        here = np.einsum("nj,njk->nk", terms, self.background.fitted(values)[found["nr"]])
        return here.reshape(*self.points.volumes.shape, -1)


def _quadratic(x: Array, y: Array) -> Array:
    """Monomials up to order 2, shape (n, 6)."""
    return np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=-1)
