"""Remeshing of the worn section, fine in the contacts, with transfer of all states."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ngwear.equilibrium.state_transfer import transfer
from ngwear.errors import MeshError
from ngwear.geometry.body import Body
from ngwear.geometry.outline import Outline
from ngwear.geometry.recession import tidied
from ngwear.loop.element_sizes import with_contact_lengths
from ngwear.loop.refinement import is_too_coarse, required_sizes, unworn_outline
from ngwear.loop.stage import Stage
from ngwear.loop.state import State
from ngwear.scene.scene import Scene

Array = NDArray[np.float64]

# Settled on the rod seal; a mesh beyond them is no wrong one, only a worse one (``Body.move_to`` refuses those).
SHORTEST = 0.4  # of its length when meshed: how short a segment may become before the outline is tidied
LARGEST_JUMP = 1e-6  # of the section's area, in a new mesh: rounding leaves 1e-15, a lost point far more
FARTHEST = 1.0  # of the patch's edge: how far the outline may move on one mesh


def is_due(state: State) -> bool:
    """Whether the mesh is too coarse for the contact, or the outline has moved or shrunk too far on this mesh.

    False if ``wear.remesh`` is not ``"due"``.
    """
    body, scene = state.stage.body, state.stage.scene
    if scene.wear.remesh != "due":
        return False
    moved = np.linalg.norm(body.contour.points - body.base.points, axis=1).max()
    if moved > FARTHEST * scene.accuracy.lengths.patch or np.min(body.contour.lengths / body.base.lengths) < SHORTEST:
        return True
    return is_too_coarse(state.stage, [p.vector for p in state.phases], **remaining_sliding(state))


def remaining_sliding(state: State) -> dict[str, float]:
    """Remaining sliding distance [mm], as keyword argument of ``refinement.contact_sizes``.

    ``left`` with elements across and remeshing when due: it limits the gaps that may close. ``sliding`` if no other
    mesh is planned: this mesh must suffice to the end. Nothing if the scene gives lengths.
    """
    scene, program = state.stage.scene, state.stage.scene.program
    left = program.slid(program.strokes) - program.slid(state.strokes)
    if scene.wear.remesh != "due":
        return {"sliding": left}
    return {} if state.across is None else {"left": left}


def remesh(
    state: State, contour: Outline | None = None, scene: Scene | None = None, *, fine: Array | None = None
) -> None:
    """Remesh the present (or the given) outline and transfer the state to the new mesh, in place.

    The transferred vectors are first guesses, not equilibria. ``scene`` gives the lengths of the new mesh; default: the
    present ones, with ``Accuracy.across`` those of the present contacts. ``fine`` replaces ``State.fine``.

    Raises
    ------
    MeshError
        If the mesh fails a check; the state is then unchanged.
    """
    old, phases = state.stage, [p.vector for p in state.phases]
    contour = old.body.contour if contour is None else contour
    if scene is not None:
        old.scene = scene
    elif state.across is not None:
        old.scene = with_contact_lengths(old, phases, state.across)
    if (scene is not None or state.across is not None) and state.ledger.worn == 0:
        contour = unworn_outline(old.scene)
    fine = state.fine if fine is None else fine
    worn = state.ledger.worn > 0
    wanted = required_sizes(old, phases, across=state.across, worn=worn, fine=fine, **remaining_sliding(state))
    tidy = contour if state.depths is None else tidied(contour, wanted, float(state.depths[0].max()))
    body = Body(tidy, wanted, on_chord=worn)
    jump = abs(body.base.area - contour.area) / contour.area if worn else 0.0
    if jump > LARGEST_JUMP:
        raise MeshError(f"a new mesh would change the section's area by {jump:.1e}")
    stage = Stage(old.scene, body, state.background, old.friction_shares)
    ways = [vector for phase in state.phases for _, vector in phase.path]
    replace_stage(state, stage, transfer(old.problem, phases + ways, stage.problem))
    state.fine = fine
    state.ledger.remesh_jump = max(state.ledger.remesh_jump, jump)
    state.ledger.remeshes += 1


def replace_stage(state: State, stage: Stage, vectors: list[Array]) -> None:
    """Replace the stage; values on the outline are interpolated, and worn areas keep their sum.

    ``vectors`` are the states of the strokes on it, and then, as far as given, those of their load steps.
    """
    values = _Interpolation(state.contour, stage.body.contour)
    before, after = (contour.widths(stage.scene.worn_edges) for contour in (state.contour, stage.body.contour))

    def of_lengths(given: Array) -> Array:
        return values(given / before) * after

    def areas(given: Array) -> Array:
        found = of_lengths(given)
        whole, sums = given.sum(axis=-1), found.sum(axis=-1)
        return found * np.divide(whole, sums, out=np.zeros_like(whole), where=sums > 0)[..., None]

    ends, ways = vectors[: len(state.phases)], iter(vectors[len(state.phases) :])
    for phase, vector in zip(state.phases, ends, strict=True):
        phase.vector, phase.rate, phase.shares = vector, None, None
        phase.path = [(fraction, way) for (fraction, _), way in zip(phase.path, ways, strict=False)]
        if phase.worn is not None:
            last = phase.worn
            phase.worn = replace(last, end=areas(last.end), mean=areas(last.mean), lengths=of_lengths(last.lengths))
    if state.depths is not None:
        state.depths = values(state.depths)
    state.stage = stage


class _Interpolation:
    """Interpolates values at the points of one outline (last axis) to those of another of almost the same shape."""

    def __init__(self, before: Outline, after: Outline) -> None:
        self._before, self._after = before, after

    @cached_property
    def _places(self) -> tuple[Array, Array]:
        """Arc length along the old outline: of its own points, and of the new points."""
        from shapely import LinearRing, line_locate_point, points

        ways = np.concatenate([[0.0], np.cumsum(self._before.lengths)])
        return ways, line_locate_point(LinearRing(self._before.points), points(self._after.points))

    def __call__(self, values: Array) -> Array:
        ways, found = self._places
        closed = np.concatenate([values, values[..., :1]], axis=-1)
        return np.apply_along_axis(lambda row: np.interp(found, ways, row), -1, closed)
