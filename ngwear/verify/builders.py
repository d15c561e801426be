"""Outlines and meshes that the reference cases share."""

from __future__ import annotations

import ngsolve as ng
import numpy as np
from ngsolve.meshes import MakeStructured2DMesh

from ngwear.geometry.body import Body
from ngwear.geometry.meshed import Meshed
from ngwear.geometry.outline import Array, Outline
from ngwear.geometry.sizing import SizeField


def quarter_ring(inner: float, outer: float) -> Outline:
    """Quarter of a ring around the origin with the edges bore and outside, and the cuts along x and along y."""
    n = 60  # segments an arc: the spline is then within 3e-8 radii of the circle
    angle = np.linspace(0, np.pi / 2, n + 1)
    arc = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    corners = np.zeros(2 * n + 2, dtype=bool)
    corners[[0, n, n + 1, -1]] = True
    names = ("outside",) * n + ("along y",) + ("bore",) * n + ("along x",)
    return Outline(np.vstack([outer * arc, inner * arc[::-1]]), names, corners)


def meshed(
    contour: Outline,
    coarse: float,
    seeds: Array | None = None,
    size: Array | float = 0.0,
    grading: float = SizeField.grading,
) -> Body:
    """Mesh a contour with elements of ``coarse`` [mm]; at the seeds, shape (k, 2), of ``size`` (one, or one each)."""
    places = np.empty((0, 2)) if seeds is None else np.asarray(seeds, dtype=float)
    return Body(contour, SizeField(places, np.broadcast_to(size, len(places)).astype(float), coarse, grading))


class QuadBlock(Meshed):
    """Square [x, x + 1] x [y, y + 1] mm of n x n distorted quadrilaterals; edges bottom, right, top and left."""

    def __init__(self, x: float, y: float, n: int) -> None:
        def place(a: float, b: float) -> tuple[float, float]:
            off = 0.08 * np.sin(np.pi * a) * np.sin(np.pi * b)
            return x + a + off * np.cos(5 * b), y + b + off * np.sin(4 * a + 1)

        self.mesh = MakeStructured2DMesh(quads=True, nx=n, ny=n, mapping=place)

    @property
    def size(self) -> float:
        return 1.0


def mean(field: ng.CoefficientFunction, body: Meshed, edge: str) -> float:
    """Mean of a field along the named edge of the undeformed outline."""
    where = ng.ds(definedon=body.boundary((edge,)))
    return float(ng.Integrate(field * where, body.mesh) / ng.Integrate(ng.CF(1.0) * where, body.mesh))
