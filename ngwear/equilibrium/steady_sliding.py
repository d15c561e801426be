"""Steady sliding of a viscoelastic material: iteration between equilibrium and history."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ngwear.effects.steady_memory import SteadyMemory
from ngwear.equilibrium.newton import NewtonOptions
from ngwear.equilibrium.problem import Problem
from ngwear.equilibrium.stepping import StepOptions, Work, relax, settle
from ngwear.errors import ConvergenceError


@dataclass(frozen=True)
class SteadyOptions:
    """When the history counts as converged.

    Parameters
    ----------
    tolerance : float
        Largest accepted change of the history in the last round over the history, in the L2 norm [-].
    max_rounds : int
    memory : int
        Earlier rounds that Anderson's acceleration combines.
    """

    tolerance: float = 1e-4  # a tenth of what friction errs by (``verify hunter``)
    max_rounds: int = 60  # some eight do: 108 solves for the shipped pin's 14 states
    memory: int = 8  # as many as are needed, as a rule; each keeps a whole history


def solve_steady(problem: Problem, memory: SteadyMemory, options: SteadyOptions | None = None) -> Work:
    """Solve equilibrium and history in turn from the present state, accelerated (Anderson, J. ACM 12 (1965) 547).

    Raises
    ------
    ConvergenceError
        If a solve fails, or the history has not converged after ``max_rounds``.
    """
    options = options or SteadyOptions()
    work = Work()
    tried: deque[np.ndarray] = deque(maxlen=options.memory + 1)
    missed: deque[np.ndarray] = deque(maxlen=options.memory + 1)
    volumes = np.sqrt(problem.points.volumes)[..., None]
    memory.history = memory.follow(problem.points.strain(problem.state.vec.FV().NumPy()))
    for _ in range(options.max_rounds):
        report = settle(problem, StepOptions(newton=NewtonOptions(reuse=bool(tried))), work)
        if not report.converged:
            work.add(relax(problem, StepOptions(first=0.25)))
        found = memory.follow(problem.points.strain(problem.state.vec.FV().NumPy()))
        miss = found - memory.history
        error = np.linalg.norm(volumes * miss) / np.linalg.norm(volumes * found)
        if error <= options.tolerance:
            return work
        tried.append(memory.history.copy())
        missed.append(miss)
        memory.history = _accelerated(list(tried), list(missed), volumes)
    raise ConvergenceError(f"the history still changes by {error:.1e} after {options.max_rounds} rounds", report)


def _accelerated(tried: list[np.ndarray], missed: list[np.ndarray], weight: np.ndarray) -> np.ndarray:
    """Combination of the earlier rounds with the least residual, plus that residual."""
    last, miss = tried[-1], missed[-1]
    if len(tried) == 1:
        return last + miss
    steps = [b - a for a, b in pairwise(tried)]
    changes = [b - a for a, b in pairwise(missed)]
    matrix = np.stack([(weight * c).ravel() for c in changes], axis=1)
    share, *_ = np.linalg.lstsq(matrix, (weight * miss).ravel(), rcond=1e-10)
    out = last + miss
    for s, step, change in zip(share, steps, changes, strict=True):
        out -= s * (step + change)
    return out
