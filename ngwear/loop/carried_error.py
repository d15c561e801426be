"""How an error of the worn depth goes on: where a part is worn too much, its contacts wear less."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray

from ngwear.equilibrium.linear import RESIDUAL_TOLERANCE
from ngwear.loop.stage import Stage

Array = NDArray[np.float64]


@contextmanager
def with_more_worn(stage: Stage, depth: Mapping[str, Array], more: Array) -> Iterator[bool]:
    """Within it, the part is in the equilibrium that it has with ``more`` depth worn; True if one is found.

    False without a tangent, or with one that is singular. To first order: one correction of Newton's method by the
    tangent of the last solve. ``depth`` has the depths that contacts have worn before the solve, by name, and ``more``
    is of shape (n,), both at the points of the outline [mm].
    """
    problem, solver = stage.problem, stage.problem.solver
    vector = problem.state.vec
    kept, residual, correction = (vector.CreateVector() for _ in range(3))
    kept.data = vector
    for name, known in depth.items():
        stage.contacts[name].set_worn(known + more)
    try:
        found = False
        if solver is not None:
            with problem.threads():
                problem.residual(residual)
                found = solver.solve(residual, correction) < RESIDUAL_TOLERANCE
        if found:
            vector.data -= correction
        yield found
    finally:
        vector.data = kept
        for name, known in depth.items():
            stage.contacts[name].set_worn(known)
