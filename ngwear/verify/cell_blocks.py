"""Sections of elements that can be lost, held and pulled by hand: what the cases of deactivated elements share."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from ngwear.effects.base import DISPLACEMENT
from ngwear.equilibrium.attempts import solve
from ngwear.equilibrium.newton import NewtonOptions
from ngwear.errors import ConvergenceError
from ngwear.geometry.cells import Cells, Index, Mask, outlined
from ngwear.geometry.element_body import ElementBody
from ngwear.geometry.meshed_section import MeshedSection
from ngwear.geometry.outline import Array
from ngwear.laws.damage import Criterion
from ngwear.loop.stage import Stage
from ngwear.loop.state import Phase, State
from ngwear.materials import Hyperelastic
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Support
from ngwear.scene.contact import Contact
from ngwear.scene.deactivation import Deactivation
from ngwear.scene.options import Wear
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Plane
from ngwear.wear.jump_control import JumpControl

TIGHT = NewtonOptions(tolerance=1e-11, max_iterations=40)


def named(points: Array, corners: Iterable[Iterable[int]], name: Callable[[Array], str], below: Index) -> Cells:
    """Cells of elements with three or four corners; ``name`` gives each side its edge's, from both of its ends."""
    rows = np.array([[*corner, -1][:4] for corner in map(list, corners)])
    closed = np.where(rows < 0, rows[:, :1], rows)
    sides = np.stack([closed, np.roll(closed, -1, axis=1)], axis=-1).reshape(-1, 2)
    return outlined(points, rows, {(a, b): name(points[[a, b]]) for a, b in sides.tolist() if a != b}, below)


def grid(x: Array, y: Array, present: Mask | None = None) -> Cells:
    """Quadrilaterals between the lines x and y, columns running down; all of them, or those ``present``, shape (m, n).

    Edges are named bottom, right, top and left where they lie there, else ``inner``.
    """
    n, m = len(x), len(y)
    points = np.stack([np.tile(x, m), np.repeat(y, n)], axis=1)
    at = np.arange(n * m).reshape(m, n)
    corners = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=-1)
    kept = corners.reshape(-1, 4) if present is None else corners[present]

    def name(ends: Array) -> str:
        at_side = {"bottom": ends[:, 1] - y[0], "right": ends[:, 0] - x[-1], "top": ends[:, 1] - y[-1]}
        at_side["left"] = ends[:, 0] - x[0]
        return next((side for side, off in at_side.items() if not off.any()), "inner")

    used = np.zeros(n * m, dtype=bool)
    used[kept] = True
    below = np.where((np.arange(n * m) >= n) & used & np.roll(used, n), np.arange(n * m) - n, -1)
    return named(points, kept, name, below)


def held(
    cells: Cells, material: Hyperelastic, supports: tuple[Support, ...], damage: Criterion, edge: str = "top"
) -> State:
    """State, without load, of a scene that is set up on given elements; a surface that wears is far away from ``edge``.

    Its loop never runs: loads are displacements of supported edges, see ``pull``.
    """
    far = Plane(point=(0.0, 1e3), normal_vector=(0.0, -1.0))
    scene = Scene(
        name="elements",
        part=Part(cells.contour, material=material),
        contacts=(Contact(name="far away", edges=(edge,), surface=far, specific_wear_rate=1e-9),),
        supports=supports,
        program=Program(cycle=(Stroke(name="pull", travel=1.0),), strokes=1),
        accuracy=Accuracy(patch=1e-3, mounting=1.0, coarse=1.0),
        wear=Wear(remesh="never"),
        deactivation=Deactivation(depth=1.0, damage=damage),
        axisymmetric=False,
    )
    stage = Stage(scene, ElementBody(cells))
    phases = [Phase(np.zeros(stage.problem.space.ndof))]
    return State(stage, phases, JumpControl(scene.accuracy.tolerances.wear_error, longest=1))


def on_edge(body: MeshedSection, edge: str) -> Index:
    """Vertices of the mesh on a named edge."""
    return np.unique(body.outline.vertices[body.outline.on((edge,))])


def pull(state: State, edge: str, by: float, parts: int = 1) -> None:
    """Equilibrium with a support moved along y to ``by`` [mm] from its place, from the state's only phase, in parts.

    Raises
    ------
    ConvergenceError
        If there is none; the state is as it was.
    """
    problem, body, phase = state.stage.problem, state.stage.body, state.phases[0]
    vector = problem.state.vec.FV().NumPy()
    part = problem.part(DISPLACEMENT)
    prescribed = part.start + (part.stop - part.start) // 2 + on_edge(body, edge)
    start = float(phase.vector[prescribed[0]])
    vector[:] = phase.vector
    for u in start + (by - start) * np.arange(1, parts + 1) / parts:
        before = float(vector[prescribed[0]])
        vector[:] *= 1.0 if before == 0 else u / before
        vector[prescribed] = u
        report = solve(problem, TIGHT)
        if not report.converged and parts < 64:
            return pull(state, edge, by, 4 * parts)
        if not report.converged:
            raise ConvergenceError(f"no equilibrium at {u} mm", report)
    phase.vector = vector.copy()
    return None


def reaction(state: State, edge: str) -> float:
    """Force along y that a supported edge exerts on the section in the present state [N/mm]."""
    problem, body = state.stage.problem, state.stage.body
    stress, _ = state.stage.elasticity.response(problem.points.strain(problem.state.vec.FV().NumPy()), tangent=False)
    forces = problem.points.forces(stress)
    nodal = np.bincount(problem.points.unknowns.ravel(), forces.ravel(), minlength=problem.space.ndof)
    y = nodal[problem.part(DISPLACEMENT)].reshape(2, -1)[1]
    return float(y[on_edge(body, edge)].sum())  # the shape functions of the vertices add up to 1
