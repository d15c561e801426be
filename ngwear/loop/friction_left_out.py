"""Error by friction that does not act: the next cycle is solved again with less of it, without wear.

A part that does not bear its friction is solved with a share s of it (``ngwear.loop.bearable_friction``). On other
elements, or worn, it bears another share. What the rest of the friction would change is extrapolated from what a little
less of it does: if a quantity changes by d with 0.9 s, it changes by about d (1 - s) / (0.1 s) with all of it. With all
of the friction another place may be the deepest one. How far it would turn a part that it rolls over is not known: a
ring hardly resists rolling. Each stroke may then wear another place, and the depth is that of the stroke that wears
most.
"""

from __future__ import annotations

from copy import copy

from ngwear.loop.bearable_friction import BELOW
from ngwear.loop.cycle_quantities import read_cycle, wear_per_stroke
from ngwear.loop.solution_checks import ROLLS
from ngwear.loop.state import State
from ngwear.loop.stepper import Stepper
from ngwear.loop.time_step_error import next_cycle
from ngwear.results.quantities_of_interest import BY_FRICTION, DEPTH
from ngwear.results.richardson import relative_errors

LESS = BELOW  # times the share that acts: so near to what the part bears is known


def friction_errors(state: State) -> dict[str, float]:
    """Relative errors by friction left out, by their names in the summary; none if all of the friction acts.

    They are those of depth, area, peak pressure, contact width and friction; the error of the depth is that of the
    largest wear per cycle.

    Raises
    ------
    ConvergenceError
        If a stroke of that cycle has no equilibrium.
    """
    acts = state.stage.friction_shares
    lowered = {stroke: share for stroke, (share, _) in acts.items() if share < 1}
    if not lowered:
        return {}
    there = copy(state)
    there.stage = copy(state.stage)
    there.stage.friction_shares = acts | {stroke: (LESS * share, acts[stroke][1]) for stroke, share in lowered.items()}
    try:
        mine, other = next_cycle(state), next_cycle(there)
    finally:
        Stepper(state.stage.scene).restore_last_stroke(state)
    left_out = max((1 - share) / ((1 - LESS) * share) for share in lowered.values())
    changes = relative_errors(read_cycle(mine), read_cycle(other))
    errors = {name: left_out * change for name, change in changes.items()}
    if DEPTH in errors:
        errors[DEPTH] = max(errors[DEPTH], _deeper(mine, other, left_out))
        if any(acts[stroke][1] == ROLLS for stroke in lowered):
            errors[DEPTH] = max(errors[DEPTH], _apart(mine))
    return {f"{name[:-4]} {BY_FRICTION}": error for name, error in errors.items()}


def _deeper(mine: State, other: State, left_out: float) -> float:
    """Relative change of the largest wear per cycle if it comes to lie where one of the strokes wears most.

    The most that a stroke wears is extrapolated; the other strokes wear there what they do now.
    """
    changes = [0.0]
    for spec in (spec for spec in mine.stage.scene.contacts if spec.wears):
        wear, less = (wear_per_stroke(state, spec.name) for state in (mine, other))
        largest = wear.sum(axis=0).max()
        for stroke, lower in zip(wear, less, strict=True):
            more = left_out * (stroke.max() - lower.max())
            if largest > 0:
                changes.append(float((wear[:, stroke.argmax()].sum() + more) / largest - 1))
    return max(changes)


def _apart(mine: State) -> float:
    """Relative change of the largest wear per cycle if each stroke wears another place."""
    changes = [0.0]
    for spec in (spec for spec in mine.stage.scene.contacts if spec.wears):
        wear = wear_per_stroke(mine, spec.name)
        largest = wear.sum(axis=0).max()
        if largest > 0:
            changes.append(float(1.0 - wear.max() / largest))
    return max(changes)
