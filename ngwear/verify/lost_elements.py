"""Lost elements bring nothing: energy, residual and matrix of what is left, the same meshed anew, contact below.

Plane strain, neo-Hooke, G = 1 MPa, K = 50 MPa; block 2 mm wide and 1 mm high of 16 x 8 quadrilaterals.

- A patch of the surface of 21 elements is lost. At one displacement and pressure, energy, residual and matrix of what
  is left and of the patch alone add up to those of the whole; the unknowns of what is left are those of the vertices,
  edges and insides of its elements, counted apart.
- The same section, listed anew in another order of points and elements, has the same equilibrium under a plane that
  presses with 0.5 N/mm and slides with mu = 0.3.
- The whole upper layer is lost under that plane: the contact is on the faces below, over the whole width, its resultant
  is the force, and everything is as in a block that was lower from the start.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import csr_array

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.elasticity import Elasticity
from ngwear.equilibrium.attempts import solve
from ngwear.equilibrium.lost_elements_transfer import transfer_to_remaining
from ngwear.equilibrium.problem import Problem
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.cells import Cells, Fate, Mask, outlined
from ngwear.geometry.element_body import ElementBody, elements
from ngwear.geometry.outline import Array
from ngwear.laws.damage import MaximumPrincipalStress
from ngwear.loop.lost_elements import deactivate
from ngwear.loop.stage import Stage
from ngwear.loop.state import State
from ngwear.materials import NeoHooke
from ngwear.scene.boundary import Support
from ngwear.scene.contact import Contact
from ngwear.scene.scene import Scene
from ngwear.surfaces import Plane
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.cell_blocks import TIGHT, grid, held

RUBBER = NeoHooke(shear=1.0, bulk_modulus=50.0)
NX, NY, FORCE = 16, 8, 0.5
STEPS = StepOptions(first=0.25, newton=TIGHT)


def block() -> Cells:
    """The whole."""
    return grid(np.linspace(-1, 1, NX + 1), np.linspace(0, 1, NY + 1))


def patch() -> Mask:
    """Elements of the surface that are lost, in one piece."""
    lost = np.zeros((NY, NX), dtype=bool)
    lost[-3:, 4:11] = True
    return lost.ravel()


def elastic(cells: Cells) -> Problem:
    """Rubber alone."""
    return Problem(ElementBody(cells), PlaneStrain(), [Elasticity(RUBBER)])


def parts(problem: Problem) -> tuple[float, Array, csr_array]:
    """Energy [mJ/mm], residual and matrix at the present state."""
    strain = problem.points.strain(problem.state.vec.FV().NumPy())
    energy = float((problem.points.volumes * Elasticity(RUBBER).energy(strain)).sum())
    residual = problem.state.vec.CreateVector()
    problem.residual(residual)
    rows, columns, values = (np.array(part) for part in problem.assemble().COO())
    size = problem.space.ndof
    return energy, residual.FV().NumPy().copy(), csr_array((values, (rows, columns)), shape=(size, size))


def shares() -> tuple[float, float, float, float]:
    """Relative errors of what the parts add up to: energy, residual, matrix; unknowns over those counted."""
    cells, lost = block(), patch()
    whole = elastic(cells)
    state = whole.state.vec.FV().NumPy()
    state[:] = 0.01 * np.sin(np.arange(len(state)) ** 1.5)
    energy, residual, matrix = parts(whole)
    found_energy, found, total, counted = 0.0, np.zeros_like(residual), 0 * matrix, 0.0
    for left in (cells.without(lost, Fate.TORN), cells.without(~lost, Fate.TORN)):
        part = elastic(left)
        part.state.vec.FV().NumPy()[:], numbers = transfer_to_remaining(
            whole, [state, np.arange(len(state), dtype=float)], part
        )
        its_energy, its_residual, its_matrix = parts(part)
        place = numbers.round().astype(int)
        to_whole = csr_array((np.ones(len(place)), (place, np.arange(len(place)))), shape=(len(state), len(place)))
        found_energy += its_energy
        found += to_whole @ its_residual
        total = total + to_whole @ its_matrix @ to_whole.T
        counted = counted or part.space.ndof / unknowns(left)
    off = abs(total - matrix).max() / abs(matrix).max()
    return abs(found_energy / energy - 1), np.abs(found - residual).max() / np.abs(residual).max(), off, counted


def unknowns(cells: Cells) -> int:
    """Two of the displacement at each vertex, edge and inside of a quadrilateral, one pressure at each vertex."""
    sides, _ = cells.sides(cells.living)
    edges = len({tuple(sorted(side)) for side in sides.tolist()})
    return 2 * (len(np.unique(sides)) + edges + int(cells.living.sum())) + len(np.unique(sides))


def anew(cells: Cells) -> Cells:
    """The living elements listed from the start, points and elements in another order, first corners as well."""
    rng = np.random.default_rng(3)
    kept = cells.corners[cells.living]
    used = rng.permutation(np.unique(kept))
    number = np.full(len(cells.points), -1)
    number[used] = np.arange(len(used))
    corners = np.array([np.roll(number[row], rng.integers(4)) for row in rng.permutation(kept)])
    rim = number[cells.rim].tolist()
    names = dict(zip(zip(rim, [*rim[1:], rim[0]], strict=True), cells.names, strict=True))
    below = np.full(len(used), -1)
    deeper = cells.below[used]
    below[deeper >= 0] = number[deeper[deeper >= 0]]
    return outlined(cells.points[used], corners, names, below)


def pressed(cells: Cells) -> State:
    """Under the plane that presses and slides; what is below the height of the block touches it, too."""
    plane = Plane(point=(0.0, 1.0), normal_vector=(0.0, -1.0))
    spec = Contact(
        name="plane", edges=("top",), surface=plane, force=FORCE, friction=0.3, specific_wear_rate=1e-9, sticks=False
    )
    state = held(cells, RUBBER, (Support(edges=("bottom",)),), MaximumPrincipalStress(critical=1e9))
    scene: Scene = replace(state.stage.scene, contacts=(spec,))
    state.stage = Stage(scene, ElementBody(cells))
    state.phases[0].vector = state.stage.problem.state.vec.FV().NumPy().copy()
    return state


def press(state: State) -> Array:
    """Equilibrium from first touch; displacements of the vertices by their places, row by row upwards [mm]."""
    stage = state.stage
    problem = stage.problem
    problem.state.vec[:] = 0.0
    problem.set_loads(stage.first_touch())
    advance(problem, stage.mounted_loads(), STEPS)
    solve(problem, TIGHT)
    state.phases[0].vector = problem.state.vec.FV().NumPy().copy()
    body = elements(stage.body)
    places = body.cells.points[body.vertices].round(9)
    u = state.phases[0].vector[problem.part(DISPLACEMENT)].reshape(2, -1)[:, : len(places)].T
    return u[np.lexsort(places.T)]


def run() -> list[Check]:
    """Sums of the parts, the same meshed anew, and contact below a lost layer."""
    checks, clock = [], Stopwatch()

    def add(quantity: str, value: float, reference: float, tolerance: float) -> None:
        checks.append(Check("lost_elements", quantity, value, reference, tolerance, clock.seconds))

    energy, residual, matrix, counted = shares()
    add("energy of both parts against that of the whole [-]", energy, 0.0, 1e-12)
    add("residual of both parts against that of the whole [-]", residual, 0.0, 1e-12)
    add("matrix of both parts against that of the whole [-]", matrix, 0.0, 1e-12)
    add("unknowns of what is left over those of its elements [-]", counted, 1.0, 0.0)

    clock.start()
    state = pressed(block())
    press(state)
    deactivate(state, elements(state.stage.body).now, patch(), Fate.TORN)
    first, second = press(state), press(pressed(anew(elements(state.stage.body).cells)))
    add(
        "displacements against the same meshed anew [-]", np.abs(first - second).max() / np.abs(first).max(), 0.0, 1e-10
    )

    clock.start()
    state = pressed(block())
    press(state)
    deactivate(state, elements(state.stage.body).now, np.arange(NX * NY) >= NX * (NY - 1), Fate.TORN)
    below = press(state)
    contact = state.stage.contacts["plane"]
    add("resultant on the faces below over the force [-]", -contact.force()[1] / FORCE, 1.0, 1e-9)
    add("width of the faces below that may touch [mm]", float(contact.profile().weight.sum()), 2.0, 1e-12)
    lower = press(pressed(grid(np.linspace(-1, 1, NX + 1), np.linspace(0, 1 - 1 / NY, NY))))
    off = np.abs(below - lower).max() / np.abs(lower).max()
    add("displacements below a lost layer against a lower block [-]", off, 0.0, 1e-10)
    return checks
