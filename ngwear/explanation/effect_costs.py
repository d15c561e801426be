"""Cost of each effect: unknowns, matrix entries, memory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ngwear.equilibrium.problem import Problem

ENTRY, ROW = 12, 8  # bytes of an entry of a sparse matrix (a double and its column) and of a row's start
MEGABYTE = 2**20


@dataclass(frozen=True)
class Costs:
    """Unknowns [-], matrix entries [-] and memory [MB] of each effect.

    An entry that couples unknowns of two effects belongs to the later one. The memory is that of the matrix and of the
    material points; the factors of the matrix need additional memory, which only a factorisation can show.
    """

    unknowns: dict[str, int]
    entries: dict[str, int]
    memory: dict[str, float]


def costs(problem: Problem, owners: Mapping[str, str]) -> Costs:
    """Count the unknowns of a problem and the entries of its tangent matrix.

    Parameters
    ----------
    problem : Problem
        The tangent is assembled at the present state.
    owners : mapping of str to str
        Effect by name of the unknown, in the order of the effects.
    """
    effects = list(dict.fromkeys(owners.values()))
    owner = np.zeros(problem.space.ndof, dtype=np.int64)
    for name in problem.names:
        owner[problem.part(name)] = effects.index(owners[name])
    _, columns, rows = (np.array(part).astype(np.int64) for part in problem.assemble().CSR())
    later = np.maximum(np.repeat(owner, np.diff(rows)), owner[columns])
    unknowns = np.bincount(owner, minlength=len(effects))
    entries = np.bincount(later, minlength=len(effects))
    memory = (ENTRY * entries + ROW * unknowns) / MEGABYTE
    if problem.points is not None:
        memory[0] += problem.points.nbytes / MEGABYTE
    return Costs(
        dict(zip(effects, unknowns.tolist(), strict=True)),
        dict(zip(effects, entries.tolist(), strict=True)),
        dict(zip(effects, memory.tolist(), strict=True)),
    )
