"""Contact along the outline of a section."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import DISPLACEMENT, Unknowns
from ngwear.effects.contact_profile import ContactProfile, EdgeNodes, nodal_pressure
from ngwear.effects.unilateral import UnilateralContact
from ngwear.fields.displacements import at_vertices
from ngwear.geometry.meshed import Meshed
from ngwear.geometry.meshed_section import MeshedSection
from ngwear.geometry.outline import Outline
from ngwear.surfaces import RigidSurface, WornProfile

Array = NDArray[np.float64]
BESIDE = 3  # mesh edges from a loaded one to which its smoothed pressure reaches (``Ripples``)
ENDS = ng.IntegrationRule([(0.0,), (1.0,)], [0.5, 0.5])


class OutlineContact(UnilateralContact):
    """Contact on named edges of an outline; the nominal pressure is discontinuous and linear on each mesh edge.

    A surface that slides (``slides=True``) also moves across its approach, turned by +90 degrees, by the load
    ``"NAME slide [mm]"``; all else as in ``UnilateralContact``.

    With displacements of order 1 (``order``) it is continuous: a discontinuous one would have two unknowns per mesh
    edge, but the outline has only one displacement per node. The contact law then holds at each node; integrated along
    the edges it would leave small pressures of both signs at open nodes. With order 3 it is linear as with order 2: at
    the contact's end the pressure falls as a square root, which a higher polynomial does not approximate better.

    With ``wears`` a depth ``worn`` can be set, which is worn in the same step independent of the pressure.

    A surface that is worn itself (``counter``, an attribute that may be replaced between solves) lies back by the depth
    of its profile, which has moved along the surface's tangent by ``turned`` [mm]. A solve takes the depth at the
    contact points of its start state, and the normal of the unworn surface. So the profile must be shallow and change
    little along the tangential displacement of a solve.

    Attributes
    ----------
    section : MeshedSection
        Section of the contact, set when the term is added to a form.
    """

    section: MeshedSection

    def __init__(
        self,
        name: str,
        edges: Sequence[str],
        surface: RigidSurface,
        *,
        force_controlled: bool = False,
        slides: bool = False,
        counter: WornProfile | None = None,
        wears: bool = False,
        modulus: float,
        order: int = 2,
    ) -> None:
        super().__init__(name, edges, surface, force_controlled=force_controlled, modulus=modulus)
        self.order = order
        self.counter, self.turned, self.wears = counter, 0.0, wears
        self.only_near = False
        self.slid: ng.Parameter | None = None
        if slides:
            self.slid = self.loads[f"{name} slide [mm]"] = ng.Parameter(0.0)

    def motion(self, fields: dict[str, Any]) -> tuple[Any, ...]:
        x, y = super().motion(fields)
        if self.slid is None:
            return x, y
        ax, ay = self.surface.approach
        return x - self.slid * ay, y + self.slid * ax

    def pressure_space(self, body: Meshed) -> ng.FESpace:
        space = ng.H1 if self.order == 1 else ng.SurfaceL2
        return ng.Compress(space(body.mesh, order=1, definedon=body.boundary(self.edges)))

    def measure(self, **where: Any) -> Any:
        if self.order == 1:
            return ng.ds(definedon=self._region, intrules={ng.SEGM: ENDS}, **where)
        return super().measure(**where)

    def gap(self, fields: dict[str, Any]) -> Any:
        gap = super().gap(fields)
        return gap if self.counter is None else gap + self._stands_back

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        self.section = unknowns.section
        if self.only_near:
            self.near = ng.BitArray(self.section.mesh.GetNE(ng.BND))
        if self.counter is not None:
            self._stands_back = ng.GridFunction(unknowns.state[self.pressure_name].space)
        if self.wears:
            self.worn = ng.GridFunction(unknowns.state[self.pressure_name].space)
        super().add_to(form, unknowns)
        self._place_samples(self.section, self._region)
        self._look_anew()

    def lengths(self, unknowns: Unknowns) -> ng.GridFunction:
        body = unknowns.section
        line = body.outline
        ends = body.base.at(line.t.ravel()).reshape(-1, 2, 2)
        space = ng.SurfaceL2(body.mesh, order=0)
        field = ng.GridFunction(space)
        dofs = [space.GetDofNrs(ng.ElementId(ng.BND, int(nr)))[0] for nr in line.element]
        field.vec.FV().NumPy()[dofs] = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        return field

    def gather(self) -> None:
        super().gather()
        if self.near is not None:
            self._look_near(self.near)

    def _look_anew(self) -> None:
        """Forget which edges may touch."""
        if self.near is not None:
            self.near.Clear()
            self._seen, self._ends = np.zeros(len(self.positions), dtype=bool), self.end_places().transpose(2, 0, 1)
            self._spread = self._seen.copy()

    def _look_near(self, near: ng.BitArray) -> None:
        """Add the edges to ``near`` that may touch, or carry pressure, in the present state; none leaves in a solve.

        The gap is a distance: no point of an edge is nearer to the surface than its nearer end less the edge's length.
        """
        place = self.vertices_in_frame()
        lengths = np.hypot(*(place[:, :, 1] - place[:, :, 0]))
        rounded = 0.0 if self.rounding is None else self.rounding.relative
        reach = (1 + rounded * self.softness.Get()) * lengths + rounded * self.modulus * self.compliance.Get()
        pressure = self._state[self.pressure_name].vec.FV().NumPy()[self._end_shapes[0]]
        found, loaded = self.surface.gap(*place).min(axis=1) < reach, pressure.any(axis=1)
        if (loaded & ~self._spread).any():
            self._spread |= loaded
            for shift in range(-BESIDE, BESIDE + 1):  # a superset does no harm where the edges are not one piece
                found |= np.roll(loaded, shift)
        for element in self.section.outline.element[self.positions[found & ~self._seen]]:
            near.Set(int(element))
        self._seen |= found

    def vertices_in_frame(self) -> Array:
        """As ``ends_in_frame``, from the unknowns at the mesh vertices, which takes less time; if there is ``near``."""
        displacement = self._state[DISPLACEMENT].vec.FV().NumPy()[self._end_unknowns]
        place: Array = self._ends + displacement - np.reshape(self.stands(), (2, 1, 1))
        return place

    @cached_property
    def _end_unknowns(self) -> NDArray[np.intp]:
        """Unknowns of the displacement at both ends of each mesh edge, which are mesh vertices; shape (2, m, 2)."""
        return at_vertices(self._state[DISPLACEMENT].space, self.section.outline.vertices[self.positions])

    def stands(self) -> tuple[float, float]:
        travel = self._state[self.travel_name].vec[0] if self.force_controlled else self.load.Get()
        slid = 0.0 if self.slid is None else self.slid.Get()
        ax, ay = self.surface.approach
        return travel * ax - slid * ay, travel * ay + slid * ax

    def _place_samples(self, body: MeshedSection, region: ng.Region) -> None:
        """Mapped points at both ends and in the middle of each mesh edge in contact, in the order of the outline."""
        line = body.outline
        self.positions = line.on(self.edges)
        self.nodes = EdgeNodes.on(body, self.positions)
        self._measured: tuple[Outline, Array] | None = None
        points = body.mesh.MapToAllElements(ENDS, region)
        row = {int(nr): k for k, nr in enumerate(points["nr"][::2])}
        rows = np.array([row[int(nr)] for nr in line.element[self.positions]])
        points = points.reshape(-1, 2)[rows]
        place = np.stack([ng.x(points.ravel()), ng.y(points.ravel())], axis=-1).reshape(-1, 2, 2)
        start = body.contour.at(line.t[self.positions, 0])
        turned = np.linalg.norm(place[:, 0] - start, axis=1) > np.linalg.norm(place[:, 1] - start, axis=1)
        points[turned] = points[turned][:, ::-1]
        self._points = np.ascontiguousarray(points.ravel())
        middle = ng.IntegrationRule([(0.5,)], [1.0])
        self._middles = np.ascontiguousarray(body.mesh.MapToAllElements(middle, region)[rows])

    def _sample(self, field: ng.CoefficientFunction) -> Array:
        return np.asarray(field(self._points)).reshape(-1, 2)

    def profile(self) -> ContactProfile:
        """Pressures, places and gaps at the mesh nodes of the named edges, in the order of the outline."""
        u = self._state[DISPLACEMENT]
        stretch, gap = self._kinematics.area_stretch(u, ng.Grad(u)), self.gap(self._state)
        return ContactProfile.from_samples(
            self.nodes,
            self.section.contour,
            self._lengths(),
            pressure=self.end_pressures(),
            stretch=self._sample(stretch),
            place=np.stack([self._sample(ng.x + u[0]), self._sample(ng.y + u[1])], axis=-1),
            gap=self._sample(gap),
            middle_gap=self.sample_middles(gap),
            nodal=self.order == 1,
        )

    def edge_peaks(self) -> Array:
        """Highest Cauchy pressure at the ends of each mesh edge, in the order of the outline, shape (m,) [MPa]."""
        profile = self.profile()
        peaks: Array = profile.pressure[profile.edges].max(axis=1)
        return peaks

    def nodal_pressure(self) -> Array:
        """Nominal pressure at the nodes of ``profile`` [MPa]."""
        nominal, _, _ = nodal_pressure(self.nodes, self._lengths(), self.end_pressures(), nodal=self.order == 1)
        return nominal

    def _lengths(self) -> Array:
        """Present lengths of the mesh edges [mm], as used to integrate forces.

        Lengths by the outline's spline would give loads that differ by 1e-6 where a worn arc ends in a kink.
        """
        if self._measured is None or self._measured[0] is not self.section.contour:
            whole = ng.Integrate(
                ng.CF(1.0), self.section.mesh, ng.BND, definedon=self._region, order=6, element_wise=True
            )
            lengths = np.asarray(whole)[self.section.outline.element[self.positions]]
            self._measured = self.section.contour, lengths
        return self._measured[1]

    def peak(self) -> float:
        return float(self.profile().pressure.max(initial=0.0))

    def ends_in_frame(self) -> Array:
        """Coordinates X + u of both ends of each mesh edge in the frame of the surface; shape (2, m, 2) [mm]."""
        return np.array([self._sample(ng.CF(p)) for p in self.place(self._state)])

    def along(self) -> Array:
        """Coordinates of both ends of each mesh edge along the surface, in its own frame; shape (m, 2) [mm]."""
        return self.surface.along(*self.ends_in_frame()) + self.turned

    def imprint(self) -> tuple[Array, Array]:
        """Where along the surface each mesh edge touches it, and the pressure on it; each of shape (m, 2) [mm], [MPa].

        The pressure is linear along each mesh edge; its integral over the surface is the sum of the profile's loads, in
        axisymmetry per circumference there.
        """
        profile, ends = self.profile(), self.along()
        stretch = np.abs(np.diff(ends, axis=1)) / self._lengths()[:, None]
        pressure = profile.load / profile.weight
        if self._kinematics.axisymmetric:
            pressure = pressure * profile.reference[:, 1] / profile.place[:, 1]
        return ends, pressure[profile.edges] / stretch

    def end_places(self) -> Array:
        """Reference coordinates of both ends of each mesh edge, in the order of the outline; shape (m, 2, 2)."""
        return self.section.contour.at(self.section.outline.t[self.positions].ravel()).reshape(-1, 2, 2)

    def end_pressures(self) -> Array:
        """Nominal pressure at both ends of each mesh edge, as the unknown has it; shape (m, 2) [MPa]."""
        return self._sample(self._state[self.pressure_name])

    def pressure_vector(self, ends: Array) -> Array:
        """Unknowns of a nominal pressure given at both ends of each mesh edge; ``ends`` of shape (m, 2) [MPa]."""
        field = ng.GridFunction(self._state[self.pressure_name].space)
        self._interpolate(field, ends)
        return field.vec.FV().NumPy().copy()

    def _interpolate(self, field: ng.GridFunction, ends: Array) -> None:
        """Give a field of the pressure's space its values at both ends of each mesh edge, shape (m, 2)."""
        dofs, shapes = self._end_shapes
        vector = field.vec.FV().NumPy()
        vector[:] = 0.0
        vector[dofs] = np.linalg.solve(shapes, ends[..., None])[..., 0]

    @cached_property
    def _end_shapes(self) -> tuple[NDArray[np.intp], Array]:
        """Pressure unknowns of each mesh edge, shape (m, 2), and their shape functions at its ends, (m, 2, 2)."""
        space = self._state[self.pressure_name].space
        elements = [ng.ElementId(ng.BND, int(nr)) for nr in self.section.outline.element[self.positions]]
        dofs = np.array([space.GetDofNrs(element) for element in elements])
        ends = self._points["x"].reshape(-1, 2)  # on the reference element
        vertices = self.section.outline.vertices[self.positions]
        known: dict[tuple[bool, float], list[Array]] = {}  # by the order of the vertices' numbers, and the direction
        shapes = []
        for element, pair, (first, last) in zip(elements, ends, vertices, strict=True):
            kind = (bool(first < last), float(pair[0]))
            if kind not in known:
                known[kind] = [space.GetFE(element).CalcShape(x) for x in pair]
            shapes.append(known[kind])
        return dofs, np.array(shapes)

    def set_worn(self, depth: Array) -> None:
        """Set the depth at the outline's points [mm] that the next solve wears independent of P, if ``worn`` exists."""
        if self.worn is not None:
            self._interpolate(self.worn, self._along_outline(depth))

    def _along_outline(self, values: Array) -> Array:
        ends = self.section.outline.t[self.positions]
        return np.interp(ends, np.arange(len(values) + 1), np.append(values, values[0]))

    def sample_middles(self, field: ng.CoefficientFunction) -> Array:
        return np.asarray(field(self._middles)).ravel()

    def edge_values(self, field: ng.GridFunction) -> Array:
        """Values of a field that is constant on each mesh edge, in the order of the outline; shape (m,)."""
        return self._sample(field)[:, 0]

    def set_edge_values(self, field: ng.GridFunction, values: Array) -> None:
        """Inverse of ``edge_values``: set the values of such a field."""
        elements = self.section.outline.element[self.positions]
        dofs = [field.space.GetDofNrs(ng.ElementId(ng.BND, int(nr)))[0] for nr in elements]
        field.vec.FV().NumPy()[dofs] = values

    def set_share(self, values: Array | float) -> None:
        """Give ``share``, if there is one, its values at the nodes of ``profile``."""
        if self.share is None:
            return
        vertices = self.section.outline.vertices[self.positions]
        self.share.vec.FV().NumPy()[vertices] = np.broadcast_to(values, len(self.nodes.t))[self.nodes.of_edges]

    def at_nodes(self, field: ng.CoefficientFunction) -> Array:
        """Values of a field at the nodes of ``profile``, averaged over the edges that meet there."""
        return self.nodes.average(self._sample(field))

    def edges_to_nodes(self, values: Array) -> Array:
        """Slip of the mesh edges at the nodes of ``profile``: harmonic means of the edges that meet there.

        A node of an edge that sticks does not slip. If it were worn, the edge would lose its pressure and slip next,
        and the stick zone would vanish edge by edge.
        """
        resistance = 1 / np.maximum(np.column_stack([values, values]), 1e-300)
        return 1 / self.nodes.average(resistance)

    def least_stretch(self) -> tuple[float, Array]:
        """Least stretch da/dA of the named edges, and the reference place of that mesh edge's middle [mm]."""
        u = self._state[DISPLACEMENT]
        stretch = self.sample_middles(self._kinematics.area_stretch(u, ng.Grad(u)))
        return float(stretch.min()), self.end_places()[int(stretch.argmin())].mean(axis=0)

    def touching(self) -> NDArray[np.bool_]:
        """Which of the mesh edges in ``positions`` carry pressure."""
        return self.end_pressures().mean(axis=1) > 1e-6 * self.modulus  # above what rounding leaves, below any load

    def prepare(self) -> None:
        super().prepare()
        self._look_anew()
        if self.counter is not None:
            self._interpolate(self._stands_back, self.counter.at(self.along()))
        if self.force_controlled:
            self._follow()

    def _follow(self) -> None:
        """Move a surface under force that has lost contact (the part has worn) to the points that carried its load."""
        gap, pressure = self._sample(self.gap(self._state)), self.end_pressures()
        carried = np.maximum(pressure, 0.0)
        still = np.maximum(pressure - self._sample(self._augmentation) * gap, 0.0)
        if not carried.any() or still.sum() > 0.1 * carried.sum():  # a tenth in touch is stiff enough for Newton
            return
        ax, ay = self.surface.approach
        nx, ny = (self._sample(ng.CF(n)) for n in self.surface.normal(*self.place(self._state)))
        closing = nx * ax + ny * ay  # of the gap per travel
        self._state[self.travel_name].vec[0] += (carried * gap).sum() / (carried * closing).sum()
