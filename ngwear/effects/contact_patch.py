"""Contact on a face of a solid."""

from __future__ import annotations

from dataclasses import dataclass

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import DISPLACEMENT, Unknowns
from ngwear.effects.unilateral import COORDINATES, UnilateralContact
from ngwear.geometry.meshed import Meshed

Array = NDArray[np.float64]
# Settled on the pin (``verify error_estimates indentation``): a paraboloid fits near its top only.
NEAR_PEAK = 0.8  # of the highest pressure: faces through whose pressures the paraboloid is laid
LOADED = 1e-3  # of the highest pressure: below, a face at the edge bears what the mesh makes of nothing
FEWEST = 12  # of the faces near the peak, for its six coefficients: twice as many


@dataclass(frozen=True)
class Faces:
    """Contact pressure on the faces of the mesh.

    Attributes
    ----------
    corners, undeformed : array, shape (n, 3, 3)
        Deformed and reference coordinates of the corners [mm].
    pressure : array, shape (n,)
        Cauchy pressure [MPa].
    """

    corners: Array
    undeformed: Array
    pressure: Array

    @property
    def reference(self) -> Array:
        """Reference coordinates of the centres, shape (n, 3) [mm]."""
        return self.undeformed.mean(axis=1)

    @property
    def loaded(self) -> NDArray[np.bool_]:
        """Whether the pressure is above a thousandth of the highest one, shape (n,)."""
        return self.pressure > LOADED * self.pressure.max(initial=0.0)

    @property
    def areas(self) -> Array:
        """Areas as deformed, shape (n,) [mm²]."""
        return _areas(self.corners)

    @property
    def reference_areas(self) -> Array:
        """Areas as undeformed, shape (n,) [mm²]."""
        return _areas(self.undeformed)

    @property
    def peak(self) -> float:
        """Highest Cauchy pressure [MPa], smoothed over the faces near the peak.

        It is the maximum of a paraboloid, fitted to the squares of the pressures above 0.8 of the highest one, weighted
        by area (the square of Hertz's pressure is a paraboloid). Pressures of single faces scatter by one per cent and
        more with the mesh, and their maximum is biased upwards. With fewer than twelve such faces, or without a maximum
        among them, it is the highest pressure of a face.
        """
        highest = float(self.pressure.max(initial=0.0))
        on = self.pressure > NEAR_PEAK * highest
        if on.sum() < FEWEST:
            return highest
        weight = self.areas[on]
        place = self.corners[on].mean(axis=1)[:, :2]
        place = (place - np.average(place, axis=0, weights=weight)) / place.std()
        x, y = place.T
        terms = np.column_stack([np.ones_like(x), x, y, x * x, x * y, y * y])
        root = np.sqrt(weight)
        c, *_ = np.linalg.lstsq(terms * root[:, None], self.pressure[on] ** 2 * root, rcond=None)
        curvature = np.array([[2 * c[3], c[4]], [c[4], 2 * c[5]]])
        if not np.linalg.eigvalsh(curvature).max() < 0:
            return highest
        top = np.linalg.solve(curvature, -c[1:3])
        if np.linalg.norm(top) > np.linalg.norm(place, axis=1).max():
            return highest
        return float(np.sqrt(c[0] + 0.5 * c[1:3] @ top))


class PatchContact(UnilateralContact):
    """Contact on named faces of a solid; the nominal pressure is constant on each mesh face.

    With displacements of order 2 a linear pressure is worse: a continuous one oscillates over several elements beyond
    the contact's edge; a discontinuous one has three unknowns per triangle, the displacement only two, and does not
    converge.
    """

    def pressure_space(self, body: Meshed) -> ng.FESpace:
        return ng.Compress(ng.SurfaceL2(body.mesh, order=0, definedon=body.boundary(self.edges)))

    def lengths(self, unknowns: Unknowns) -> ng.GridFunction:
        body = unknowns.body
        space = ng.SurfaceL2(body.mesh, order=0)
        field = ng.GridFunction(space)
        areas = np.array(ng.Integrate(ng.CF(1.0), body.mesh, ng.BND, element_wise=True))
        dofs = [space.GetDofNrs(ng.ElementId(ng.BND, i))[0] for i in range(len(areas))]
        field.vec.FV().NumPy()[dofs] = np.sqrt(areas)
        return field

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        super().add_to(form, unknowns)
        mesh, space = unknowns.body.mesh, self._state[self.pressure_name].space
        rule = ng.IntegrationRule([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1 / 3, 1 / 3)], [0.25] * 4)
        self._points = mesh.MapToAllElements(rule, self._region)
        numbers = self._points.reshape(-1, 4)["nr"][:, 0]
        self._dofs = np.array([space.GetDofNrs(ng.ElementId(ng.BND, int(nr)))[0] for nr in numbers])

    def _sample(self, field: ng.CoefficientFunction) -> Array:
        """Values at three corners and the centre of each face, shape (n, 4)."""
        return np.broadcast_to(np.asarray(field(self._points)).reshape(-1), (len(self._points),)).reshape(-1, 4)

    def sample_middles(self, field: ng.CoefficientFunction) -> Array:
        """Values at the centre of each face, shape (n,)."""
        return self._sample(field)[:, 3]

    def faces(self) -> Faces:
        """Pressures and places of the present state."""
        u = self._state[DISPLACEMENT]
        undeformed = np.stack([self._sample(c) for c in COORDINATES], axis=-1)
        moved = undeformed + np.stack([self._sample(u[i]) for i in range(3)], axis=-1)
        stretch = self._sample(self._kinematics.area_stretch(u, ng.Grad(u)))[:, 3]
        nominal = self._state[self.pressure_name].vec.FV().NumPy()[self._dofs]
        return Faces(moved[:, :3], undeformed[:, :3], np.maximum(nominal, 0.0) / stretch)

    def peak(self) -> float:
        return float(self.faces().pressure.max(initial=0.0))

    def deformed(self, places: Array) -> Array:
        """Deformed coordinates of places of the reference faces, both of shape (n, 3) [mm]."""
        return places + np.asarray(self._state[DISPLACEMENT](self._body.mesh(*places.T, ng.BND)))

    def take_pressure(self, other: PatchContact) -> None:
        """Take over the nominal pressure of another contact on the same faces with another mesh, as a start value."""
        centres = [self._sample(c)[:, 3] for c in COORDINATES]
        old = other._state[other.pressure_name]
        there = other._body.mesh(*centres, ng.BND)
        self._state[self.pressure_name].vec.FV().NumPy()[self._dofs] = np.asarray(old(there)).ravel()

    def turning(self, traction: tuple[ng.CoefficientFunction, ...]) -> float:
        """Moment about the track's axis of a traction per nominal pressure, over the track's radius [N].

        The force along the track that would do the same work; on a straight track the resultant along x.
        """
        motion = self.surface.motion(*self.place(self._state))
        return self._loaded(sum(t * m for t, m in zip(traction, motion, strict=True)))

    def slipping(self, traction: tuple[ng.CoefficientFunction, ...]) -> float:
        """Work of a traction per nominal pressure on the slip past it, over the length of the track [N].

        The part's surface passes the pin at ``F V``, with V the motion of the reference surface: faster where it is
        stretched.
        """
        motion = ng.CF(self.surface.motion(*COORDINATES))
        passing = motion + ng.Grad(self._state[DISPLACEMENT]).Trace() * motion
        return self._loaded(sum(t * passing[i] for i, t in enumerate(traction)))

    def _loaded(self, density: ng.CoefficientFunction) -> float:
        measure = ng.ds(definedon=self._region, bonus_intorder=2)
        return ng.Integrate(self._state[self.pressure_name] * density * measure, self._body.mesh)

    def resistance(self) -> float:
        """Force along the track that the pressure puts on the part [N]."""
        return self.turning(self.surface.normal(*self.place(self._state)))


def _areas(corners: Array) -> Array:
    a, b, c = np.moveaxis(corners, 1, 0)
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
