"""What each effect brings to a problem: unknowns, entries of the matrix, memory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ngwear.equilibrium.problem import Problem

ENTRY, ROW = 12, 8  # bytes of an entry of a sparse matrix (a double and its column) and of a row's start
MEGABYTE = 2**20


@dataclass(frozen=True)
class Costs:
    """By effect: unknowns [-], entries of the matrix [-], and memory [MB].

    An entry that couples two effects' unknowns belongs to the effect that came later. Memory is that of the matrix and
    of what is kept at material points; factors of the matrix, which need a factorisation to be known, come on top.
    """

    unknowns: dict[str, int]
    entries: dict[str, int]
    memory: dict[str, float]


def costs(problem: Problem, owners: Mapping[str, str]) -> Costs:
    """Count a problem's unknowns and its tangent's entries.

    Parameters
    ----------
    problem : Problem
        Its tangent is assembled at the present state.
    owners : mapping of str to str
        The effect of each unknown by the unknown's name; effects in the order in which they come.
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
