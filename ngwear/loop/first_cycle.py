"""The first cycle on a mesh: the part is mounted, and each stroke is solved once, in load steps."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ngwear.equilibrium.newton import Outcome
from ngwear.equilibrium.stepping import StepOptions
from ngwear.errors import ConvergenceError, MeshError
from ngwear.loop.bearable_friction import advance_while_sliding, reason
from ngwear.loop.finer_mesh import FINER, advance_on_finer
from ngwear.loop.mounting import mount, unworn_body
from ngwear.loop.placing import place_as_drawn, place_beside_wall, unloaded
from ngwear.loop.solution_checks import ROLLS
from ngwear.loop.stage import Stage
from ngwear.loop.state import Phase, State
from ngwear.loop.stroke_report import Forces
from ngwear.loop.stroke_solve import MOVING, recorder, steps_for

Array = NDArray[np.float64]
log = logging.getLogger(__name__)


def first_cycle(state: State, on_mount: Callable[[float], None], lost_elements: ModuleType | None) -> list[Forces]:
    """Mount the unloaded part and solve each stroke of the cycle once, in load steps, each from the one before.

    A part that friction rolls over on its way to a wall is mounted anew, beside that wall. If it rolls there, too, it
    is solved with less friction; where it is drawn, if there is no equilibrium at the wall. One that cannot be mounted,
    and does not show why, is mounted once more from the beginning, on elements of half the edges.

    Returns the forces on the part in each stroke.
    """
    first = state.work.solves == 0
    rolled = state.placed != (0.0, 0.0) or bool(state.stage.friction_shares)  # on coarser elements
    cycle = partial(_first_cycle, state, on_mount, lost_elements)
    try:
        return cycle(lowers=rolled)
    except (ConvergenceError, MeshError) as error:
        rolls = not rolled and bool(state.stage.floats) and reason(error) == ROLLS
        if not rolls and not (first and _mesh_finer(state, error)):
            raise
        nothing_stops = place_beside_wall(state) if rolls else ""
    if rolls:
        try:
            return cycle(shorter=False)
        except (ConvergenceError, MeshError) as error:
            log.info("%s: mounted where it is drawn", error)
            place_as_drawn(state)
    try:
        return cycle()
    except ConvergenceError as error:
        raise error.with_words(after=nothing_stops) from None


def _mesh_finer(state: State, error: ConvergenceError | MeshError) -> bool:
    """Mesh the unworn part with half of the edges; False if it was mounted, or ``error`` tells why it was not."""
    scene, explained = state.stage.scene, False
    if isinstance(error, ConvergenceError):
        explained = bool(error.cause) or (error.report is not None and error.report.outcome is Outcome.SINGULAR)
    if state.phases or explained or scene.deactivation is not None:
        return False
    lengths = scene.accuracy.lengths
    patch, mounting, coarse = (FINER * length for length in (lengths.patch, lengths.mounting, lengths.coarse))
    finer = replace(scene, accuracy=replace(scene.accuracy, patch=patch, mounting=mounting, coarse=coarse))
    log.info("%s: mounted on elements of half the edges", error)
    state.stage = Stage(scene, unworn_body(finer, state.across))
    state.fine = np.empty((0, 3))
    return True


def _first_cycle(
    state: State,
    on_mount: Callable[[float], None],
    lost_elements: ModuleType | None,
    *,
    lowers: bool = True,
    shorter: bool = True,
) -> list[Forces]:
    """The same from where the part is placed; ``lowers`` as in ``advance_while_sliding``."""
    forces: list[Forces] = []
    cycle, state.phases = state.stage.scene.program.cycle, []
    begin = unloaded(state)
    state.stage.begin_unloaded(begin)
    state.work.add(mount(state.stage, on_mount, partial(advance_on_finer, state, begin=begin)))
    if lost_elements is not None:
        lost_elements.begin(state)
    for i, stroke in enumerate(cycle):
        stage, halved = state.stage, state.halved
        begin = stage.problem.state.vec.FV().NumPy().copy()
        stage.begin(begin)
        stage.leave_fluid(stage.fluid_left())
        path: list[tuple[float, Array]] = []
        on_step = recorder(stage.problem, path)
        loads = stage.stroke_loads(stroke)
        options = steps_for(state, i, StepOptions(first=MOVING if stage.floats else 0.5, shorter=shorter))
        try:
            work, whole = advance_while_sliding(
                state, stroke.name, loads, options, begin=begin, on_step=on_step, lowers=lowers
            )
        except ConvergenceError as error:
            raise error.with_words(f"in stroke '{stroke.name}': ") from None
        stage = state.stage
        state.work.add(work)
        needed = i > 0 and work.retries > 0 and stage.has_stick_slip and stage.scene.deactivation is None
        needed &= whole and state.halved == halved  # the way with other friction, or on another mesh, is of no use
        path = path if needed else []
        vector = stage.problem.state.vec.FV().NumPy().copy()
        shares, passed, left = stage.shares(stroke), stage.fluid_passed(), stage.fluid_left()
        state.phases.append(Phase(vector, shares=shares, path=path, passed=passed, left=left))
        forces.append(stage.forces())
        on_mount(0.7 + 0.2 * (i + 1) / len(cycle))
    return forces
