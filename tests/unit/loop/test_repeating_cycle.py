"""A part that sticks and has room to move wears from the cycle that repeats itself."""

from dataclasses import replace

import pytest

from ngwear.errors import ConvergenceError
from ngwear.loop import repeating_cycle, stepper, stroke_solve
from ngwear.loop.repeating_cycle import CYCLE_STEPS, REPEATS, largest_change
from ngwear.loop.stepper import Stepper
from ngwear.loop.stroke_solve import MOVING, pass_stroke


@pytest.fixture(scope="module")
def sticking(ring):
    """The O-ring with friction at which it sticks to the groove, for twenty cycles."""
    contacts = [replace(spec, friction=0.1 if spec.slides else 0.4) for spec in ring.contacts]
    return replace(ring, contacts=contacts, program=replace(ring.program, strokes=40))


def cycles_change(scene):
    """Change of the forces over three further cycles after the start [-], and the start's state."""
    walker = Stepper(scene)
    state = walker.start()
    before = [report.forces for report in state.reports]
    for _ in range(3):
        after = []
        for i, stroke in enumerate(scene.program.cycle):
            pass_stroke(state, i, stroke, walker._strokes(i, 0), steps=CYCLE_STEPS)
            after.append(state.stage.forces())
    return largest_change(before, after), state


def test_the_first_worn_cycle_repeats_itself(sticking, monkeypatch):
    change, _ = cycles_change(sticking)
    assert change <= 2 * REPEATS
    monkeypatch.setattr(repeating_cycle, "MOST_CYCLES", 0)
    first, _ = cycles_change(sticking)
    assert first > 2 * REPEATS


def test_a_program_of_one_cycle_is_not_repeated(sticking, monkeypatch):
    once = replace(sticking, program=replace(sticking.program, strokes=2))
    passes = []
    monkeypatch.setattr(stepper, "pass_stroke", lambda *args, **kwargs: passes.append(args))
    Stepper(once).start()
    assert not passes


def test_a_cycle_that_fails_leaves_the_one_before(sticking, monkeypatch):
    def fails(*args, **kwargs):
        raise ConvergenceError("stopped")

    monkeypatch.setattr(stepper, "pass_stroke", fails)
    state = Stepper(sticking).start()
    assert len(state.reports) == len(sticking.program.cycle)
    assert state.strokes == 0
    (told,) = [found for found in state.reports[-1].findings if found.key == "creep"]
    assert "no equilibrium was found in its second cycle" in told.sentence


def test_a_stroke_that_snaps_is_passed_in_shorter_load_steps(sticking, monkeypatch):
    """As in the cycle in which the part was mounted; if they fail, too, so does the stroke."""
    walker = Stepper(sticking)
    state = walker.start()
    tried, advance = [], stroke_solve.advance

    def snaps(problem, target, options, **kwargs):
        tried.append(options)
        if not options.leaps or len(tried) > 2:
            raise ConvergenceError("snaps")
        return advance(problem, target, options, **kwargs)

    monkeypatch.setattr(stroke_solve, "advance", snaps)
    stroke, before = sticking.program.cycle[1], state.stage.forces()
    state.phases[1].path = []
    pass_stroke(state, 1, stroke, walker._strokes(1, 0), steps=CYCLE_STEPS)
    assert [options.first for options in tried] == [1 / CYCLE_STEPS, MOVING]
    assert largest_change([before], [state.stage.forces()]) <= 2 * REPEATS
    assert state.phases[1].path
    state.phases[1].path = []
    with pytest.raises(ConvergenceError, match="snaps"):
        pass_stroke(state, 1, stroke, walker._strokes(1, 0), steps=CYCLE_STEPS)


def test_the_change_is_that_of_the_forces_over_the_largest():
    before = [{"rod": [1.0, -4.0]}, {"rod": [0.0, 2.0]}]
    after = [{"rod": [1.2, -4.0]}, {"rod": [0.0, 2.0]}]
    assert largest_change(before, after) == pytest.approx(0.05)
    assert largest_change([{"rod": [0.0, 0.0]}], [{"rod": [0.0, 0.0]}]) == 0.0


def test_a_part_that_still_creeps_is_told(sticking, monkeypatch):
    monkeypatch.setattr(stepper, "repeat_cycle", lambda *args: 2 * REPEATS)
    (told,) = [found for found in Stepper(sticking).start().reports[-1].findings if found.key == "creep"]
    assert told.amount == 2 * REPEATS
    assert "forces change by 4 % of the largest from one cycle to the next" in told.sentence
    monkeypatch.setattr(stepper, "repeat_cycle", lambda *args: REPEATS)
    assert not any(found.key == "creep" for found in Stepper(sticking).start().reports[-1].findings)
