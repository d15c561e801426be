"""Problem P1a with FElupe, as a user of FElupe would write it: the peer in ``test_race_p1a.py``.

Plane strain sheet 20 x 2 mm, bottom bonded, under a rigid cylinder R = 5 mm pressed to d = 0.30 mm, no friction;
Mooney-Rivlin C10 = 0.6, C01 = 0.15, K = 1000 MPa. Q1 quads with mean dilatation, the material by FElupe's automatic
differentiation (extra ``autodiff``), SuperLU (FElupe's default solver), contact by a nodal penalty.

The penalty is 1e3 MPa/mm: it is the one whose limit on fine meshes is 5.3032 N/mm (1.01 % below exact contact), and
the one that asks for the fewest iterations. With 1e4 (0.10 % below exact contact) six steps take 31 iterations and a
single step fails; with 3e4 six steps fail. The contact's stiffness leaves out the curvature of the cylinder: with it
Newton fails too (FElupe's own ``ContactRigidCylinder`` freezes that term for the same reason). A centre that is moved
in six steps is the problem's definition; one step of 0.30 mm is what FElupe can do at best.

Usage: python p1a_felupe.py [graded | uniform] [number of steps]
"""

import sys

import felupe as fem
import felupe.constitution.tensortrax as mat
import numpy as np
from scipy.sparse import coo_matrix

WIDTH, THICKNESS, RADIUS, DEPTH = 20.0, 2.0, 5.0, 0.30
H, PENALTY, TOLERANCE = 0.1, 1e3, 1e-6


class Roller:
    """Item of a rigid cylinder pushed down by ``depth`` onto the top, a penalty times the nodal areas."""

    def __init__(self, field, penalty):
        points = field.region.mesh.points
        top = np.flatnonzero(np.isclose(points[:, 1], THICKNESS))
        self.nodes = top[np.argsort(points[top, 0])]
        area = np.zeros(len(top))
        length = np.diff(points[self.nodes, 0])
        area[:-1] += length / 2
        area[1:] += length / 2
        self.stiffness = penalty * area
        self.start = points[self.nodes] - [0.0, THICKNESS + RADIUS]
        self.field, self.depth, self.force = field, 0.0, np.zeros(2)
        self.assemble = fem.mechanics.Assemble(vector=self._vector, matrix=self._matrix)
        self.results = fem.mechanics.Results(stress=False, elasticity=False)

    def _touching(self):
        arm = self.start + self.field[0].values[self.nodes] + [0.0, self.depth]
        distance = np.linalg.norm(arm, axis=1)
        on = distance < RADIUS
        dofs = self.field[0].indices.dof[self.nodes[on]]
        return dofs, arm[on] / distance[on, None], distance[on] - RADIUS, self.stiffness[on]

    def _vector(self, field=None, parallel=False):
        self.field = self.field if field is None else field
        dofs, normal, gap, stiffness = self._touching()
        force = (stiffness * gap)[:, None] * normal
        self.force = force.sum(axis=0)
        rows = dofs.ravel()
        return coo_matrix((force.ravel(), (rows, 0 * rows)), shape=(self.field[0].values.size, 1)).tocsr()

    def _matrix(self, field=None, parallel=False):
        dofs, normal, _, stiffness = self._touching()
        blocks = stiffness[:, None, None] * normal[:, :, None] * normal[:, None, :]
        places = np.repeat(dofs, 2, axis=1).ravel(), np.tile(dofs, (1, 2)).ravel()
        size = self.field[0].values.size
        return coo_matrix((blocks.ravel(), places), shape=(size, size)).tocsr()


def growing(length, ratio):
    """Return places from 0 to ``length`` whose distances grow from H by the ratio."""
    places = [0.0]
    while places[-1] < length:
        places.append(places[-1] + H * ratio ** len(places))
    return np.array(places) * length / places[-1]


def sheet(kind):
    """Return quads of 0.1 mm everywhere, or from the contact outwards and downwards larger ones."""
    if kind == "uniform":
        shape = (round(WIDTH / H) + 1, round(THICKNESS / H) + 1)
        return fem.Rectangle(a=(-WIDTH / 2, 0.0), b=(WIDTH / 2, THICKNESS), n=shape)
    fine = 2.4
    right = np.concatenate([np.linspace(0.0, fine, round(fine / H) + 1), fine + growing(WIDTH / 2 - fine, 1.1)[1:]])
    grid = fem.Grid(np.concatenate([-right[:0:-1], right]), THICKNESS - growing(THICKNESS, 1.06)[::-1])
    return fem.Mesh(grid.points, grid.cells, "quad")


def main(kind="graded", steps="6"):
    """Solve and print the force [N/mm]."""
    region = fem.RegionQuad(sheet(kind))
    field = fem.FieldContainer([fem.FieldPlaneStrain(region, dim=2)])
    rubber = mat.Hyperelastic(mat.models.hyperelastic.mooney_rivlin, C10=0.6, C01=0.15)
    solid = fem.SolidBodyNearlyIncompressible(rubber, field, bulk=1000.0)
    roller = Roller(field, PENALTY)
    bonded = {"bottom": fem.Boundary(field[0], fy=0.0)}
    dof0, dof1 = fem.dof.partition(field, bonded)
    ext0 = fem.dof.apply(field, bonded, dof0=dof0)
    iterations = 0
    for depth in np.linspace(0.0, DEPTH, int(steps) + 1)[1:]:
        roller.depth = depth
        result = fem.newtonraphson(
            items=[solid, roller], x0=field, dof0=dof0, dof1=dof1, ext0=ext0, tol=TOLERANCE, verbose=0
        )
        field = result.x
        iterations += result.iterations
    print(f"dofs {region.mesh.npoints * 2} iterations {iterations} force {roller.force[1]:.6f}")  # noqa: T201


if __name__ == "__main__":
    main(*sys.argv[1:])
