"""A finer mesh where the present one does not bear a load step, or does not resolve a solve.

Only for parts with room to move, which are mounted on coarse elements; others are refined before their first stroke.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ngwear.equilibrium.attempts import let_go
from ngwear.equilibrium.newton import Report
from ngwear.equilibrium.problem import Loads
from ngwear.equilibrium.stepping import StepOptions, Work, advance, relax
from ngwear.errors import ConvergenceError, MeshError
from ngwear.loop.carried_state import HARDEST, set_guess
from ngwear.loop.remeshing import remesh
from ngwear.loop.solution_checks import Finding
from ngwear.loop.state import Phase, State
from ngwear.scene.accuracy import PRESETS
from ngwear.scene.scene import Scene

Array = NDArray[np.float64]
log = logging.getLogger(__name__)

FINER = 0.5  # times the present element edges
EVERYWHERE, LOCALLY = 2, 3  # how often in a run: sixteen times as many elements; an eighth of the edge at a place


def may_be_finer(state: State) -> bool:
    """Whether a run may still halve all elements."""
    return remeshes(state) and state.halved < EVERYWHERE


def remeshes(state: State) -> bool:
    """Whether the part has room to move, and its mesh may change."""
    scene = state.stage.scene
    return bool(state.stage.floats) and scene.wear.remesh == "due" and scene.deactivation is None


def refine_everywhere(state: State) -> None:
    """Halve the edges of all elements, and those along the outline, and transfer the state.

    An element that the outline's curvature makes short there may be long inside.

    Raises
    ------
    MeshError
        If the mesh fails a check; the state is then unchanged.
    """
    points, body = state.stage.problem.points, state.stage.body
    points.follow()
    inside = np.column_stack([points.centres, points.edges])
    t = body.outline.t
    along = np.linalg.norm(body.contour.at(t[:, 1]) - body.contour.at(t[:, 0]), axis=1)
    fine = np.vstack([inside, np.column_stack([body.contour.at(t.mean(axis=1)), along])])
    remesh(state, scene=state.stage.scene, fine=fine * (1.0, 1.0, FINER))
    state.halved += 1


def unresolved(state: State) -> list[Finding]:
    """What the mesh does not resolve in the last solves, if a run may still refine there."""
    on_purpose = state.across is not None and state.across < PRESETS["draft"]  # a run that others are compared with
    if on_purpose or not remeshes(state) or state.refined >= LOCALLY:
        return []
    return [found for report in state.reports for found in report.findings if len(found.places)]


def refine_at(state: State, found: Sequence[Finding]) -> None:
    """Halve the element edges where findings ask for it, and transfer the state.

    Raises
    ------
    MeshError
        If the mesh fails a check; the state is then unchanged.
    """
    asked = [finding.places * (1.0, 1.0, FINER) for finding in found]
    remesh(state, scene=state.stage.scene, fine=np.vstack([state.fine, *asked]))
    state.refined += 1


def keep_as_it_is(state: State) -> None:
    """Refine no more at findings: finer elements did not help, and the findings stay warnings."""
    state.refined = LOCALLY


def go_back(state: State, coarse: dict[str, Any], error: Exception) -> None:
    """Go back to the state saved on coarser elements, since finer ones failed with this error, and keep these."""
    log.info("%s: back to the coarser elements", error)
    state.restore(coarse)
    keep_as_it_is(state)


def back_to_coarser(
    state: State, coarse: dict[str, Any], scene: Scene, error: ConvergenceError | MeshError
) -> list[Finding]:
    """Go on with the last mesh, of ``scene``, if none as fine as the accuracy asks for has an equilibrium; a finding.

    ``coarse`` is the state saved on that mesh.

    Raises
    ------
    ConvergenceError, MeshError
        The error, if the part is held, if the last mesh was the one for mounting, or if the part itself shows the
        cause, such as a surface that creases: coarse elements bear more than the rubber.
    """
    explained = isinstance(error, ConvergenceError) and bool(error.cause)
    if explained or not remeshes(state) or coarse["ledger"].remeshes == 0:
        raise error
    go_back(state, coarse, error)
    state.stage.scene = scene
    said, elements = str(error).partition("\n")[0], state.stage.body.mesh.ne
    sentence = f"the results are on {elements} elements: no equilibrium was found on finer ones, which the accuracy "
    sentence += f"asks for, and what they would change is not known; the way there failed with: {said}"
    return [Finding("coarser", 1.0, sentence)]


def advance_on_finer(
    state: State,
    target: Loads,
    options: StepOptions,
    *,
    begin: Array,
    on_step: Callable[[float, Report], None] | None = None,
) -> Work:
    """As ``advance``; a load step that fails goes on from the state before it, on elements of half the edges.

    Not where the part itself shows the cause, such as a surface that creases: finer elements do not change that.

    Parameters
    ----------
    begin : array
        State at the beginning of the stroke, from which slip is measured.

    Raises
    ------
    ConvergenceError
        If a load step fails on the finest elements, too.
    MeshError
        If a finer mesh fails a check.
    """
    work = Work()
    while True:
        try:
            work.add(advance(state.stage.problem, target, options, on_step=on_step))
        except ConvergenceError as error:
            if error.cause or not may_be_finer(state):
                raise
            log.info("%s: on finer elements", error)
            work.retries += 1
            begin = _carry_on(state, begin, work)
            continue
        return work


def _carry_on(state: State, begin: Array, work: Work) -> Array:
    """Take the present state and that at the beginning of the stroke, which is returned, to finer elements."""
    before, phases = state.stage, state.phases
    loads, passed, left = before.problem.get_loads(), before.fluid_passed(), before.fluid_left()
    state.phases = [*phases, Phase(begin), Phase(before.problem.state.vec.FV().NumPy().copy())]
    try:
        refine_everywhere(state)
        *phases, begun, now = state.phases
    finally:
        state.phases = phases
    stage = state.stage
    stage.begin(begun.vector)
    stage.problem.set_loads(loads)
    stage.leave_fluid(left)
    set_guess(stage, now.vector, passed)
    try:
        work.add(relax(stage.problem, StepOptions(first=1.0, smallest=HARDEST)))
    except ConvergenceError as error:
        log.info("%s: held back", error)
        set_guess(stage, now.vector, passed)
        for report in let_go(stage.problem):
            work.count(report)
        if not report.converged:
            raise
    return begun.vector
