"""The equilibrium of one stroke: at once from a guess, by the load steps of the last solve, or by new load steps."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ngwear.equilibrium.newton import NewtonOptions, Report
from ngwear.equilibrium.problem import Problem
from ngwear.equilibrium.state_transfer import unfold
from ngwear.equilibrium.stepping import StepOptions, Work, advance, relax, settle
from ngwear.errors import ConvergenceError
from ngwear.loop.bearable_friction import takes_less
from ngwear.loop.carried_state import HARDEST, set_to_end
from ngwear.loop.stage import Stage
from ngwear.loop.state import State
from ngwear.scene.program import Stroke
from ngwear.wear.cycle_jumps import Plan
from ngwear.wear.sliding_distance import Strokes

Array = NDArray[np.float64]
log = logging.getLogger(__name__)

EMPTIES = 1 / 8  # of the fall of a fluid's pressure in a load step: so exact is the pressure that a pocket keeps
# Settled on the shipped O-ring and the torn seal: the list in tests/benchmarks/README.md says by which command.
FAR = 0.1  # of the section: how far a fluid passes contacts in one solve on a new mesh, before steps are taken
RESTS = 3  # a solve at once that has failed so often in a row is tried in every eighth solve
AHEAD = 2  # load steps of the last way that may be left out behind one that fails
# Settled on an X-ring: the list says by which command.
MOVING = 1 / 16  # of a load change: the first step of a part with room to move; it grows while it is easy
LOWERED = 3  # times in a solve: how often the friction is lowered that a worn part does not bear any more


def solve_stroke(
    state: State,
    index: int,
    stroke: Stroke,
    sliding: Strokes,
    *,
    plan: Plan = (),
    at_once: bool = False,
    lowers: bool = True,
) -> int:
    """Solve the equilibrium of one stroke with implicit wear over ``sliding``; return the Newton iterations.

    It is tried at once, from the end of the stroke before and from its own end in the last cycle, else in load steps.
    ``plan`` is the plan of the step, for the memory. With ``at_once`` no load steps are tried, except where pockets may
    keep what a fluid leaves. With ``lowers`` a stroke whose friction the part does not bear is solved with less of it.

    Raises
    ------
    ConvergenceError
        If a load step fails, or there is no equilibrium ``at_once``.
    """
    stage, phase = state.stage, state.phases[index]
    problem = stage.problem
    vector = problem.state.vec.FV().NumPy()
    _begin(state, index, stroke, sliding, plan)
    before, fresh, repeats = phase.vector, phase.rate is None, sliding.repeats
    work, path, fewest = Work(), phase.path, phase.fewest
    guesses = [before] if phase.rate is None else [before + repeats * phase.rate, before]
    waits, in_steps = phase.rests > 0 and (bool(phase.path) or phase.stays), empties(state, index)
    if waits or (phase.path and phase.shares is None) or in_steps:
        guesses = []  # nor on a new mesh, if it took steps on the last one
    last, solved = None, False
    for guess in guesses:
        _let_fluid_pass(state, index)
        last = _solves(state, guess, work)
        if solved := last.converged:
            break
    stays = False
    if not solved or (stage.floats and fresh and _passes_far(stage, phase.passed)):
        stays = not in_steps and _stays(state, index, stroke, work)
        path = []  # it is not the way to this end
        if not stays:
            if at_once and not in_steps:
                raise ConvergenceError(f"the {stroke.name} stroke needs load steps", last)
            hard = repeats > 1 or (bool(stage.floats) and not lowers)
            path, fewest = _by_steps(state, index, stroke, work, hard=hard)
    state.work.add(work)
    rate = (vector - before) / repeats if repeats and not fresh else np.zeros_like(vector)
    shares = stage.shares(stroke)
    rate = rate if repeats else None
    failed, rests = (0, 0) if solved else (phase.failed, max(phase.rests - 1, 0))
    if guesses and not solved:
        failed = min(phase.failed + 1, RESTS)
        rests = 2**failed - 1
    state.phases[index] = replace(
        phase,
        vector=vector.copy(),
        rate=rate,
        shares=shares,
        path=path,
        fewest=fewest,
        stays=stays,
        failed=failed,
        rests=rests,
        passed=stage.fluid_passed(),
        left=stage.fluid_left(),
    )
    return work.iterations


def _stays(state: State, index: int, stroke: Stroke, work: Work) -> bool:
    """Solve a stroke from its own end in the last cycle: a point that sticks there stays where it was then.

    For a part with room to move. Where points slide to and fro within a stroke, its end in the cycle before says which
    way they slid last, which its beginning does not; so does it say which contacts the fluid has lifted.
    """
    stage, phase = state.stage, state.phases[index]
    if not (stage.floats and stage.has_stick_slip):
        return False
    set_to_end(stage, phase, stroke)
    report = _solves(state, phase.vector, work)
    solved = report.converged and not (phase.rate is None and _passes_far(stage, phase.passed))
    stage.begin(state.phases[index - 1].vector)  # slip and heat are those of the stroke
    stage.problem.set_loads(stage.stroke_loads(stroke))
    return solved


def _passes_far(stage: Stage, before: Array | None) -> bool:
    """Whether a fluid has passed a share (``FAR``) of the section more of the contacts than ``before``.

    On a new mesh, with all of its pressure at once, it may pass contacts that hold it if the pressure rises in steps.
    """
    now = stage.fluid_passed()
    if now is None:
        return False
    lengths = np.array([fluid.passed_lengths for fluid in stage.fluids.values()])
    apart = np.full(lengths.shape, np.nan) if before is None else np.linalg.norm(now - before, axis=-1)
    farther = np.where(np.isnan(apart), lengths, np.minimum(apart, lengths))
    return bool((farther > FAR * stage.body.size).any())


def _let_fluid_pass(state: State, index: int) -> None:
    """Set the places up to which the fluids had lifted contacts at the stroke's last end, before a solve from there."""
    stage = state.stage
    stage.let_fluid_pass(state.phases[index].passed, after=stage.scene.program.cycle[index - 1])


def _begin(state: State, index: int, stroke: Stroke, sliding: Strokes, plan: Plan) -> None:
    """Begin a stroke at the end of the one before, with the laws and the memory of the strokes it stands for."""
    stage, before = state.stage, state.phases[index - 1]
    stage.begin(before.vector)
    stage.leave_fluid(before.left)
    stage.problem.set_loads(stage.stroke_loads(stroke))
    for friction in stage.frictions.values():
        friction.coefficient.set_state(sliding.middle, stroke.speed)
    if stage.has_stick_slip:
        from ngwear.loop.slip_over_cycles import slip_per_cycle

        stage.set_shares(slip_per_cycle(stage.scene.program.cycle, state.phases, index, sliding.repeats))
    if state.counters:
        from ngwear.loop import counter_surface

        counter_surface.place(stage, state.counters, index, sliding)
    if state.memory is not None and stage.memory is not None:
        state.memory.prepare(stage.memory, plan, index)


def pass_stroke(state: State, index: int, stroke: Stroke, sliding: Strokes, *, steps: int) -> int:
    """Solve a stroke without wear in load steps from the end of the one before; return the Newton iterations.

    Unlike ``solve_stroke``, which begins at its last equilibrium, and where friction sticks finds that again. The phase
    then has the way, and a next solve goes that way again, at its load steps. Where these fail the part may snap: then
    they are shorter, as in the cycle in which it was mounted, and it may move over to another equilibrium.

    Raises
    ------
    ConvergenceError
        If a load step fails.
    """
    stage, problem, phase, work = state.stage, state.stage.problem, state.phases[index], Work()
    _begin(state, index, stroke, sliding, ())
    options = StepOptions(first=1 / steps, largest=1 / steps, smallest=HARDEST, leaps=False)
    try:
        if phase.path:
            phase.fewest = True
            path, _ = _follow(state, index, stroke, work, options)
        else:
            path = _from_last_stroke(state, index, stroke, work, options)
    except ConvergenceError as error:
        log.info("%s: as in the first cycle", error)
        path = _from_last_stroke(state, index, stroke, work, StepOptions(first=MOVING))
    state.work.add(work)
    vector, passed, left = problem.state.vec.FV().NumPy().copy(), stage.fluid_passed(), stage.fluid_left()
    shares = stage.shares(stroke)
    state.phases[index] = replace(phase, vector=vector, shares=shares, path=path, passed=passed, left=left)
    return work.iterations


def settle_last_stroke(state: State, *, at_once: bool = False) -> None:
    """Bring the end of the cycle's last stroke, as transferred to a new mesh, to equilibrium there.

    A point that sticks stays where it is. The next stroke starts from there: from a state out of balance its first load
    step, however short, would have to undo that, too.

    Raises
    ------
    ConvergenceError
        If there is no equilibrium nearby, or ``at_once``.
    """
    stage, last, work = state.stage, state.phases[-1], Work()
    set_to_end(stage, last, stage.scene.program.cycle[-1])
    report = _solves(state, last.vector, work)
    if at_once and not report.converged:
        raise ConvergenceError("the last stroke of the cycle needs load steps", report)
    if not report.converged:
        _set_guess(state, last.vector)
        work.add(relax(stage.problem, StepOptions(first=0.25, smallest=HARDEST)))
    state.work.add(work)
    last.vector = stage.problem.state.vec.FV().NumPy().copy()


def _solves(state: State, guess: Array, work: Work) -> Report:
    """Try to solve the present loads at once from a first guess."""
    _set_guess(state, guess)
    for term in state.stage.problem.terms:
        term.refresh()
    stage = state.stage
    # With stick, load steps take less time, but for a part with room to move, which they may take elsewhere.
    options = NewtonOptions(rounds=not stage.has_stick_slip or bool(stage.floats), moves=not stage.has_stick_slip)
    return settle(state.stage.problem, StepOptions(newton=options), work)


def _by_steps(
    state: State, index: int, stroke: Stroke, work: Work, *, hard: bool
) -> tuple[list[tuple[float, Array]], bool]:
    """Solve a stroke in load steps; return ``Phase.path`` and ``Phase.fewest``.

    The search ends at a larger load step if it is ``hard``: after a jump, because fewer strokes in one solve are
    easier, and on a new mesh on which a part with room to move may be mounted anew, because that is. Else a stroke
    whose friction the part does not bear, as the wear or the strokes before have changed it, is solved with less of it.

    Raises
    ------
    ConvergenceError
        If a load step fails.
    """
    options = StepOptions(first=0.25, smallest=HARDEST if hard else StepOptions.smallest)
    lowered = 0
    while True:
        try:
            if state.phases[index].path:
                return _follow(state, index, stroke, work, options)
            return _approach(state, index, stroke, work, options), False
        except ConvergenceError as error:
            if not hard and lowered < LOWERED and takes_less(state.stage, stroke.name, error):
                lowered += 1
                state.stage.problem.set_loads(state.stage.stroke_loads(stroke))
                continue
            raise ConvergenceError(
                f"no equilibrium in the {stroke.name} stroke after stroke {state.strokes}: {error}",
                error.report,
                cause=error.cause,
            ) from None


def _set_guess(state: State, vector: Array) -> None:
    """Set the first guess of the next solve; inverted elements are unfolded if the scene deactivates elements."""
    problem = state.stage.problem
    problem.state.vec.FV().NumPy()[:] = vector
    if state.stage.scene.deactivation is not None:
        unfold(problem)


def empties(state: State, index: int) -> bool:
    """Whether a fluid that pockets may keep has a lower pressure than in the stroke before."""
    cycle, fluids = state.stage.scene.program.cycle, state.stage.fluids
    if state.stage.trapped is None:
        return False
    return any(cycle[index].pressure_at(name) < cycle[index - 1].pressure_at(name) for name in fluids)


def steps_for(state: State, index: int, options: StepOptions) -> StepOptions:
    """Options of the load steps to a stroke: small ones where pockets may keep what a fluid leaves (``empties``)."""
    return replace(options, first=EMPTIES, largest=EMPTIES) if empties(state, index) else options


def _begin_path(state: State, index: int) -> None:
    """Set the end of the previous stroke of the cycle and its loads; friction counts the slip from there."""
    stage, before = state.stage, state.phases[index - 1].vector
    stage.problem.set_loads(stage.stroke_loads(state.stage.scene.program.cycle[index - 1]))
    stage.let_fluid_pass(state.phases[index - 1].passed)
    stage.leave_fluid(state.phases[index - 1].left)
    _set_guess(state, before)
    stage.begin(stage.problem.state.vec.FV().NumPy())


def _follow(
    state: State, index: int, stroke: Stroke, work: Work, options: StepOptions
) -> tuple[list[tuple[float, Array]], bool]:
    """Reach a stroke's equilibrium by load steps of its last solve: half as many, if those suffice.

    Where friction sticks, an equilibrium depends on the way; the states on the last way are near those on this one.
    A step that fails may be one at which the part snaps, which wear moves along the way: then the next ones are tried,
    up to ``AHEAD``, whose last states lie behind the snap. If they fail, too, it is taken in shorter ones. If that is
    easy the part is elsewhere than on its last way: its states are not tried until it snaps again.
    """
    problem, known, fewest = state.stage.problem, state.phases[index].path, state.phases[index].fewest
    _begin_path(state, index)
    target, loads = state.stage.stroke_loads(stroke), problem.get_loads()
    path: list[tuple[float, Array]] = []
    reached, carried = 0.0, bool(state.stage.floats) and state.phases[index].shares is None

    def at(fraction: float) -> dict[str, float]:
        return {name: loads[name] + fraction * (end - loads[name]) for name, end in target.items()}

    def solves(step: int) -> bool:
        state.stage.let_fluid_pass(passed)
        problem.set_loads(at(known[step][0]))
        solved = _solves(state, known[step][1], work).converged
        return solved and not (carried and _passes_far(state.stage, state.phases[index].passed))

    here, elsewhere = 0, False
    while here < len(known):
        begin, passed = problem.state.vec.FV().NumPy().copy(), state.stage.fluid_passed()
        halved = not fewest and (len(known) - here) % 2 == 0
        ahead = 0 if state.phases[index].shares is None else AHEAD  # those on another mesh are of no use
        tried = [here + 1] if halved else []
        tried += [step for step in range(here, min(here + 1 + ahead, len(known))) if step not in tried]
        solved = None if elsewhere else next((step for step in tried if solves(step)), None)
        fewest |= halved and not elsewhere and solved != here + 1
        step = here if solved is None else solved
        goal = known[step][0]
        if solved is not None:
            problem.commit()
            path.append((goal, problem.state.vec.FV().NumPy().copy()))
        else:
            _set_guess(state, begin)
            problem.set_loads(at(reached))
            state.stage.let_fluid_pass(passed)
            for term in problem.terms:
                term.refresh()
            shorter: list[tuple[float, Array]] = []
            way = replace(options, first=1.0 if elsewhere else 0.5)
            done = advance(problem, at(goal), way, on_step=recorder(problem, shorter))
            work.add(done)
            elsewhere = done.retries == 0
            path += [(reached + fraction * (goal - reached), vector) for fraction, vector in shorter]
        reached, here = goal, step + 1
    return path, fewest


def _approach(state: State, index: int, stroke: Stroke, work: Work, options: StepOptions) -> list[tuple[float, Array]]:
    """Reach a stroke's equilibrium in load steps: from its last state, else from the previous stroke of the cycle.

    Returns these steps if friction sticks, for ``Phase.path``.
    """
    stage, problem = state.stage, state.stage.problem
    phase = state.phases[index]
    _set_guess(state, phase.vector)
    follows, lowered = stage.has_stick_slip and stage.scene.deactivation is None, empties(state, index)
    if not follows and not lowered:
        _let_fluid_pass(state, index)
        try:
            work.add(relax(problem, options))
            if not (stage.floats and phase.rate is None and _passes_far(stage, phase.passed)):
                return []
            log.info("the fluid passes a contact at once: trying from the previous stroke")
        except ConvergenceError as error:
            log.info("%s: trying from the previous stroke", error)
    path = _from_last_stroke(state, index, stroke, work, steps_for(state, index, options))
    return path if follows and not lowered else []


def _from_last_stroke(
    state: State, index: int, stroke: Stroke, work: Work, options: StepOptions
) -> list[tuple[float, Array]]:
    """Reach a stroke's equilibrium in load steps from the previous stroke of the cycle; return these steps."""
    stage, path = state.stage, list[tuple[float, Array]]()
    _begin_path(state, index)
    work.add(advance(stage.problem, stage.stroke_loads(stroke), options, on_step=recorder(stage.problem, path)))
    return path


def recorder(problem: Problem, path: list[tuple[float, Array]]) -> Callable[[float, Report], None]:
    """``on_step`` that appends each fraction and its equilibrium to ``path``."""
    return lambda fraction, _: path.append((fraction, problem.state.vec.FV().NumPy().copy()))
