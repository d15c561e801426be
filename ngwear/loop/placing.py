"""Where a part with room to move is mounted: as it is drawn, or beside the wall to which its loads roll it."""

from __future__ import annotations

import logging

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.contact import OutlineContact
from ngwear.loop.solution_checks import Finding
from ngwear.loop.state import State
from ngwear.scene.program import Stroke

Array = NDArray[np.float64]
log = logging.getLogger(__name__)

FAR = 100.0  # sizes of the section: what reaches so far is open
NEAR = 1e-6  # of the section: a part that is so near to a surface touches it
DEEPER = 1e-3  # of the section: what a part beside the wall may overlap more with the surfaces that it touches
NOTHING_STOPS = (
    "; no surface stops the part on its way there: add a wall, or do not press on edges that nothing supports from the "
    "other side"
)


def unloaded(state: State) -> Array:
    """Set and return the state of the unloaded part where it is placed."""
    problem = state.stage.problem
    vector = problem.state.vec.FV().NumPy()
    vector[:] = 0.0
    if state.placed != (0.0, 0.0):
        problem.fields[DISPLACEMENT].Set(ng.CF(state.placed))
    return np.array(vector)


def place_beside_wall(state: State) -> str:
    """Let the part be mounted beside the wall to which the loads of the stroke that failed roll it, with all friction.

    Where it is drawn in its groove is chance, and rolling there by more than a quarter of a turn is no load step's way.
    It stays where it is if it touches that wall already. Returns words for an error if no surface lies on that way.
    """
    way = _way(state, state.stage.scene.program.cycle[len(state.phases)])
    place_as_drawn(state)
    if way is None:
        return NOTHING_STOPS
    if way.any():
        state.placed = (float(way[0]), float(way[1]))
        log.info("the part rolls over: it is mounted beside the wall, %s mm from where it is drawn", state.placed)
    return ""


def place_as_drawn(state: State) -> None:
    """Let the part be mounted where it is drawn, with all friction."""
    state.placed, state.stage.friction_shares = (0.0, 0.0), {}


def placed(state: State) -> list[Finding]:
    """A finding if the part is mounted elsewhere than it is drawn."""
    far = float(np.linalg.norm(state.placed))
    if far == 0.0:
        return []
    x, y = state.placed
    sentence = f"the part is mounted ({x:.4g}, {y:.4g}) mm from where it is drawn, beside the wall to which its loads "
    sentence += "take it: on the way there it would roll by more than a quarter of a turn, and wear where it is not "
    sentence += "worn here; give it less room along the axis, or draw it at the wall"
    return [Finding("placed", far, sentence)]


def _way(state: State, stroke: Stroke) -> Array | None:
    """Translation [mm] of the unloaded part along what drives it in a stroke, until another surface stops it.

    What drives it are the stroke's loads that are not in balance in the present state, such as friction and fluid.
    None if nothing stops it; zero if the surfaces that it touches where it is drawn are in the way.
    """
    stage, still = state.stage, np.zeros(2)
    stage.problem.set_loads(stage.stroke_loads(stroke))
    for term in stage.problem.terms:
        term.refresh()
    drives = np.sum(list(stage.forces().values()), axis=0)
    along = still.copy()
    along[list(stage.floats)] = drives[list(stage.floats)]
    if not along.any():
        return still
    along /= np.linalg.norm(along)
    size, contacts = stage.body.size, list(stage.contacts.values())
    here = [_least_gap(state, contact, still) for contact in contacts]
    beyond = [_least_gap(state, contact, FAR * size * along) for contact in contacts]
    if not any(there < -size for there in beyond):
        return None
    ahead = [contact for contact, gap in zip(contacts, here, strict=True) if gap > NEAR * size]
    way, room = 0.0, np.inf
    while ahead and way < FAR * size and room > NEAR * size:  # a gap is a distance: so far the part is free
        room = min(_least_gap(state, contact, way * along) for contact in ahead)
        way += max(room, 0.0)
    overlaps = [
        gap - _least_gap(state, contact, way * along)
        for contact, gap in zip(contacts, here, strict=True)
        if contact not in ahead
    ]
    stopped = room <= NEAR * size and max(overlaps, default=0.0) < DEEPER * size
    return way * along if stopped else still


def _least_gap(state: State, contact: OutlineContact, moved: Array) -> float:
    """Smallest gap between a surface and the contact's edges of the unloaded outline, moved by so much [mm]."""
    contour = state.contour
    mine = contour.on(contact.edges)
    x, y = (contour.points[mine | np.roll(mine, 1)] + moved).T
    return float(contact.surface.gap(x, y).min())
