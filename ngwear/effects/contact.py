"""Unilateral contact with a rigid surface, wear as a compliance included."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import DISPLACEMENT, Term, Unknowns
from ngwear.effects.contact_profile import ContactProfile
from ngwear.geometry.body import Body
from ngwear.surfaces import RigidSurface

Array = NDArray[np.float64]


class Contact(Term):
    """Contact pressure as an unknown on named edges: ``0 <= P  _|_  g(X + u) + kappa P / (da/dA) >= 0``.

    P is the nominal (first Piola) pressure, discontinuous and linear on each mesh edge; g the signed
    distance from the surface. ``kappa = k ds`` is the implicit Archard step of a specific wear rate k
    [mm²/N] over a sliding distance ds [mm]: the depth kappa P is worn per reference area while the gap
    closes by kappa p with the Cauchy pressure p = P / (da/dA). The stretch da/dA in the gap is that of
    the state from which the solve starts; the depth itself is exact.

    The energy is the augmented Lagrangian ``1/(2c) [ max(0, P - c g)^2 / (1 + c kappa) - P^2 ]`` (Alart &
    Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353, with the compliance added): symmetric, exact
    for every c > 0, and semismooth under Newton.

    A surface may move along its ``approach`` by the load ``"NAME approach [mm]"``; under force control
    (``force_controlled=True``) that displacement is an unknown and the load is ``"NAME force [N]"`` (N per
    mm of thickness in plane strain). One that slides (``slides=True``) also moves across, along its approach turned
    by +90 degrees, by the load ``"NAME slide [mm]"``.

    Parameters
    ----------
    name : str
    edges : sequence of str
        Names of the edges that may touch.
    surface : RigidSurface
    force_controlled, slides : bool
    modulus : float
        Shear modulus G of the body [MPa]. With the length h of a mesh edge it sets the scales of the method,
        not of the solution: ``1/c = softness h / (2 G) + kappa``, and a compliance of 1e-6 h / G (a closure of
        1e-6 h at P = G) that keeps the pivots of the factorisation away from zero.

    Attributes
    ----------
    softness : ng.Parameter
        Divides c, 1 at first. With a large c gaps decide where there is contact, and flat faces soon agree on
        it; with a small one pressures do, and large steps into a strongly curved contact do not stall.
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
        super().__init__()
        self.name, self.edges, self.surface = name, tuple(edges), surface
        self.force_controlled = force_controlled
        self.modulus = modulus
        self.softness = ng.Parameter(1.0)
        self.compliance = ng.Parameter(0.0)
        self.load = ng.Parameter(0.0)
        self._length = ng.Parameter(1.0)  # of the whole outline as it is meshed and worn [mm]
        kind = "force [N]" if force_controlled else "approach [mm]"
        self.loads = {f"{name} {kind}": self.load}
        self.slid: ng.Parameter | float = 0.0
        if slides:
            self.slid = self.loads[f"{name} slide [mm]"] = ng.Parameter(0.0)

    @property
    def pressure_name(self) -> str:
        """Name of the nominal pressure among the unknowns."""
        return f"{self.name} pressure"

    @property
    def travel_name(self) -> str:
        """Name of the surface's displacement among the unknowns, under force control."""
        return f"{self.name} approach"

    def spaces(self, body: Body) -> dict[str, ng.FESpace]:
        region = body.boundary(self.edges)
        spaces: dict[str, ng.FESpace] = {
            self.pressure_name: ng.Compress(ng.SurfaceL2(body.mesh, order=1, definedon=region))
        }
        if self.force_controlled:
            spaces[self.travel_name] = ng.NumberSpace(body.mesh)
        return spaces

    def place(self, fields: dict[str, Any]) -> tuple[Any, Any]:
        """Coordinates of X + u in the frame of the moving surface, for trial functions or a state."""
        u = fields[DISPLACEMENT]
        travel = fields[self.travel_name] if self.force_controlled else self.load
        ax, ay = self.surface.approach
        return ng.x + u[0] - travel * ax + self.slid * ay, ng.y + u[1] - travel * ay - self.slid * ax

    def gap(self, fields: dict[str, Any]) -> Any:
        """Signed distance of the deformed outline from the surface [mm]."""
        return self.surface.gap(*self.place(fields))

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        region = unknowns.body.boundary(self.edges)
        kinematics = unknowns.kinematics
        self._body, self._region = unknowns.body, region
        self._start = ng.GridFunction(unknowns.state[DISPLACEMENT].space)
        stretch = kinematics.area_stretch(self._start, ng.Grad(self._start))
        give = self._edge_lengths(unknowns.body) / self.modulus
        self._augmentation = c = 1 / (0.5 * self.softness * give + self.compliance)
        p = unknowns.trial[self.pressure_name]
        pushed = p - c * self.gap(unknowns.trial)
        closure = 1 + c * (1e-6 * give + self.compliance / stretch)
        active = ng.IfPos(pushed, pushed * pushed / closure, 0.0)
        energy = (active - p * p) / (2 * c) * kinematics.weight
        form += ng.Variation(energy.Compile() * ng.ds(definedon=region, bonus_intorder=2))
        if self.force_controlled:
            # A constant energy density over the outline adds up to - force * travel.
            everywhere = unknowns.body.mesh.Boundaries(".*")
            travel = unknowns.trial[self.travel_name]
            form += ng.Variation(-self.load * travel / self._length * ng.ds(definedon=everywhere))

        self._state, self._kinematics = unknowns.state, kinematics
        self._lay_samples(unknowns.body, region)
        self._measure()

    def _edge_lengths(self, body: Body) -> ng.GridFunction:
        """Length of each mesh edge as it was made: constant on it, so that P adds up to what the gap asks for."""
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

    def force(self) -> Array:
        """Resultant of the contact pressure on the rubber; shape (2,) [N], or N/mm in plane strain."""
        p = self._state[self.pressure_name]
        nx, ny = self.surface.normal(*self.place(self._state))
        measure = ng.ds(definedon=self._region, bonus_intorder=2)
        weight = self._kinematics.weight
        return np.array([ng.Integrate(p * n * weight * measure, self._body.mesh) for n in (nx, ny)])

    def prepare(self) -> None:
        self._start.vec.data = self._state[DISPLACEMENT].vec
        self._measure()
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

    def _measure(self) -> None:
        """Length of the outline as the mesh has it now, curved and worn."""
        if self.force_controlled:
            everywhere = self._body.mesh.Boundaries(".*")
            self._length.Set(ng.Integrate(ng.CF(1.0) * ng.ds(definedon=everywhere), self._body.mesh))
