"""Steps of a run: equilibrium of each stroke, wear, new outline, and a new mesh if needed."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from dataclasses import replace
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import ConvergenceError, GeometryError, MeshError, require
from ngwear.loop import finer_mesh
from ngwear.loop.carried_state import settle_carried
from ngwear.loop.element_sizes import coarse_for_mounting, with_contact_lengths, with_mounting_lengths, with_patch
from ngwear.loop.first_cycle import first_cycle
from ngwear.loop.law_changes import steady_cycles
from ngwear.loop.mounting import give_memory, refuse_useless, unworn_body, warn_if_unstable
from ngwear.loop.placing import placed
from ngwear.loop.refinement import is_too_coarse
from ngwear.loop.remeshing import is_due, remaining_sliding, remesh
from ngwear.loop.repeating_cycle import CYCLE_STEPS, creeping, repeat_cycle
from ngwear.loop.solution_checks import Finding
from ngwear.loop.stage import Stage
from ngwear.loop.state import State, StrokeReport, with_findings
from ngwear.loop.stroke_report import stroke_report
from ngwear.loop.stroke_solve import pass_stroke, settle_last_stroke, solve_stroke
from ngwear.loop.wear_step import WearStep
from ngwear.scene.boundary import GO_ON
from ngwear.scene.scene import Scene
from ngwear.wear.cycle_jumps import Plan, planned
from ngwear.wear.jump_control import JumpControl
from ngwear.wear.sliding_distance import Strokes

if TYPE_CHECKING:  # modules of effects that a scene does not have are not imported
    from ngwear.effects.blow_by import BlowBy

Array = NDArray[np.float64]
log = logging.getLogger(__name__)

# These were settled on the rod seal (NARROWER, FIRST), an O-ring (AT_ONCE) and the torn seal
# (LATE): the list in tests/benchmarks/README.md says by which command.
NARROWER = 0.8  # how much narrower than on the last mesh contacts may be found on the first ones
AT_ONCE = 3.0  # times as short as on the last mesh are the patch's edges of the next, if the part has room to move
FIRST = 10  # times as long as the first step is the longest one
LATE = 0.01  # of the program's cycles: how much later than it fails an element may be torn, at the end of a jump


class Stepper:
    """Run a scene step by step: ``state = stepper.start()``, then ``state = stepper.advance(state)``.

    Parameters
    ----------
    scene : Scene
    on_mount : callable or None
        Called with the completed fraction of the mounting.

    Raises
    ------
    SceneError
        If the scene gives ``accuracy.error``: that needs several runs.
    """

    def __init__(self, scene: Scene, *, on_mount: Callable[[float], None] | None = None) -> None:
        error = scene.accuracy.error
        require(
            error is None,
            "accuracy.error",
            error,
            "needs several runs: use ngwear.run",
        )
        self.scene, self._across = with_mounting_lengths(scene), scene.accuracy.across
        self.on_mount = on_mount or (lambda fraction: None)
        self._lost_elements: ModuleType | None = None
        if scene.deactivation is not None:
            from ngwear.loop import lost_elements

            self._lost_elements = lost_elements
        warn_if_unstable(self.scene)

    def start(self) -> State:
        """Mount the part on a coarse mesh, solve each stroke of the cycle once, and refine the contacts.

        Raises
        ------
        ConvergenceError
            If the part cannot be mounted.
        SceneError
            If a surface that should wear the part touches it in no stroke.
        """
        scene, accuracy = self.scene, self.scene.accuracy
        coarse = coarse_for_mounting(scene)
        stage = Stage(coarse, unworn_body(coarse, self._across))
        cycles = scene.program.strokes / len(scene.program.cycle)
        tolerances = accuracy.tolerances
        longest = max(1, math.ceil(tolerances.longest_jump * cycles))
        if scene.wear.max_jump is not None:
            longest = min(scene.wear.max_jump, longest)
        tears = scene.deactivation is not None  # a long first step would tear too much
        first = 1 if tears else max(1, longest // FIRST)
        control = JumpControl(tolerances.wear_error, depth=tolerances.depth_error, cycles=first, longest=longest)
        state = State(stage, [], control, across=self._across)
        state.counters = {name: c.counter for name, c in stage.contacts.items() if c.counter is not None}
        forces = first_cycle(state, self.on_mount, self._lost_elements)
        refuse_useless(state)
        if scene.deactivation is None:
            repeat_cycle(state, self._pass, forces)  # most of the way on few elements
            found = self._refine(state)
            if not state.reports:  # back on the elements on which it was mounted
                self._settle_cycle(state)
            change = repeat_cycle(state, self._pass, [report.forces for report in state.reports])
            state.reports = with_findings(state.reports, found + creeping(change) + placed(state))
        else:
            self._settle_cycle(state)
        arms = scene.arms
        if arms is not None:
            give_memory(state, scene, arms)
        self.on_mount(1.0)
        return state

    def _refine(self, state: State) -> list[Finding]:
        """Remesh until the mesh is fine enough for all strokes; a finding if there is no equilibrium on such a mesh."""
        ahead, floats = remaining_sliding(state), bool(state.stage.floats)
        levels = 2 if floats else 4  # more remeshes improve little here; the run remeshes where it must
        provisional = state.across is not None  # the mounting mesh may also be too fine
        found: list[Finding] = []
        while state.ledger.remeshes < levels:
            vectors, before = [phase.vector for phase in state.phases], state.stage.scene
            scene = before
            if state.across is not None:
                scene = with_contact_lengths(state.stage, vectors, state.across)
            elif floats:
                scene = self.scene
            wanted, had = scene.accuracy.lengths.patch, before.accuracy.lengths.patch
            enough = not provisional and wanted >= NARROWER * had
            # A part with room to move is mounted on coarse elements: its contacts are found anew on the next ones.
            provisional = floats and (state.ledger.remeshes == 0 or wanted < NARROWER * had)
            if floats and wanted < had / AT_ONCE:
                scene, levels = with_patch(scene, had / AT_ONCE), levels + 1
            state.stage.scene = scene
            if enough and not is_too_coarse(state.stage, vectors, **ahead):
                state.stage.scene = before
                if not self._resolves(state):
                    break
                levels += 1
                continue
            coarse = state.saved()
            try:
                remesh(state, scene=scene if floats else None)
                self.settle_on_new_mesh(state)
            except (ConvergenceError, MeshError) as error:
                found = finer_mesh.back_to_coarser(state, coarse, before, error)
                break
            self.on_mount(0.9 + 0.02 * min(state.ledger.remeshes, 4))
        while self._resolves(state):  # the last new mesh has not been looked at
            pass
        state.counters = {name: c.counter for name, c in state.stage.contacts.items() if c.counter is not None}
        return found

    def settle_on_new_mesh(self, state: State, *, anew: bool = True) -> None:
        """Settle the cycle from the states carried over.

        A part with room to move settles at once, or after ``settle_carried``, or else, if asked, is mounted ``anew``.

        Raises
        ------
        ConvergenceError
            If it finds no equilibrium.
        """
        carried, floats = state.saved(), bool(state.stage.floats)
        try:
            self._settle_cycle(state, at_once=floats)
            return
        except ConvergenceError as error:
            log.info("%s: on another way", error)
        ways = [self._held_back] if floats else []
        if anew:
            ways.append(self._anew)
        if (anew and state.stage.has_stick_slip) or not ways:
            ways.append(self._settle_cycle)
        for way in ways:
            state.restore(carried | {"phases": [replace(phase) for phase in carried["phases"]]})
            try:
                way(state)
                return
            except ConvergenceError as error:
                log.info("%s: on another way", error)
                if way == ways[-1]:
                    raise

    def _held_back(self, state: State) -> None:
        """Settle the cycle after the states carried over have been brought near their equilibrium."""
        settle_carried(state)
        self._settle_cycle(state, at_once=state.stage.has_stick_slip)

    def _anew(self, state: State) -> None:
        """Mount the part on this mesh, and settle the cycle."""
        first_cycle(state, lambda fraction: None, self._lost_elements)
        self._settle_cycle(state, lowers=True)

    def _resolves(self, state: State) -> bool:
        """Settle the cycle on finer elements where the last solves ask for them; False if none do, or it fails."""
        if not (found := finer_mesh.unresolved(state)):
            return False
        coarse = state.saved()
        try:
            finer_mesh.refine_at(state, found)
            self.settle_on_new_mesh(state)
        except (ConvergenceError, MeshError) as error:
            finer_mesh.go_back(state, coarse, error)
            return False
        return True

    def _pass(self, state: State, index: int) -> StrokeReport:
        """Solve a stroke without wear, in load steps from the end of the one before."""
        stroke, sliding = self.scene.program.cycle[index], self._strokes(index, 0)
        WearStep.begin(state, index, sliding)
        iterations = pass_stroke(state, index, stroke, sliding, steps=CYCLE_STEPS)
        return self._report(state, index, iterations, sliding)

    def _settle_cycle(self, state: State, *, at_once: bool = False, lowers: bool = False) -> None:
        """Solve each stroke of the cycle once on the present outline, without wear, as ``solve_stroke``."""
        state.reports = []
        if state.stage.floats and state.stage.has_stick_slip:
            settle_last_stroke(state, at_once=at_once)
        for i, stroke in enumerate(self.scene.program.cycle):
            sliding = self._strokes(i, 0)
            wear_step = WearStep.begin(state, i, sliding)
            iterations = solve_stroke(state, i, stroke, sliding, at_once=at_once, lowers=lowers or state.strokes > 0)
            wear_step.store_rates()
            state.reports.append(self._report(state, i, iterations, sliding))

    def finished(self, state: State) -> bool:
        """Whether all strokes of the program are completed, or the scene ends here (``blown``)."""
        return state.strokes >= self.scene.program.strokes or self.blown(state) is not None

    def blown(self, state: State) -> BlowBy | None:
        """The fluid that no contact holds, in the last step of a run that ends there (``Fluid.blow_by``)."""
        fluid = self.scene.fluid
        if fluid is None or fluid.blow_by == GO_ON:
            return None
        return next((blown for report in state.reports for blown in report.blow_by), None)

    def advance(self, state: State) -> State:
        """Take one step: solve each stroke of the cycle once, for as many strokes as the error control allows.

        A step that fails, or whose error is too large, is rejected and tried again with half the cycles.

        Raises
        ------
        ConvergenceError, GeometryError, MeshError
            If a step of one cycle fails; the state is then the last accepted one.
        """
        program, most = self.scene.program, self.scene.program.strokes
        coarser: dict[str, Any] | None = None  # the state before its elements were refined for this step
        while True:
            goal = min([m for m in self.scene.marks if m > state.strokes] + [program.strokes])
            left = math.ceil((min(goal, program.strokes) - state.strokes) / len(program.cycle))
            wear = self.scene.wear
            cycles = {"each": 1, "fixed": min(wear.max_jump or 1, left), "jump": state.control.share(left)}[wear.step]
            cycles = steady_cycles(self.scene, state.strokes, min(cycles, most))
            saved, to_one = state.saved(), False
            try:
                ratio = self._step(state, cycles)
            except (ConvergenceError, GeometryError, MeshError) as error:
                explained = isinstance(error, ConvergenceError) and bool(error.cause)
                if cycles == 1:
                    state.restore(saved)
                    if coarser is None and (explained or not finer_mesh.may_be_finer(state)):
                        raise
                    log.info("step of one cycle failed (%s); tried on other elements", error)
                    if coarser is None:
                        finer_mesh.refine_everywhere(state)
                    else:
                        state.restore(coarser)
                        finer_mesh.keep_as_it_is(state)
                        coarser = None
                    continue
                log.info("step of %d cycles failed (%s); fewer are tried", cycles, error)
                ratio = math.inf
                # A surface that creases, or a part that rolls, does so in half of the cycles, too.
                to_one = explained and bool(state.stage.floats)
            if ratio == math.inf or (self.scene.wear.step == "jump" and not state.control.accepts(ratio, cycles)):
                state.restore(saved)
                most = state.control.cut(cycles, to_one=to_one)
                continue
            if found := finer_mesh.unresolved(state):
                state.restore(saved)
                coarser = state.saved()
                finer_mesh.refine_at(state, found)
                continue
            share = (state.strokes - saved["strokes"]) / program.strokes
            off = state.ledger.depth_ratio(saved["ledger"], share, left=1 - state.strokes / program.strokes)
            state.control.update(ratio, cycles, off)
            if state.strokes in self.scene.kept:
                self._report_other_strokes(state)
            return state

    def _report_other_strokes(self, state: State) -> None:
        """Solve the other strokes of the cycle on the present outline and add their reports; nothing else changes."""
        latest = state.reports[-1].phase
        for i in range(len(self.scene.program.cycle)):
            if i != latest:
                saved = state.phases[i]
                state.reports.insert(-1, self._solve_without_wear(state, i, self._next_cycle(state)))
                state.phases[i] = saved
        self.restore_last_stroke(state)

    def solve_next_cycle(self, state: State) -> list[StrokeReport]:
        """Solve the strokes of the next cycle without wear; this changes the states and the memory of ``state``."""
        plan, reports = self._next_cycle(state), []
        for i, _ in plan:
            reports.append(self._solve_without_wear(state, i, plan))
            if state.memory is not None and state.stage.memory is not None:
                state.memory.record(state.stage.memory, i)
        return reports

    def restore_last_stroke(self, state: State) -> None:
        """Set the problem to the loads and the equilibrium at the end of the last stroke."""
        problem, latest = state.stage.problem, state.reports[-1].phase
        problem.set_loads(state.stage.stroke_loads(self.scene.program.cycle[latest]))
        problem.state.vec.FV().NumPy()[:] = state.phases[latest].vector
        for term in problem.terms:
            term.refresh()

    def _next_cycle(self, state: State) -> Plan:
        kinds = len(self.scene.program.cycle)
        return planned(kinds, state.strokes, 1, state.strokes + kinds)

    def _solve_without_wear(self, state: State, index: int, plan: Plan) -> StrokeReport:
        """Solve a stroke of the cycle on the present outline, without wear."""
        state.phases[index] = replace(state.phases[index], rate=None)
        sliding = self._strokes(index, state.strokes)
        WearStep.begin(state, index, sliding)
        iterations = solve_stroke(state, index, self.scene.program.cycle[index], sliding, plan=plan)
        return self._report(state, index, iterations, sliding)

    def _step(self, state: State, cycles: int) -> float:
        """Solve each stroke of the cycle with its wear; return the relative error of worn area (nan: unknown).

        It is infinite if an element would be torn, or a run that ends at blow-by would end, too late within a jump.
        """
        cycle, memory = self.scene.program.cycle, state.memory
        plan = planned(len(cycle), state.strokes, cycles, self.scene.program.strokes)
        state.reports = []
        worn_before, error_before, known = state.ledger.worn, state.ledger.area_error, True
        begin = state.strokes
        for k, (i, repeats) in enumerate(plan):
            sliding = self._strokes(i, begin + k, repeats)
            later = {j: self._strokes(j, begin + k + 1 + m, n - 1) for m, (j, n) in enumerate(plan[k + 1 :])}
            outline, iterations, tears = state.contour, 0, True
            while tears:
                wear_step = WearStep.begin(state, i, sliding, later=later)
                iterations += solve_stroke(state, i, cycle[i], sliding, plan=plan)
                tears = self._lost_elements is not None and self._lost_elements.tear(state, outline, repeats)
                if tears and repeats > max(1.0, LATE * self.scene.program.strokes / len(cycle)):
                    return math.inf
                if tears:
                    outline, state.ledger.late = state.contour, max(state.ledger.late, repeats - 1)
            if memory is not None and state.stage.memory is not None:
                memory.record(state.stage.memory, i)
            seen = self._report(state, i, iterations, sliding)
            state.strokes += repeats
            if self._lost_elements is not None:
                self._lost_elements.add_fatigue(state, repeats, last=k == len(plan) - 1)
            known &= wear_step.apply()
            state.reports.append(
                replace(
                    seen,
                    last_stroke=state.strokes,
                    repeats=repeats,
                    contour=state.contour,
                    counters=state.counters,
                    ledger=state.ledger.copy(),
                    cells=state.cells,
                )
            )
        if cycles > 1 and self.blown(state) is not None:
            return math.inf  # it begins in one of these strokes: shorter steps find it
        if memory is not None:
            memory.commit(plan)
        if state.strokes < self.scene.program.strokes and is_due(state):
            remesh(state)
        worn = state.ledger.worn - worn_before
        if not known:
            return math.nan
        return (state.ledger.area_error - error_before) / worn if worn > 0 else 0.0

    def _strokes(self, kind: int, done: int, repeats: int = 0) -> Strokes:
        """Sliding of ``repeats`` strokes of a kind; the first begins after ``done`` strokes of all kinds."""
        program = self.scene.program
        return Strokes(program.slid(done), program.cycle[kind].travel, program.slid(len(program.cycle)), repeats)

    def _report(self, state: State, index: int, iterations: int, sliding: Strokes) -> StrokeReport:
        """Report of the stroke's equilibrium, before its wear."""
        loaded = {} if self._lost_elements is None else self._lost_elements.loaded(state.stage)
        return stroke_report(self.scene, state, index, sliding, iterations=iterations, loaded=loaded)
