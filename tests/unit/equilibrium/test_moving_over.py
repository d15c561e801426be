"""Load steps of a part that moves over to another equilibrium: all loads act at once there."""

import pytest
from test_rounded_laws import MODULUS, solved

from ngwear.equilibrium import newton, stepping
from ngwear.equilibrium.newton import NewtonOptions, Outcome, Report, iterate
from ngwear.equilibrium.stepping import SHORT, StepOptions, advance
from ngwear.errors import ConvergenceError

LOAD = "fluid pressure [MPa]"


def walk(stage, monkeypatch, fails, **options):
    """Fractions reached on the way to twice the pressure; ``fails(share, moves)`` says which solves do not converge."""
    problem, tried, reached = stage.problem, [], []
    stage.begin(problem.state.vec.FV().NumPy().copy())
    first = problem.get_loads()[LOAD]
    solve = stepping.solve

    def tells(problem, options):
        share = problem.get_loads()[LOAD] / first - 1
        tried.append((share, options.moves))
        return Report(Outcome.STALLED) if fails(share, options.moves) else solve(problem, options)

    monkeypatch.setattr(stepping, "solve", tells)
    advance(problem, {LOAD: 2 * first}, StepOptions(**options), on_step=lambda share, report: reached.append(share))
    return tried, reached


def before_a_shorter_step():
    """All solves fail until a step shorter than ``SHORT`` is tried."""
    shares = []
    return lambda share, moves: shares.append(share) or min(shares) > 0.7 * SHORT


def test_after_a_short_step_that_fails_all_loads_act_and_the_part_may_move_over(monkeypatch):
    tried, reached = walk(solved(), monkeypatch, lambda share, moves: not moves)
    assert reached == [1.0]
    assert [share for share, moves in tried if not moves] == pytest.approx([1.0, 0.5, 0.25, SHORT])


def test_a_part_that_finds_none_there_goes_on_in_shorter_steps(monkeypatch):
    tried, reached = walk(solved(), monkeypatch, before_a_shorter_step())
    assert sum(moves for _, moves in tried) == 1
    assert reached[0] == pytest.approx(SHORT / 2)
    assert reached[-1] == 1.0


def test_a_part_that_rolls_over_under_all_loads_may_still_reach_them_in_steps(monkeypatch):
    stage, solve = solved(), stepping.solve
    monkeypatch.setattr(stepping, "solve", lambda p, o: Report(Outcome.ROLLED) if o.moves else solve(p, o))
    fails = before_a_shorter_step()
    tried, reached = walk(stage, monkeypatch, lambda share, moves: fails(share, moves) and not moves)
    assert sum(moves for _, moves in tried) == 1
    assert reached[-1] == 1.0


def test_it_is_not_tried_in_shorter_steps_if_it_has_rolled_and_none_are_asked_for(monkeypatch):
    stage, solve, tried = solved(), stepping.solve, []
    monkeypatch.setattr(stepping, "solve", lambda p, o: Report(Outcome.ROLLED) if o.moves else solve(p, o))
    with pytest.raises(ConvergenceError) as caught:
        walk(stage, monkeypatch, lambda share, moves: tried.append(share) or not moves, shorter=False)
    assert caught.value.report.outcome is Outcome.ROLLED
    assert tried == pytest.approx([1.0, 0.5, 0.25, SHORT, 1.0])


def test_a_held_part_does_not_move_over(monkeypatch):
    monkeypatch.setattr(stepping, "has_room", lambda problem: False)
    stage, largest = solved(), []
    with pytest.raises(ConvergenceError):
        walk(stage, monkeypatch, lambda share, moves: largest.append((share, moves)) or True)
    assert all(not moves for share, moves in largest if share > 2 * StepOptions.smallest)


def test_a_damped_correction_begins_near_the_share_taken_of_the_last_one(monkeypatch):
    problem, begun = solved().problem, []
    damped = newton._damped

    def tells(problem, solver, correction, start, step, residual):
        begun.append(step)
        return 1 / 32 if len(begun) == 1 else damped(problem, solver, correction, start, step, residual)

    monkeypatch.setattr(newton, "_damped", tells)
    problem.set_loads({LOAD: 0.5 * MODULUS})
    assert iterate(problem, NewtonOptions(damped=True)).converged
    assert begun[:2] == [1.0, newton.LONGER / 32]
