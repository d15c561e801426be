"""Error by friction that does not act: the next cycle is solved again with less of it, without wear.

A part that does not bear its friction is solved with a share s of it (``ngwear.loop.bearable_friction``). On other
elements, or worn, it bears another share. What the rest of the friction would change is extrapolated from what a little
less of it does: if a quantity changes by d with 0.9 s, it changes by about d (1 - s) / (0.1 s) with all of it.
"""

from __future__ import annotations

from copy import copy

from ngwear.loop.bearable_friction import BELOW
from ngwear.loop.cycle_quantities import read_cycle
from ngwear.loop.state import State
from ngwear.loop.stepper import Stepper
from ngwear.loop.time_step_error import next_cycle
from ngwear.results.quantities_of_interest import BY_FRICTION
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
        mine, other = (read_cycle(next_cycle(at)) for at in (state, there))
    finally:
        Stepper(state.stage.scene).restore_last_stroke(state)
    left_out = max((1 - share) / ((1 - LESS) * share) for share in lowered.values())
    return {f"{name[:-4]} {BY_FRICTION}": left_out * change for name, change in relative_errors(mine, other).items()}
