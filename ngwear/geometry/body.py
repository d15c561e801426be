"""A body: its outline, the mesh made from it, and the map between the two."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.errors import MeshError
from ngwear.geometry import nodal, saved_mesh, section
from ngwear.geometry.harmonic import HarmonicFill
from ngwear.geometry.meshed_section import BoundaryEdges, MeshedSection
from ngwear.geometry.outline import Array, Outline
from ngwear.geometry.sizing import SizeField, fitted, mesh_nodes

# A quadratic edge that turns by 0.5 rad loses 4e-4 of a disc's area, one of half the turn a sixteenth of that.
FINER = (1.0, 2.0, 4.0)  # how much less the outline may turn along an element edge: a curved one cuts its corner


class Body(MeshedSection):
    """A meshed section whose outline can move a little without a new mesh.

    ``base`` is the outline that was meshed, ``contour`` the present one: it has the same points,
    displaced. The mesh follows by a harmonic extension of the outline's displacement, set as the mesh's
    deformation, so that x, y, dx and ds refer to the present outline.

    Parameters
    ----------
    contour : Outline
    field : SizeField
        Wanted element edges.
    on_chord : bool
        Insert the points that the field requires on the polygon, so that its area does not change.

    Raises
    ------
    MeshError
        If the new mesh does not pass its checks.
    """

    def __init__(self, contour: Outline, field: SizeField, *, on_chord: bool = False) -> None:
        self.field = field
        self.base = self.contour = fitted(contour, field, on_chord=on_chord)
        self.mesh, self.nodes = _meshed(self.base, field)
        self._set_up()

    def _set_up(self) -> None:
        self.outline = _outline(self.mesh, self.base)
        self.deformation = ng.GridFunction(ng.VectorH1(self.mesh, order=2))

    def to_data(self) -> dict[str, Any]:
        """Data from which ``from_data`` restores the body exactly."""
        return {
            "field": self.field,
            "base": self.base,
            "contour": self.contour,
            "nodes": self.nodes,
            "mesh": saved_mesh.as_arrays(self.mesh),
            "deformation": self.deformation.vec.FV().NumPy().copy(),
        }

    @classmethod
    def from_data(cls, data: dict[str, Any]) -> Body:
        """Restore the body; the mesh is not generated again."""
        body = cls.__new__(cls)
        body.field, body.base, body.contour, body.nodes = (data[name] for name in ("field", "base", "contour", "nodes"))
        body.mesh = saved_mesh.from_arrays(body.base, body.nodes, data["mesh"])
        body._set_up()
        body.deformation.vec.FV().NumPy()[:] = data["deformation"]
        body._deform()
        return body

    @cached_property
    def _extension(self) -> HarmonicFill:
        """Harmonic extension of one component of the outline's displacement into the undeformed mesh."""
        self.mesh.UnsetDeformation()
        space = ng.H1(self.mesh, order=2, dirichlet=".*")
        u, v = space.TnT()
        matrix = ng.BilinearForm(ng.grad(u) * ng.grad(v) / ng.specialcf.mesh_size * ng.dx).Assemble().mat
        self._deform()
        return HarmonicFill(matrix, np.fromiter(space.FreeDofs(), dtype=bool))

    def move_to(self, contour: Outline) -> None:
        displacement = contour.points - self.base.points
        controls = self.base.controls(displacement)
        line, field = self.outline, self.deformation
        before = field.vec.FV().NumPy().copy()
        for component in range(2):
            values = np.zeros(self.mesh.nv + len(self.edges))
            values[line.vertices[:, 0]] = self.base.at(line.t[:, 0], controls)[:, component]
            values[self.mesh.nv + line.edge] = self.base.at(line.t.mean(axis=1), controls)[:, component]
            field.components[component].vec.FV().NumPy()[:] = self._extension(nodal.join(values, self.edges))
        lowest = self._lowest_jacobian(field)
        if not lowest > 0.3:  # squeezed to a third, elements are soon folded: a new mesh is better
            field.vec.FV().NumPy()[:] = before
            raise MeshError(f"moving the mesh with the outline would shrink an element to {lowest:.2f} of its size")
        self.contour = contour
        self.moves += 1
        self._deform()

    def _deform(self) -> None:
        """Move the mesh to the present outline."""
        if np.any(self.contour.points != self.base.points):
            self.mesh.SetDeformation(self.deformation)
        else:
            self.mesh.UnsetDeformation()

    def _lowest_jacobian(self, field: ng.GridFunction) -> float:
        self.mesh.UnsetDeformation()
        jacobian = ng.Det(ng.Id(2) + ng.Grad(field))
        lowest = float(np.min(jacobian(self.mesh.MapToAllElements(ng.IntegrationRule(ng.TRIG, 2), ng.VOL))))
        self._deform()
        return lowest


def _meshed(contour: Outline, field: SizeField) -> tuple[ng.Mesh, NDArray[np.intp]]:
    """Mesh of an outline and its nodes, with shorter edges where it turns until the mesh passes its checks."""
    for finer in FINER:
        turn, elsewhere = field.turn / finer, field.elsewhere / finer
        closer = replace(field, turn=turn, elsewhere=elsewhere, per_radius=field.per_radius * finer)
        try:
            nodes = mesh_nodes(contour, closer)
            return section.mesh(contour, nodes, closer), nodes
        except MeshError as error:
            refused = error
    raise refused


def _outline(mesh: ng.Mesh, contour: Outline) -> BoundaryEdges:
    """Order the boundary elements along the outline and find the contour parameters of their ends."""
    points, _ = section.mesh_arrays(mesh)
    scale = contour.lengths.sum()
    elements = list(mesh.Elements(ng.BND))
    ends = np.array([[v.nr for v in el.vertices] for el in elements])
    numbers = np.array([el.nr for el in elements])
    names = np.array([el.mat for el in elements])
    edge = np.array([el.edges[0].nr for el in elements])
    used = np.unique(ends)
    parameter = np.full(mesh.nv, np.nan)
    apart = np.linalg.norm(points[used][:, None] - contour.points[None], axis=2)
    nearest = apart.argmin(axis=1)
    distance = apart[np.arange(len(used)), nearest]
    on_point = distance < 1e-9 * scale
    parameter[used[on_point]] = nearest[on_point]
    for vertex in used[~on_point]:
        parameter[vertex] = _project(contour, points[vertex], 1e-5 * scale)
    n = len(contour)
    t = parameter[ends]
    # Along the outline t grows; only the element that closes it jumps from near n back to 0.
    span = (t[:, 1] - t[:, 0]) % n
    flip = span > n / 2
    ends[flip], t[flip] = ends[flip][:, ::-1], t[flip][:, ::-1]
    t[:, 1] = np.where(t[:, 1] < t[:, 0], t[:, 1] + n, t[:, 1])
    order = np.argsort(t[:, 0])
    t = t[order]
    if not np.allclose(t[1:, 0], t[:-1, 1]) or not np.isclose(t[-1, 1], t[0, 0] + n):
        raise MeshError("the mesh's boundary does not follow the outline")
    return BoundaryEdges(numbers[order], ends[order], edge[order], t, names[order])


def _project(contour: Outline, point: Array, tolerance: float) -> float:
    """Outline parameter of a point that the mesher put on the outline."""
    a = contour.points
    b = np.roll(a, -1, axis=0)
    s = np.clip(((point - a) * (b - a)).sum(axis=1) / contour.lengths**2, 0, 1)
    gap = np.linalg.norm(a + s[:, None] * (b - a) - point, axis=1)
    segment = int(np.argmin(gap))
    t = segment + float(s[segment])
    for _ in range(20):
        slope = contour.slopes(t)[0]
        change = float((point - contour.at(t)[0]) @ slope / (slope @ slope))
        t += change
        if abs(change) < 1e-12:
            break
    off = float(np.linalg.norm(contour.at(t)[0] - point))
    if off > max(tolerance, 0.1 * contour.lengths[segment]):
        raise MeshError(f"the mesh has a boundary node at {point.tolist()}, {off:.2g} mm off the outline")
    return t % len(contour)
