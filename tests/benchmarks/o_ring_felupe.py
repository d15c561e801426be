"""The O-ring of ``ngwear verify o_ring_squeeze`` with FElupe 11, on three meshes: the case's reference.

Ring of cord d = 3.53 mm and bore 19.6 mm between two rigid plates without friction, free to grow in the radial
direction; Mooney-Rivlin C10 = 0.94, C01 = 0.235 MPa in I1_bar and I2_bar, volumetric energy K/2 (J - 1)^2 with
K = 2000 MPa. One half of the section, Q1 quads with mean dilatation (Q1/P0), finer towards the plate; the material by
FElupe's automatic differentiation (extra ``autodiff``), contact by a nodal penalty, whose penetration is below 2e-5 mm.

Printed for each squeeze C: force per mean circumference pi (bore + d) [N/mm], full width of contact [mm] and the
highest pressure [MPa]. A pressure is a node's force by its share of the deformed area. Outside a contact the gap grows
with the power 3/2 of the distance: the width ends where parabolas through gap^(2/3) of the nearest open nodes vanish.
A mesh takes whole elements into contact, so that its numbers scatter as much as they converge: they are not
extrapolated. The third mesh is good to 0.05 % in force and peak and to 0.15 % in the width; all three take 4 min.

Usage: python o_ring_felupe.py [elements along an eighth of the circle, of the coarsest mesh] [number of meshes]
"""

from __future__ import annotations

import sys
import time

import felupe as fem
import felupe.constitution.tensortrax as mat
import numpy as np
from numpy.typing import NDArray

CORD, BORE = 3.53, 19.6
C10, C01, BULK = 0.94, 0.235, 2000.0
SQUEEZES = (0.10, 0.15, 0.20, 0.25)
STEP = 0.025  # of squeeze, in one solution
PENALTY = 1e6  # N/mm of each node, all around the ring
GRADING = 0.6  # elements at the plate are smaller than the mean by 1 - GRADING
AWAY = 1.0  # the plate's first distance from the ring [mm]
FIT = 10  # a parabola at an edge goes through one open node for ten loaded ones, through three at least

Array = NDArray[np.float64]


def half_section(elements: int) -> fem.Mesh:
    """Return the half section (axial >= 0, radial) with ``elements`` along an eighth of the circle."""
    disc = fem.mesh.Circle(n=elements + 1, sections=[0, 270])
    x, y = disc.points.T
    r, angle = np.hypot(x, y), np.arctan2(y, x)
    angle = angle - GRADING / 2 * r**2 * np.sin(2 * angle)
    r = CORD / 2 * r * (1 + GRADING * (1 - r))
    points = np.column_stack([r * np.cos(angle), (BORE + CORD) / 2 + r * np.sin(angle)])
    points[np.isclose(x, 0.0), 0] = 0.0
    return fem.Mesh(points, disc.cells, "quad")


def contact(places: Array, half: float) -> tuple[float, float, float]:
    """Force [N], width [mm] and highest pressure [MPa] of the surface's places (axial, radial) on the plate at half."""
    gap, r = half - places[:, 0], places[:, 1]
    forces = PENALTY * np.maximum(-gap, 0.0)
    length = np.linalg.norm(np.diff(places, axis=0), axis=1)
    area = np.zeros(len(r))
    area[:-1] += np.pi / 3 * length * (2 * r[:-1] + r[1:])
    area[1:] += np.pi / 3 * length * (r[:-1] + 2 * r[1:])
    on = np.flatnonzero(forces > 0)
    k = max(3, len(on) // FIT)
    ends = []
    for last, open_nodes in ((on[0], slice(on[0] - k, on[0])), (on[-1], slice(on[-1] + 1, on[-1] + 1 + k))):
        away = np.abs(r[open_nodes] - r[last])
        zero = np.roots(np.polyfit(away, gap[open_nodes] ** (2 / 3), 2)).real
        ends.append(r[last] + np.sign(r[open_nodes][0] - r[last]) * zero[np.argmin(np.abs(zero))])
    return float(forces.sum()), float(ends[1] - ends[0]), float((forces / area).max())


def squeeze(elements: int) -> Array:
    """Force [N/mm], width [mm] and peak pressure [MPa] at each squeeze, shape (4, 3)."""
    mesh = half_section(elements)
    x, y = mesh.points.T
    ring = np.flatnonzero(np.isclose(np.hypot(x, y - (BORE + CORD) / 2), CORD / 2))
    ring = ring[np.argsort(y[ring])]
    mesh.add_points([CORD / 2 + AWAY, (BORE + CORD) / 2])
    field = fem.FieldContainer([fem.FieldAxisymmetric(fem.RegionQuad(mesh), dim=2)])
    rubber = mat.Hyperelastic(mat.models.hyperelastic.mooney_rivlin, C10=C10, C01=C01)
    solid = fem.SolidBodyNearlyIncompressible(rubber, field, bulk=BULK)
    plate = fem.MultiPointContact(field, ring, centerpoint=-1, skip=(False, True), multiplier=PENALTY)
    centre = np.arange(mesh.npoints) == plate.centerpoint
    bounds = {
        "symmetry": fem.Boundary(field[0], fx=0.0, skip=(False, True)),
        "plate": fem.Boundary(field[0], mask=centre, skip=(False, True)),
        "guide": fem.Boundary(field[0], mask=centre, skip=(True, False)),
    }
    dof0, dof1 = fem.dof.partition(field, bounds)
    rows = []
    for now in np.arange(1, round(SQUEEZES[-1] / STEP) + 1) * STEP:
        bounds["plate"].value = -AWAY - now * CORD / 2
        ext0 = fem.dof.apply(field, bounds, dof0=dof0)
        fem.newtonraphson(
            items=[solid, plate], x0=field, dof0=dof0, dof1=dof1, ext0=ext0, tol=1e-7, maxiter=40, verbose=0
        )
        if np.isclose(now, SQUEEZES).any():
            places = mesh.points[ring] + field[0].values[ring]
            force, width, peak = contact(places, (1 - now) * CORD / 2)
            rows.append([force / (np.pi * (BORE + CORD)), width, peak])
    return np.array(rows)


def main(coarsest: str = "16", meshes: str = "3") -> None:
    """Solve on each mesh, its elements half as long as the last one's, and print the numbers."""
    levels = [int(coarsest) * 2**k for k in range(int(meshes))]
    found = []
    for level in levels:
        start = time.perf_counter()
        found.append(squeeze(level))
        print(f"{level:4d} elements along an eighth: {time.perf_counter() - start:.0f} s")  # noqa: T201
    print("squeeze  mesh   force    width     peak")  # noqa: T201
    for i, share in enumerate(SQUEEZES):
        for name, values in zip(levels, found, strict=True):
            print(f"{share:6.0%} {name:6d} " + " ".join(f"{value:8.5f}" for value in values[i]))  # noqa: T201


if __name__ == "__main__":
    main(*sys.argv[1:])
