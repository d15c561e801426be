"""Deactivation of elements in the loop: tearing by damage, wear of the surface nodes, filter of distorted elements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ngwear.effects.base import DISPLACEMENT
from ngwear.equilibrium.lost_elements_transfer import transfer_to_remaining
from ngwear.errors import GeometryError, MeshError, SceneError, require
from ngwear.geometry.cells import Cells, Fate
from ngwear.geometry.element_body import ElementBody, elements
from ngwear.geometry.layers import layered
from ngwear.geometry.outline import Outline
from ngwear.geometry.recession import STEEPEST
from ngwear.laws.damage import Criterion, Stresses
from ngwear.loop.remeshing import replace_stage
from ngwear.loop.stage import Stage
from ngwear.loop.state import State
from ngwear.scene.deactivation import Deactivation
from ngwear.scene.scene import Scene

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

IDENTITY = np.array([1.0, 0.0, 0.0, 1.0, 0.0, 0.0])
# Thinner elements fold under load; settled on the torn seal (``verify torn_seal``). No area is lost by it.
THINNEST = 0.2  # of an element's side: how near a surface node comes to the one beneath before both become one


def element_body(scene: Scene) -> ElementBody:
    """Mesh the section of a scene that deactivates elements, in layers below the edges that wear.

    Raises
    ------
    SceneError
        If the layers do not fit the section.
    """
    lengths, depth = scene.accuracy.lengths, _settings(scene).depth
    sizes = {"edge": lengths.patch, "coarse": lengths.coarse, "grading": lengths.grading}
    try:
        return ElementBody(layered(scene.part.outline, scene.worn_edges, depth=depth, **sizes))
    except GeometryError as error:
        raise SceneError("deactivation.depth", depth, f"no such layers fit the section: {error}") from None


def _settings(scene: Scene) -> Deactivation:
    """The settings of deactivation; SceneError without them."""
    if scene.deactivation is None:
        raise SceneError("deactivation", None, "is missing: give the table [deactivation]")
    return scene.deactivation


def _criterion(scene: Scene) -> Criterion:
    """The damage criterion; SceneError without one."""
    damage = _settings(scene).damage
    if damage is None:
        raise SceneError("deactivation.damage", None, "is missing: give a damage criterion")
    return damage


def stresses(stage: Stage) -> Stresses:
    """Mean Cauchy stresses of the active elements in the present state, in the order of the mesh.

    Means, because the peak stress beside a lost element is singular: one loss would then cut through the section.
    """
    problem = stage.problem
    points = problem.points
    points.follow()
    strain = points.strain(problem.state.vec.FV().NumPy())
    piola, _ = stage.elasticity.response(strain, tangent=False)
    p, f = (a[..., :4].reshape(*a.shape[:-1], 2, 2) for a in (piola, strain + IDENTITY))
    volume = (points.volumes * np.linalg.det(f) * (1.0 + strain[..., 4])).sum(axis=1)  # deformed
    # sigma = P F^T / J, so that its integral over the deformed volume is that of P F^T over the reference one.
    mean = ((p @ np.swapaxes(f, -1, -2)) * points.volumes[..., None, None]).sum(axis=1) / volume[:, None, None]
    energy = (stage.elasticity.energy(strain) * points.volumes).sum(axis=1) / points.volumes.sum(axis=1)
    return Stresses(np.stack([mean[:, 0, 0], mean[:, 1, 1], 0.5 * (mean[:, 0, 1] + mean[:, 1, 0])], axis=1), energy)


def loaded(stage: Stage) -> dict[str, Array]:
    """Displacement of the points and mean stresses of the elements; nan at lost elements."""
    body = elements(stage.body)
    cells = body.cells
    displacement, stress = np.full((len(cells.points), 2), np.nan), np.full((len(cells.fate), 3), np.nan)
    moved = stage.problem.state.vec.FV().NumPy()[stage.problem.part(DISPLACEMENT)].reshape(2, -1)
    displacement[body.vertices] = moved[:, : len(body.vertices)].T
    stress[body.numbers] = stresses(stage).cauchy
    return {"displacement [mm]": displacement, "stress xx, yy, xy [MPa]": stress}


def exhaustion(state: State, repeats: int) -> Array:
    """Damage over its critical value of each element in the layers after ``repeats`` cycles [-]; 0 if it is lost."""
    stage, body = state.stage, elements(state.stage.body)
    cells, criterion = body.cells, _criterion(stage.scene)
    out = np.zeros(len(cells.fate))
    out[body.numbers] = _usage(stage)
    if criterion.accumulates:
        out = state.fatigue + max(repeats, 1) * np.maximum(state.strained, out)
    return np.where(cells.living & cells.layers & _near_contact(stage), out, 0.0)


def _usage(stage: Stage) -> Array:
    """Damage over its critical value of each active element, in the order of the mesh [-]; for fatigue, per cycle."""
    criterion, found = _criterion(stage.scene), stresses(stage)
    if criterion.length is not None:
        body = elements(stage.body)
        cells, mine = body.now, body.numbers
        found = found.averaged(cells.centres()[mine], cells.areas()[mine], criterion.length)
    return criterion.exhaustion(found)


def _near_contact(stage: Stage) -> Mask:
    """Mask of the elements within ``Deactivation.reach`` of a contact that wears and carries load."""
    cells, reach = elements(stage.body).now, _settings(stage.scene).reach
    if reach is None:
        return np.ones(len(cells.fate), dtype=bool)
    profiles = [stage.contacts[c.name].profile() for c in stage.scene.contacts if c.wears]
    loaded_places = np.vstack([p.reference[p.nominal_pressure > 0] for p in profiles])
    if len(loaded_places) == 0:
        return np.zeros(len(cells.fate), dtype=bool)
    distance, _ = cKDTree(loaded_places).query(cells.centres())
    return distance <= reach


def begin(state: State) -> None:
    """Start with undamaged elements; refuse a part that tears while it is mounted.

    Raises
    ------
    SceneError
        With the place of the largest damage in the mounted part.
    """
    cells, damage = elements(state.stage.body).cells, _settings(state.stage.scene).damage
    if damage is None:
        return
    state.fatigue, state.strained = np.zeros(len(cells.fate)), np.zeros(len(cells.fate))
    used = exhaustion(state, 1)
    worst = int(used.argmax())
    x, y = cells.centres()[worst]
    require(
        used[worst] < 1.0,
        "deactivation.damage.critical",
        damage.critical,
        f"the part would tear while it is mounted, at ({x:.3f}, {y:.3f}) mm: there the {damage.name} reaches "
        f"{used[worst]:.3g} of the critical value; mount it with less force or interference, or take a stronger rubber",
    )


def tear(state: State, outline: Outline, repeats: int) -> bool:
    """Deactivate the elements that the present state tears, on the outline before the solve; return whether any.

    Raises
    ------
    GeometryError
        If no element is left, or the section is cut in two.
    """
    if _settings(state.stage.scene).damage is None:
        return False
    torn = exhaustion(state, repeats) >= 1.0
    if not torn.any():
        return False
    body = elements(state.stage.body)
    body.move_to(outline)
    deactivate(state, body.now, torn, Fate.TORN)
    return True


def add_fatigue(state: State, repeats: int, *, last: bool) -> None:
    """Add the damage of the accepted stroke, for a criterion that accumulates over cycles."""
    damage = _settings(state.stage.scene).damage
    if damage is None or not damage.accumulates:
        return
    mine = elements(state.stage.body).numbers
    state.strained[mine] = np.maximum(state.strained[mine], _usage(state.stage))
    if last:
        state.fatigue = state.fatigue + repeats * state.strained
        state.strained = np.zeros_like(state.strained)


def deactivate(state: State, cells: Cells, dead: Mask, fate: Fate) -> None:
    """Deactivate elements, add their areas to the ledger by cause, and set the scene up on the remaining ones."""
    left = without_lost(state, cells, dead, fate)
    rebuild_stage(state, left)


def without_lost(state: State, cells: Cells, dead: Mask, fate: Fate) -> Cells:
    """The section without some elements; their areas are added to the ledger of the state."""
    scene = state.stage.scene
    touching = {edge for contact in scene.contacts for edge in contact.edges}
    bonded = tuple(edge for support in scene.supports for edge in support.edges if edge not in touching)
    left = cells.without(dead, fate, bonded)
    areas = cells.areas()
    newly = cells.living & ~left.living
    for cause in (Fate.TORN, Fate.DISTORTED, Fate.LOOSE):
        state.ledger.lost[cause] += float(areas[newly & (left.fate == cause)].sum())
    return left


def rebuild_stage(state: State, cells: Cells) -> None:
    """Set the scene up on the remaining elements; the states are kept as first guesses."""
    old = state.stage
    try:
        stage = Stage(old.scene, ElementBody(cells))
    except MeshError as error:
        raise GeometryError(f"the remaining section has no support or no load: {error}") from None
    replace_stage(state, stage, transfer_to_remaining(old.problem, [p.vector for p in state.phases], stage.problem))


def move_surface(state: State, outline: Outline, points: Array) -> None:
    """Move the surface nodes from the outline to worn places, shape (n, 2) [mm]; deactivate distorted elements.

    Raises
    ------
    MeshError
        If an element would be inverted and the scene has no filter.
    GeometryError
        If no element is left, or the section is cut in two.
    """
    body, distortion_filter = elements(state.stage.body), _settings(state.stage.scene).distortion
    cells = moved = body.cells.moved(points)
    worn = moved.area
    went = dict(zip(cells.rim.tolist(), np.linalg.norm(points - outline.points, axis=1), strict=True))
    while len(reached := _reached(cells, went)):
        cells = cells.merged(reached)
    if cells is not moved:
        state.ledger.lost[Fate.WORN] += worn - cells.area  # area of pits and holes whose walls were merged
    distorted = np.zeros(len(cells.fate), dtype=bool) if distortion_filter is None else distortion_filter.finds(cells)
    if distorted.any() or cells is not moved:  # at a hole, elements may now hang on one merged point
        cells = without_lost(state, cells, distorted, Fate.DISTORTED)
    if np.array_equal(cells.corners, body.cells.corners) and np.array_equal(cells.fate, body.cells.fate):
        body.move_to(replace(outline, points=points))
    else:
        rebuild_stage(state, cells)


def _reached(cells: Cells, went: dict[int, float]) -> NDArray[np.intp]:
    """Points of the outline that have come close to the next point of their column, or have passed it."""
    rim = cells.rim
    place, beneath = cells.points[rim], cells.below[rim]
    chord = np.roll(place, -1, axis=0) - np.roll(place, 1, axis=0)
    normal = np.stack([-chord[:, 1], chord[:, 0]], axis=1) / np.linalg.norm(chord, axis=1)[:, None]
    left = ((cells.points[beneath] - place) * normal).sum(axis=1)
    near = THINNEST * np.sqrt(np.median(cells.made[cells.layers]))
    # A column parallel to the outline, in a wall, does not wear.
    across = np.abs((cells.inward() * normal).sum(axis=1)) > STEEPEST
    passed = left >= -np.array([went[point] for point in rim.tolist()])
    return rim[(beneath >= 0) & across & passed & (left < near)]
