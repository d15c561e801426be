"""Error by a fluid that a contact just holds: the next cycle is solved again with the fluid let in, without wear.

A contact that carries hardly more than the fluid's pressure holds it on one mesh and not on another one, and where a
fluid has come into a contact, the place at which it ends differs. The solve is repeated with fluids that only contacts
hold which carry more than their pressure by what contact pressures err by (``ngwear.effects.blow_by.ERRS``); the error
is the whole change.
"""

from __future__ import annotations

from ngwear.effects.blow_by import ERRS
from ngwear.loop.cycle_quantities import read_cycle
from ngwear.loop.state import State
from ngwear.loop.stepper import Stepper
from ngwear.loop.time_step_error import next_cycle
from ngwear.results.quantities_of_interest import BY_FLUID
from ngwear.results.richardson import relative_errors


def fluid_errors(state: State) -> dict[str, float]:
    """Relative errors by fluids that contacts just hold in the last solves, by their names in the summary; else none.

    They are those of depth, area, peak pressure, contact width and friction; the error of the depth is that of the
    largest wear per cycle.

    Raises
    ------
    ConvergenceError
        If a stroke of that cycle has no equilibrium.
    """
    if not any(report.comes_further for report in state.reports):
        return {}
    fluids = list(state.stage.fluids.values())
    held = [fluid.holding for fluid in fluids]
    try:
        mine = read_cycle(next_cycle(state))
        for fluid in fluids:
            fluid.holding = 1 + ERRS
        other = read_cycle(next_cycle(state))
    finally:
        for fluid, holding in zip(fluids, held, strict=True):
            fluid.holding = holding
        Stepper(state.stage.scene).restore_last_stroke(state)
    return {f"{name[:-4]} {BY_FLUID}": change for name, change in relative_errors(mine, other).items()}
