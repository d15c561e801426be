"""Contact along the outline of a section."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import DISPLACEMENT, Unknowns
from ngwear.effects.contact_profile import ContactProfile
from ngwear.effects.unilateral import UnilateralContact
from ngwear.geometry.body import Body
from ngwear.surfaces import RigidSurface

Array = NDArray[np.float64]


class Contact(UnilateralContact):
    """Contact on named edges of an outline; the nominal pressure is discontinuous and linear on each mesh edge.

    A surface that slides (``slides=True``) also moves across its approach, turned by +90 degrees, by the load
    ``"NAME slide [mm]"``; all else as in ``UnilateralContact``.
    """

    def __init__(
        self,
        name: str,
        edges: Sequence[str],
        surface: RigidSurface,
        *,
        force_controlled: bool = False,
        slides: bool = False,
        modulus: float,
    ) -> None:
        super().__init__(name, edges, surface, force_controlled=force_controlled, modulus=modulus)
        self.slid: ng.Parameter | None = None
        if slides:
            self.slid = self.loads[f"{name} slide [mm]"] = ng.Parameter(0.0)

    def motion(self, fields: dict[str, Any]) -> tuple[Any, ...]:
        x, y = super().motion(fields)
        if self.slid is None:
            return x, y
        ax, ay = self.surface.approach
        return x - self.slid * ay, y + self.slid * ax

    def pressure_space(self, body: Body) -> ng.FESpace:
        return ng.Compress(ng.SurfaceL2(body.mesh, order=1, definedon=body.boundary(self.edges)))

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        super().add_to(form, unknowns)
        self._lay_samples(unknowns.body, self._region)

    def lengths(self, body: Body) -> ng.GridFunction:
        line = body.outline
        ends = body.base.at(line.t.ravel()).reshape(-1, 2, 2)
        space = ng.SurfaceL2(body.mesh, order=0)
        field = ng.GridFunction(space)
        dofs = [space.GetDofNrs(ng.ElementId(ng.BND, int(nr)))[0] for nr in line.element]
        field.vec.FV().NumPy()[dofs] = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        return field

    def _lay_samples(self, body: Body, region: ng.Region) -> None:
        """Mapped points at both ends of each mesh edge in contact, in the order of the outline."""
        line = body.outline
        self.positions = line.on(self.edges)
        rule = ng.IntegrationRule([(0.0,), (1.0,)], [0.5, 0.5])
        points = body.mesh.MapToAllElements(rule, region)
        row = {int(nr): k for k, nr in enumerate(points["nr"][::2])}
        rows = np.array([row[int(nr)] for nr in line.element[self.positions]])
        points = points.reshape(-1, 2)[rows]
        place = np.stack([ng.x(points.ravel()), ng.y(points.ravel())], axis=-1).reshape(-1, 2, 2)
        start = body.contour.at(line.t[self.positions, 0])
        turned = np.linalg.norm(place[:, 0] - start, axis=1) > np.linalg.norm(place[:, 1] - start, axis=1)
        points[turned] = points[turned][:, ::-1]
        self._points = np.ascontiguousarray(points.ravel())

    def _sample(self, field: ng.CoefficientFunction) -> Array:
        return np.asarray(field(self._points)).reshape(-1, 2)

    def profile(self) -> ContactProfile:
        """Pressures, places and gaps at the mesh nodes of the named edges, in the order of the outline."""
        u = self._state[DISPLACEMENT]
        stretch = self._kinematics.area_stretch(u, ng.Grad(u))
        return ContactProfile.from_samples(
            self._body,
            self.positions,
            pressure=self.end_pressures(),
            stretch=self._sample(stretch),
            place=np.stack([self._sample(ng.x + u[0]), self._sample(ng.y + u[1])], axis=-1),
            gap=self._sample(self.gap(self._state)),
        )

    def peak(self) -> float:
        return float(self.profile().pressure.max(initial=0.0))

    def end_places(self) -> Array:
        """Reference coordinates of both ends of each mesh edge, in the order of the outline; shape (m, 2, 2)."""
        return self._body.contour.at(self._body.outline.t[self.positions].ravel()).reshape(-1, 2, 2)

    def end_pressures(self) -> Array:
        """Nominal pressure at both ends of each mesh edge, as the unknown has it; shape (m, 2) [MPa]."""
        return self._sample(self._state[self.pressure_name])

    def pressure_vector(self, ends: Array) -> Array:
        """Unknowns of a nominal pressure given at both ends of each mesh edge; ``ends`` of shape (m, 2) [MPa]."""
        field = self._state[self.pressure_name]
        vector = field.vec.FV().NumPy()
        keep = vector.copy()
        elements = self._body.outline.element[self.positions]
        dofs = np.array([field.space.GetDofNrs(ng.ElementId(ng.BND, int(nr))) for nr in elements])
        shapes = []
        for k in range(2):
            vector[:] = 0.0
            vector[dofs[:, k]] = 1.0
            shapes.append(self._sample(field))
        out = np.zeros_like(keep)
        out[dofs] = np.linalg.solve(np.stack(shapes, axis=-1), ends[..., None])[..., 0]
        vector[:] = keep
        return out

    def at_nodes(self, field: ng.CoefficientFunction) -> Array:
        """Values of a field at the nodes of ``profile``, averaged over the edges that meet there."""
        return ContactProfile.average(self._body, self.positions, self._sample(field))

    def touching(self) -> NDArray[np.bool_]:
        """Which of the mesh edges in ``positions`` carry pressure."""
        return self.end_pressures().mean(axis=1) > 1e-6 * self.modulus

    def prepare(self) -> None:
        super().prepare()
        if self.force_controlled:
            self._follow()

    def _follow(self) -> None:
        """Move a surface under force that has lost touch (the part has worn) after the points that carried it."""
        gap, pressure = self._sample(self.gap(self._state)), self.end_pressures()
        carried = np.maximum(pressure, 0.0)
        still = np.maximum(pressure - self._sample(self._augmentation) * gap, 0.0)
        if not carried.any() or still.sum() > 0.1 * carried.sum():
            return
        ax, ay = self.surface.approach
        nx, ny = (self._sample(ng.CF(n)) for n in self.surface.normal(*self.place(self._state)))
        closing = nx * ax + ny * ay  # of the gap per travel
        self._state[self.travel_name].vec[0] += (carried * gap).sum() / (carried * closing).sum()
