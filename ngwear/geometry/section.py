"""Build named OCC splines from an outline, and a curved mesh that passes the checks of ``check``."""

from __future__ import annotations

import netgen.meshing as ngm
import netgen.occ as occ
import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.errors import MeshError
from ngwear.geometry.outline import Array, Outline
from ngwear.geometry.sizing import SizeField

MIN_ANGLE = 12.0  # degrees; the mesher usually reaches 28; errors grow as one over the sine of it
MATERIAL, CURVE = "rubber", 2  # the mesh's name for the section; order of its curves


def face(contour: Outline, nodes: NDArray[np.intp]) -> occ.Face:
    """Build the OCC face whose named spline edges join the chosen contour points.

    One edge per mesh edge puts the mesh nodes on the outline's points.
    """
    n = len(contour)
    edges, names = [], []
    for a, b in zip(nodes, np.roll(nodes, -1), strict=True):
        span = np.arange(a, b if b > a else b + n) % n
        edges.append(_edge(contour, span))
        names.append(contour.names[a])
    result = occ.Face(occ.Wire(edges))
    for edge, name, source in zip(result.edges, names, edges, strict=True):
        if (edge.center - source.center).Norm() > 1e-6 * contour.lengths.sum():
            raise MeshError("OCC has changed the order of the outline's edges; names would be lost")
        edge.name = name
    return result


def geometry(section: occ.Face) -> occ.OCCGeometry:
    """Geometry for the mesh generator and for curved elements."""
    section.name = MATERIAL
    return occ.OCCGeometry(section, dim=2)


def _edge(contour: Outline, span: NDArray[np.intp]) -> occ.Edge:
    """The outline's spline over one or more segments: exact for one, through all points and tangents for more."""
    control = contour.bezier[span]
    if len(span) == 1:
        return occ.BezierCurve([occ.Pnt(*point, 0) for point in control[0]])
    points = [occ.Pnt(*point, 0) for point in (*control[:, 0], control[-1, 3])]
    slope = np.vstack([control[:, 1] - control[:, 0], control[-1:, 3] - control[-1:, 2]])
    return occ.SplineInterpolation(points, tangents={i: occ.Vec(*d, 0) for i, d in enumerate(slope)})


def mesh(contour: Outline, nodes: NDArray[np.intp], field: SizeField) -> ng.Mesh:
    """Mesh the section with curved triangles (geometry of order 2).

    Raises
    ------
    MeshError
        If area, edge names, smallest angle or Jacobian do not pass their checks.
    """
    section = face(contour, nodes)
    shape = geometry(section)
    for seed, size in zip(field.seeds, field.sizes, strict=True):
        if size < 0.5 * field.coarse:  # others change little, and each takes the mesher time
            shape.RestrictH(ngm.Pnt(*seed, 0), size)
    lengths = {"maxh": field.coarse, "grading": field.grading, "curvaturesafety": field.per_radius}
    result = ng.Mesh(shape.GenerateMesh(**lengths))
    result.Curve(CURVE)
    check(result, area=section.mass, names=set(contour.names))
    return result


def check(mesh: ng.Mesh, *, area: float, names: set[str]) -> None:
    """Check a mesh: area, names, smallest angle, positive Jacobian.

    ``area`` is that of the geometry [mm²]. Raises MeshError with the check, the value and the place.
    """
    found = ng.Integrate(1, mesh)
    if not abs(found - area) <= 1e-4 * area:  # what curved edges may cut off; a lost element is more
        raise MeshError(f"the mesh has an area of {found:.8g} mm², the section {area:.8g} mm²: the mesher gave up")
    missing = names - set(mesh.GetBoundaries())
    if missing:
        raise MeshError(f"the mesh has lost the edges {sorted(missing)}")
    angle, place = smallest_angle(mesh)
    if angle < MIN_ANGLE:
        raise MeshError(f"an element at {place.round(4).tolist()} has an angle of {angle:.1f}°, below {MIN_ANGLE}°")
    jacobian = ng.Det(ng.specialcf.JacobianMatrix(2))
    lowest = np.min(jacobian(mesh.MapToAllElements(ng.IntegrationRule(ng.TRIG, 3), ng.VOL)))
    if not lowest > 0:
        raise MeshError("a curved element is inverted (Jacobian not positive)")


def smallest_angle(mesh: ng.Mesh) -> tuple[float, Array]:
    """Return the smallest corner angle of the straight triangles [degrees] and the element's centre."""
    points, triangles = mesh_arrays(mesh)
    corner = points[triangles]
    side = np.roll(corner, -1, axis=1) - corner
    length = np.linalg.norm(side, axis=2)
    cosine = -(side * np.roll(side, 1, axis=1)).sum(axis=2) / (length * np.roll(length, 1, axis=1))
    angle = np.degrees(np.arccos(np.clip(cosine, -1, 1))).min(axis=1)
    worst = int(np.argmin(angle))
    return float(angle[worst]), corner[worst].mean(axis=0)


def mesh_arrays(mesh: ng.Mesh) -> tuple[Array, NDArray[np.intp]]:
    """Return vertex coordinates, shape (nv, 2), and triangles, shape (ne, 3), of an undeformed mesh."""
    coordinates = mesh.ngmesh.Coordinates()[:, :2]
    elements = mesh.ngmesh.Elements2D().NumPy()
    return np.array(coordinates), elements["nodes"][:, :3].astype(int) - 1
