"""A new mesh for the present outline, fine where the contact is, with all states carried over."""

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
from ngwear.loop.element_sizes import chosen
from ngwear.loop.refinement import outgrown, unworn_outline, wanted_size
from ngwear.loop.stage import Stage
from ngwear.loop.state import State

Array = NDArray[np.float64]

SHORTEST = 0.4  # of its length when meshed: how short a segment may become before the outline is tidied
LARGEST_JUMP = 1e-6  # of the section's area
FARTHEST = 1.0  # of the patch's edge: how far the outline may move on one mesh


def is_due(state: State) -> bool:
    """Whether the contact has outgrown the patch, or the outline has moved or shrunk too far for its mesh.

    Never so if the scene lets the nodes move as far as they can.
    """
    body, scene = state.stage.body, state.stage.scene
    if scene.wear.remesh != "due":
        return False
    moved = np.linalg.norm(body.contour.points - body.base.points, axis=1).max()
    if moved > FARTHEST * scene.accuracy.lengths.patch or np.min(body.contour.lengths / body.base.lengths) < SHORTEST:
        return True
    return outgrown(state.stage, [p.vector for p in state.phases], **still_ahead(state))


def still_ahead(state: State) -> dict[str, float]:
    """How far the surfaces still slide [mm], for ``refinement.contact_sizes``.

    With elements across, and new meshes when due, that tells which gaps may close before the next one; lengths that the
    scene gives stand, however little is left. Where no other mesh comes, this one shall do for all of it.
    """
    scene, program = state.stage.scene, state.stage.scene.program
    left = program.slid(program.strokes) - program.slid(state.strokes)
    if scene.wear.remesh != "due":
        return {"sliding": left}
    return {} if state.across is None else {"left": left}


def remesh(state: State, contour: Outline | None = None) -> None:
    """Mesh the present (or the given) outline anew and carry the state over, in place.

    The carried vectors are first guesses, not equilibria. Raises MeshError if the mesh fails its gates; the
    state is then as it was.
    """
    old, phases = state.stage, [p.vector for p in state.phases]
    contour = old.body.contour if contour is None else contour
    if state.across is not None:
        old.scene = chosen(old, phases, state.across)
        if state.ledger.worn == 0:
            contour = unworn_outline(old.scene)
    wanted = wanted_size(old, phases, across=state.across, **still_ahead(state))
    tidy = tidied(contour, wanted) if state.ledger.worn > 0 else contour
    body = Body(tidy, wanted, on_chord=state.ledger.worn > 0)
    jump = abs(body.base.area - contour.area) / contour.area if state.ledger.worn > 0 else 0.0
    if jump > LARGEST_JUMP:
        raise MeshError(f"a new mesh would change the section's area by {jump:.1e}")
    stage = Stage(old.scene, body, state.background)
    adopt(state, stage, transfer(old.problem, phases, stage.problem))
    state.ledger.remesh_jump = max(state.ledger.remesh_jump, jump)
    state.ledger.remeshes += 1


def adopt(state: State, stage: Stage, vectors: list[Array]) -> None:
    """Go on with another stage: the phases' vectors on it are given, what stands on the outline is carried over."""
    values = _Moved(state.contour, stage.body.contour)
    for phase, vector in zip(state.phases, vectors, strict=True):
        phase.vector, phase.rate, phase.shares = vector, None, None
        if phase.worn is not None:
            phase.worn = replace(phase.worn, pressure=values(phase.worn.pressure), mean=values(phase.worn.mean))
    if state.depths is not None:
        state.depths = values(state.depths)
    state.stage = stage


class _Moved:
    """Values at the points of one outline, their last axis, at those of another with almost the same shape."""

    def __init__(self, before: Outline, after: Outline) -> None:
        self._before, self._after = before, after

    @cached_property
    def _places(self) -> tuple[Array, Array]:
        """Ways along the outline before: of its points, and of those after."""
        from shapely import LinearRing, line_locate_point, points

        ways = np.concatenate([[0.0], np.cumsum(self._before.lengths)])
        return ways, line_locate_point(LinearRing(self._before.points), points(self._after.points))

    def __call__(self, values: Array) -> Array:
        ways, found = self._places
        closed = np.concatenate([values, values[..., :1]], axis=-1)
        return np.apply_along_axis(lambda row: np.interp(found, ways, row), -1, closed)
