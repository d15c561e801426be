"""Move fields of the reference section to another mesh of (almost) the same section."""

from __future__ import annotations

from typing import Any

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Array = NDArray[np.float64]


class PointSearch:
    """Find reference points in a mesh that may be deformed; points outside take the nearest inside.

    Parameters
    ----------
    mesh : ng.Mesh
    points : array, shape (n, dim)
        Points of the present part.
    deformation : GridFunction or None
        Displacement from the mesh as built to the present part [mm].
    """

    def __init__(self, mesh: ng.Mesh, points: Array, deformation: ng.GridFunction | None = None) -> None:
        active = mesh.deformation
        mesh.UnsetDeformation()
        place = np.array(points, dtype=float)
        if deformation is not None:
            for _ in range(3):
                self.mapped = nearest_places(mesh, place)
                moved = np.asarray(deformation(self.mapped))
                place = points - moved
        self.mapped = nearest_places(mesh, place)
        if active is not None:
            mesh.SetDeformation(active)

    def __call__(self, field: ng.CoefficientFunction) -> Array:
        """Values of a field at the points; shape (n,) or (n, m)."""
        return np.asarray(field(self.mapped)).reshape(len(self.mapped), -1)


def nearest_places(mesh: ng.Mesh, points: Array) -> NDArray[Any]:
    """Points of a mesh that is not deformed, as its fields take them; for one outside, a point inside near to it."""
    mapped = mesh(*points.T)
    lost = np.flatnonzero(mapped["nr"] < 0)
    if len(lost) == 0:
        return mapped
    centres = _centres(mesh)
    _, nearest = cKDTree(centres).query(points[lost])
    for pull in (1e-4, 1e-3, 1e-2, 0.05, 0.2, 0.5, 1.0):  # of the way to the centre, which lies inside
        trial = points[lost] + pull * (centres[nearest] - points[lost])
        found = mesh(*trial.T)
        hit = found["nr"] >= 0
        mapped[lost[hit]] = found[hit]
        lost, nearest = lost[~hit], nearest[~hit]
        if len(lost) == 0:
            break
    return mapped


def _centres(mesh: ng.Mesh) -> Array:
    coordinates = np.array(mesh.ngmesh.Coordinates()[:, : mesh.dim])
    elements = mesh.ngmesh.Elements2D() if mesh.dim == 2 else mesh.ngmesh.Elements3D()
    corners = elements.NumPy()["nodes"][:, : mesh.dim + 1].astype(int) - 1
    return coordinates[corners].mean(axis=1)
