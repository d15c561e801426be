"""A sheet under a pin that moves along a circle or a straight line: the part of the sheet around the pin."""

from __future__ import annotations

import math

import netgen.meshing as ngm
import netgen.occ as occ
import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.errors import MeshError, SceneError
from ngwear.geometry.meshed import Meshed

Array = NDArray[np.float64]
MIDDLE = "middle"
SMALLEST_VOLUME = 1e-3  # of an element over the cube of its longest edge; 0.118 is a regular one's, flat ones have none


class Sheet(Meshed):
    """Sector of a sheet between two radii of the track, meshed with tetrahedra; the pin stands at the origin.

    The track runs through the origin along +x, counter-clockwise about (0, track radius); z is the height, the faces
    are ``bottom`` (z = 0), ``top`` and ``side``. The half behind the pin mirrors the half ahead, elements
    too: so that a pin at rest has exactly no force along the track.

    Parameters
    ----------
    thickness : float
        [mm].
    track_radius : float
        [mm]; infinite for a straight track.
    reach, beside : float
        Distance from the pin to the sector's ends along the track, and to its sides across it [mm].
    seeds : array, shape (k, 3)
        Places with small elements.
    sizes : array, shape (k,)
        Element edge there [mm].
    coarse : float
        Element edge far away [mm].
    grading : float
        Growth of the edge with the distance [-].

    Raises
    ------
    SceneError
        If the sector reaches over the track's centre or around it.
    MeshError
        If the mesh does not pass its checks.
    """

    def __init__(
        self,
        *,
        thickness: float,
        track_radius: float,
        reach: float,
        beside: float,
        seeds: Array,
        sizes: Array,
        coarse: float,
        grading: float = 0.4,
    ) -> None:
        if not beside < track_radius:
            raise SceneError("sheet.beside", beside, f"must stay below the track's radius of {track_radius:g} mm")
        if not reach < math.pi * track_radius:
            raise SceneError("sheet.reach", reach, "must stay below half the length of the track")
        self.thickness, self.track_radius = thickness, track_radius
        self.reach, self.beside = reach, beside
        solid = self._solid()
        geometry = occ.OCCGeometry(solid)
        for seed, size in zip(seeds, sizes, strict=True):
            geometry.RestrictH(ngm.Pnt(*seed), size)
        self.mesh = _mirrored(ng.Mesh(geometry.GenerateMesh(maxh=coarse, grading=grading)))
        self._check()

    @property
    def size(self) -> float:
        return 2 * self.reach

    def _solid(self) -> occ.Solid:
        """The half ahead of the pin; the face between the halves has the name ``MIDDLE``."""

        def point(length: float, offset: float) -> occ.Pnt:
            if math.isinf(self.track_radius):
                return occ.Pnt(length, offset, 0)
            angle, radius = length / self.track_radius, self.track_radius - offset
            return occ.Pnt(radius * math.sin(angle), self.track_radius - radius * math.cos(angle), 0)

        def edge(offset: float, start: float, end: float) -> occ.Edge:
            if math.isinf(self.track_radius):
                return occ.Segment(point(start, offset), point(end, offset))
            return occ.ArcOfCircle(point(start, offset), point((start + end) / 2, offset), point(end, offset))

        front, w = self.reach, self.beside
        loop = [
            edge(-w, 0.0, front),
            occ.Segment(point(front, -w), point(front, w)),
            edge(w, front, 0.0),
            occ.Segment(point(0.0, w), point(0.0, -w)),
        ]
        solid = occ.Face(occ.Wire(loop)).Extrude(occ.Vec(0, 0, self.thickness))
        for face in solid.faces:
            x, z = face.center.x, face.center.z
            face.name = "bottom" if z < 1e-6 else "top" if z > self.thickness - 1e-6 else "side"
            if abs(x) < 1e-6:
                face.name = MIDDLE
        return solid

    def _check(self) -> None:
        """Check the mesh: its volume (the outer arcs are chords in it) and the shape of the elements."""
        exact = 4 * self.beside * self.reach * self.thickness
        found = ng.Integrate(1, self.mesh)
        if not abs(found - exact) <= 0.05 * exact:  # more than chords of coarse arcs cut off
            raise MeshError(f"the mesh has a volume of {found:.6g} mm³, the sheet {exact:.6g} mm³: the mesher gave up")
        points = self.mesh.ngmesh.Coordinates()
        corners = np.array(points)[self.mesh.ngmesh.Elements3D().NumPy()["nodes"][:, :4].astype(int) - 1]
        edges = corners[:, 1:] - corners[:, :1]
        longest = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=-1).max(axis=(1, 2))
        shape = np.abs(np.linalg.det(edges)) / 6 / longest**3
        if shape.min() < SMALLEST_VOLUME:
            place = corners[np.argmin(shape)].mean(axis=0).round(3).tolist()
            raise MeshError(f"an element at {place} is flat: {shape.min():.1e} of the cube of its longest edge")


def _mirrored(half: ng.Mesh) -> ng.Mesh:
    """The mesh and its mirror image at x = 0, joined there."""
    points = np.array(half.ngmesh.Coordinates())
    tetrahedra = half.ngmesh.Elements3D().NumPy()["nodes"][:, :4].astype(int) - 1
    faces = [(el.mat, [v.nr for v in el.vertices]) for el in half.Elements(ng.BND) if el.mat != MIDDLE]
    whole = ngm.Mesh()
    whole.dim = 3
    names = ("bottom", "top", "side")
    for i, name in enumerate(names):
        whole.Add(ngm.FaceDescriptor(surfnr=i + 1, domin=1, bc=i + 1))
        whole.SetBCName(i, name)
    whole.SetMaterial(1, "rubber")
    ahead = [whole.Add(ngm.MeshPoint(ngm.Pnt(*p))) for p in points]
    joined = np.abs(points[:, 0]) < 1e-9
    behind = [
        same if on else whole.Add(ngm.MeshPoint(ngm.Pnt(-x, y, z)))
        for same, on, (x, y, z) in zip(ahead, joined, points, strict=True)
    ]
    for a, b, c, d in tetrahedra:
        whole.Add(ngm.Element3D(1, [ahead[i] for i in (a, b, c, d)]))
        whole.Add(ngm.Element3D(1, [behind[i] for i in (b, a, c, d)]))
    for name, (a, b, c) in faces:
        index = names.index(name) + 1
        whole.Add(ngm.Element2D(index, [ahead[i] for i in (a, b, c)]))
        whole.Add(ngm.Element2D(index, [behind[i] for i in (b, a, c)]))
    return ng.Mesh(whole)
