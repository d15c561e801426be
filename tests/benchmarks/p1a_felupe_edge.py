"""Half width of the contact of problem P1a with FElupe on fine quads: a second opinion on the published values.

Quads of ``H`` mm in the contact, nodal penalty ``PENALTY`` [MPa/mm]. The end of the contact is where the gap, which
grows with the power 3/2 of the distance outside a contact, comes to zero: a line through gap^(2/3) at the first four
open nodes but the nearest.

    python tests/benchmarks/p1a_felupe_edge.py [H [PENALTY]]        (0.01 and 1e4: 30 s)
"""

import sys

import felupe as fem
import felupe.constitution.tensortrax as mat
import numpy as np
import p1a_felupe as p1a

DEPTHS = (0.05, 0.1, 0.15, 0.2, 0.2538, 0.28, 0.30)  # 0.2538: F = 4 N/mm


def half_width(roller, field):
    """Deformed distance from the middle to where the gap closes [mm]."""
    arm = roller.start + field[0].values[roller.nodes] + [0.0, roller.depth]
    gap, x = np.linalg.norm(arm, axis=1) - p1a.RADIUS, arm[:, 0]
    first = int(np.flatnonzero((gap > 0) & (x > 0))[0])
    near = slice(first + 1, first + 5)
    slope, start = np.polyfit(x[near], gap[near] ** (2 / 3), 1)
    return -start / slope


def main(h=0.01, penalty=1e4):
    """Print force and half width at the two depths of the problem."""
    p1a.H, fine = float(h), 1.95
    right = np.concatenate(
        [np.linspace(0, fine, round(fine / p1a.H) + 1), fine + p1a.growing(p1a.WIDTH / 2 - fine, 1.15)[1:]]
    )
    grid = fem.Grid(np.concatenate([-right[:0:-1], right]), p1a.THICKNESS - p1a.growing(p1a.THICKNESS, 1.1)[::-1])
    field = fem.FieldContainer([fem.FieldPlaneStrain(fem.RegionQuad(fem.Mesh(grid.points, grid.cells, "quad")), dim=2)])
    rubber = mat.Hyperelastic(mat.models.hyperelastic.mooney_rivlin, C10=0.6, C01=0.15)
    solid = fem.SolidBodyNearlyIncompressible(rubber, field, bulk=1000.0)
    roller = p1a.Roller(field, float(penalty))
    bonded = {"bottom": fem.Boundary(field[0], fy=0.0)}
    dof0, dof1 = fem.dof.partition(field, bonded)
    ext0 = fem.dof.apply(field, bonded, dof0=dof0)
    for depth in DEPTHS:
        roller.depth = depth
        result = fem.newtonraphson(
            items=[solid, roller], x0=field, dof0=dof0, dof1=dof1, ext0=ext0, tol=p1a.TOLERANCE, verbose=0
        )
        field = result.x
        if depth in (0.2538, 0.30):
            print(f"d {depth} force {roller.force[1]:.4f} half width {half_width(roller, field):.4f}")  # noqa: T201


if __name__ == "__main__":
    main(*sys.argv[1:])
