"""A sheet under a pin that runs along a circle or a straight line: a block of the sheet that moves with the pin."""

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
SMALLEST_VOLUME = 1e-3  # of an element over the cube of its longest edge; 0.118 is a regular one's


class Sheet(Meshed):
    """Sector of a sheet between two radii of the track, meshed with tetrahedra; the pin stands at the origin.

    The track runs through the origin along +x, counter-clockwise about (0, track radius); z is the height, the faces
    are ``bottom`` (z = 0), ``top`` and ``side``.

    Parameters
    ----------
    thickness : float
        [mm].
    track_radius : float
        [mm]; infinite for a straight track.
    behind, ahead, beside : float
        How far the sector reaches from the pin, along the track and across it [mm].
    seeds : array, shape (k, 3)
        Places that ask for small elements.
    sizes : array, shape (k,)
        Element edge asked for there [mm].
    coarse : float
        Element edge far away [mm].
    grading : float
        Growth of the edge with the distance [-].

    Raises
    ------
    SceneError
        If the sector reaches over the track's centre or around it.
    MeshError
        If the mesh does not pass its gates.
    """

    def __init__(
        self,
        *,
        thickness: float,
        track_radius: float,
        behind: float,
        ahead: float,
        beside: float,
        seeds: Array,
        sizes: Array,
        coarse: float,
        grading: float = 0.4,
    ) -> None:
        if not beside < track_radius:
            raise SceneError("sheet.beside", beside, f"must stay below the track's radius of {track_radius:g} mm")
        if not behind + ahead < 2 * math.pi * track_radius:
            raise SceneError("sheet.behind", behind, "behind and ahead together are longer than the track")
        self.thickness, self.track_radius = thickness, track_radius
        self.behind, self.ahead, self.beside = behind, ahead, beside
        solid = self._solid()
        geometry = occ.OCCGeometry(solid)
        for seed, size in zip(seeds, sizes, strict=True):
            geometry.RestrictH(ngm.Pnt(*seed), size)
        self.mesh = ng.Mesh(geometry.GenerateMesh(maxh=coarse, grading=grading))
        self._check()

    @property
    def size(self) -> float:
        return self.behind + self.ahead

    def along(self, length: Array | float, offset: Array | float) -> tuple[Array, Array]:
        """Coordinates x, y of a place by its length along the track at the pin and its offset to the left [mm]."""
        if math.isinf(self.track_radius):
            return np.asarray(length), np.asarray(offset)
        angle, radius = length / self.track_radius, self.track_radius - np.asarray(offset)
        return radius * np.sin(angle), self.track_radius - radius * np.cos(angle)

    def track(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Length along the track at the pin and offset to its left [mm]: the inverse of ``along``."""
        if math.isinf(self.track_radius):
            return x, y
        up = self.track_radius - y
        return self.track_radius * np.arctan2(x, up), self.track_radius - np.hypot(x, up)

    def _solid(self) -> occ.Solid:
        def point(length: float, offset: float) -> occ.Pnt:
            return occ.Pnt(*(float(c) for c in self.along(length, offset)), 0)

        def edge(offset: float, start: float, end: float) -> occ.Edge:
            if math.isinf(self.track_radius):
                return occ.Segment(point(start, offset), point(end, offset))
            return occ.ArcOfCircle(point(start, offset), point((start + end) / 2, offset), point(end, offset))

        back, front, w = -self.behind, self.ahead, self.beside
        loop = [
            edge(-w, back, front),
            occ.Segment(point(front, -w), point(front, w)),
            edge(w, front, back),
            occ.Segment(point(back, w), point(back, -w)),
        ]
        solid = occ.Face(occ.Wire(loop)).Extrude(occ.Vec(0, 0, self.thickness))
        for face in solid.faces:
            z = face.center.z
            face.name = "bottom" if z < 1e-6 else "top" if z > self.thickness - 1e-6 else "side"
        return solid

    def _check(self) -> None:
        """Pass the mesh through the gates: volume (the outer arcs are chords in it) and the shape of the elements."""
        exact = 2 * self.beside * (self.behind + self.ahead) * self.thickness
        found = ng.Integrate(1, self.mesh)
        if not abs(found - exact) <= 0.05 * exact:
            raise MeshError(f"the mesh has a volume of {found:.6g} mm³, the sheet {exact:.6g} mm³: the mesher gave up")
        points = self.mesh.ngmesh.Coordinates()
        corners = np.array(points)[self.mesh.ngmesh.Elements3D().NumPy()["nodes"][:, :4].astype(int) - 1]
        edges = corners[:, 1:] - corners[:, :1]
        longest = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=-1).max(axis=(1, 2))
        shape = np.abs(np.linalg.det(edges)) / 6 / longest**3
        if shape.min() < SMALLEST_VOLUME:
            place = corners[np.argmin(shape)].mean(axis=0).round(3).tolist()
            raise MeshError(f"an element at {place} is flat: {shape.min():.1e} of the cube of its longest edge")
