"""One equilibrium: by Newton's method, by another way into contact if that fails, and by rounded laws at last."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT, Array
from ngwear.effects.edge_pressure import EdgePressure
from ngwear.equilibrium.newton import NewtonOptions, Outcome, Report, iterate
from ngwear.equilibrium.problem import IMBALANCE, Problem

ATTEMPTS = 2  # before the laws are rounded off: what the terms change in the second one, ``Term.attempt`` says
MORE_MAY_HELP = (Outcome.TOO_MANY_ITERATIONS, Outcome.FOLDED, Outcome.STALLED)
# The rest changes the way and its time only. Settled on sections of ``tests/stability/foreign.py`` that failed or took
# long before: seed 0, indices 3, 6, 11, 13 and 15; seed 30, indices 11, 12, 18 and 26.
ROUNDED = (0.1, 1.0)  # of G: the first one that converges is the start
SHARPER = 0.2  # times the rounding before; the root of it after a failure
SHARP = 1e-4  # of G: from here to the corner itself
# Strength of springs that hold the part back, in G / L: the first one as stiff as the part.
FIRST, LOOSE = 1.0, 2e-4
WEAKER, FAR = 4.0, 0.1  # factor between two steps; motion of a step, over the section's size, that is aimed at
ABOVE, GROWS = 2.0, 1.2  # times a strength that failed: the least one; by what that falls in the next step, then faster
STIFFEST = 2000.0  # times the first ones: a part that such springs do not hold back enough does not move on
STANDS, NEARLY_LOOSE = 1e-3, 1e-2  # a motion over the section's size and a strength: an equilibrium is near
# Of G / L, and of G: springs that hold the outline while the section beneath finds its stresses, and the rounding
# meanwhile. With more of it a part that friction holds creeps: a lip by a quarter of its section, with 0.1.
FIRM, SLIGHTLY = 1e4, 0.02
# Times the weakest springs that held so far: where much stronger ones are needed than those, a way from firm ones leads
# nowhere. Ways to an equilibrium needed up to 7 times as strong ones; those from the first springs more than 700.
RISES = 64.0
QUARTER = 90.0  # degrees: from there on a ring resists turning with a moment that falls
FAILURES, MOST = 4, 400  # failures in a row, and iterations, until it ends


def solve(problem: Problem, options: NewtonOptions | None = None) -> Report:
    """Bring the problem's state to equilibrium under its present loads.

    On failure the state is put back to where it was. A solve that does not converge is tried once more in another way
    (``Term.attempt``), then with the corners of the laws rounded off, if terms can do that (``Term.round_off``).
    """
    options = options or NewtonOptions()
    for term in problem.terms:
        term.prepare()
    start = problem.state.vec.CreateVector()
    start.data = problem.state.vec
    wasted = 0
    with problem.threads():
        for attempt in range(ATTEMPTS):
            if not any([term.attempt(attempt) for term in problem.terms]) and attempt > 0:
                break
            report = iterate(problem, options)
            report.iterations += wasted
            wasted = report.iterations
            if report.converged:
                return report
            problem.state.vec.data = start
            if report.outcome not in MORE_MAY_HELP:
                return report
        if not options.rounds or not _round_off(problem, 0.0):
            return report
        for term in problem.terms:
            term.attempt(0)
        fluid = _fluid(problem)
        rounded = _by_rounded_laws(problem, replace(options, damped=True))
    if rounded.converged:
        rounded.iterations += wasted
        rounded.rounded = True
        return rounded
    report.iterations += rounded.iterations
    report.outcome = rounded.outcome if rounded.outcome is Outcome.ROLLED else report.outcome
    problem.state.vec.data = start
    _put_back(fluid)
    return report


def _fluid(problem: Problem) -> list[tuple[EdgePressure, Array]]:
    """Where the fluids of a problem act: each term, and its values on the mesh edges."""
    return [(term, term.on_edges) for term in problem.terms if isinstance(term, EdgePressure)]


def _put_back(fluid: list[tuple[EdgePressure, Array]]) -> None:
    for term, values in fluid:
        term.on_edges = values


def _round_off(problem: Problem, relative: float) -> bool:
    return any([term.round_off(relative) for term in problem.terms])


def _by_rounded_laws(problem: Problem, options: NewtonOptions) -> Report:
    """Round the laws off until a solve converges, then less and less, down to the corners; all corners are back then.

    Where that leads to no neighbouring equilibrium, the part moves on to another one (``_move_over``).
    """
    total, rounding, sharper = 0, math.inf, SHARPER
    good = problem.state.vec.CreateVector()
    good.data = problem.state.vec
    firsts = list(ROUNDED)
    goal = firsts.pop(0)
    try:
        while True:
            _round_off(problem, goal)
            report = iterate(problem, options)
            total += report.iterations
            if not report.converged:
                problem.state.vec.data = good
                if rounding == math.inf and firsts:
                    goal = firsts.pop(0)
                    continue
                if rounding < math.inf and sharper == SHARPER and goal > 0:
                    sharper = math.sqrt(SHARPER)
                    goal = rounding * sharper
                    continue
                goal = goal if rounding < math.inf else ROUNDED[0]
                _round_off(problem, goal)
                if options.moves and IMBALANCE not in problem.parameters:  # else a shorter step takes less time
                    report = _move_over(problem, options)
                    total += report.iterations
                sharper = SHARPER
            if not report.converged or goal == 0.0:
                report.iterations = total
                return report
            good.data = problem.state.vec
            rounding = goal
            goal = goal * sharper if goal > SHARP else 0.0
    finally:
        _round_off(problem, 0.0)


def _move_over(problem: Problem, options: NewtonOptions, *, first: float = FIRST, rises: float = math.inf) -> Report:
    """Follow the part through states out of equilibrium to the next equilibrium.

    Each step holds it back by springs from its state before, weaker ones while that is easy, none in the end; the first
    ones have the strength ``first`` (pseudo-transient continuation: Kelley & Keyes, *SIAM J. Numer. Anal.* 35 (1998)
    508). The fluid goes along after each step: where it stayed until the part has moved, it would act on a place that
    the part has left, and push it back. It ends where springs are needed that are ``rises`` times as strong as the
    weakest ones that have held it.
    """
    place = problem.part(DISPLACEMENT)
    before = problem.state.vec.CreateVector()
    strength, bound, total, failures, eased = first, 0.0, 0, 0, 0
    weakest = math.inf
    report = Report(Outcome.STALLED)
    try:
        while failures <= FAILURES and total <= MOST and strength <= min(STIFFEST * first, rises * weakest):
            before.data = problem.state.vec
            _hold_back(problem, strength)
            report = iterate(problem, options)
            total += report.iterations
            if not report.converged:
                problem.state.vec.data = before
                failures, eased = failures + 1, 0
                bound = ABOVE * strength
                strength = WEAKER * max(strength, LOOSE)
                continue
            if strength == 0.0:
                break
            if abs(problem.turned()) > QUARTER:
                report.outcome = Outcome.ROLLED
                break
            failures, eased, weakest = 0, eased + 1, min(weakest, strength)
            moved = _largest(problem.state.vec, before, place) / problem.body.size
            for term in problem.terms:
                term.refresh()
            bound = bound / GROWS**eased if moved > STANDS else 0.0
            if strength < LOOSE or (strength < NEARLY_LOOSE and moved < STANDS):
                strength = 0.0
            else:
                strength = max(strength / max(1.0, FAR / max(moved, FAR / WEAKER)), bound)
    finally:
        _hold_back(problem, 0.0)
    report.iterations = total
    if strength > 0.0 and report.converged:
        report.outcome = Outcome.TOO_MANY_ITERATIONS
    return report


def let_go(problem: Problem) -> list[Report]:
    """Bring the present state to equilibrium: springs hold the outline at where it was, weaker ones each time.

    For a state carried over to a new mesh. The corners of the laws are slightly rounded off meanwhile, so that contact
    does not alternate there, and sharp in the end. Only a part with room to move has such springs. If they fail, the
    state is the present one; if the sharp laws fail, that of the rounded ones. The last report is then a failure's.
    """
    for term in problem.terms:
        term.prepare()
        term.attempt(0)
    with problem.threads():
        reports = [_or_back(problem, _sharply)]
        if not reports[-1].converged:
            reports.append(_or_back(problem, _held_firmly))
            if reports[-1].converged:
                reports.append(_or_back(problem, _sharply))
    return reports


def _or_back(problem: Problem, way: Callable[[Problem], Report]) -> Report:
    """Solve in this way; after a failure the state is put back."""
    before = problem.state.vec.CreateVector()
    before.data = problem.state.vec
    fluid = _fluid(problem)
    report = way(problem)
    if not report.converged:
        problem.state.vec.data = before
        _put_back(fluid)
    return report


def _sharply(problem: Problem) -> Report:
    return iterate(problem, NewtonOptions())


def _held_firmly(problem: Problem) -> Report:
    try:
        _round_off(problem, SLIGHTLY)
        return _move_over(problem, NewtonOptions(damped=True), first=FIRM, rises=RISES)
    finally:
        _round_off(problem, 0.0)


def _hold_back(problem: Problem, strength: float) -> None:
    for term in problem.terms:
        term.hold_back(strength)


def _largest(one: ng.BaseVector, other: ng.BaseVector, place: slice) -> float:
    """Largest difference of two states' displacements [mm]."""
    return float(np.abs(one.FV().NumPy()[place] - other.FV().NumPy()[place]).max())
