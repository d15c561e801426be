"""The case ``partial_slip_wear`` with a half-plane for elements: Flamant's influence, cells of constant pressure.

Two frictionless contacts a step: under P, and under P* = P - D / (2 mu) for a friction that changes by D from stroke to
stroke. A stroke slips 2 mu times the gap that opens from the one to the other; wear is implicit.

    python tests/benchmarks/partial_slip_half_plane.py [CELL_IN_MM [D_OVER_2_MU_P]]        (0.005, 0.638: 3 s)
"""

import sys

import numpy as np

from ngwear.verify.partial_slip_wear import (
    HALF_WIDTH,
    LATE,
    LOAD,
    MATERIAL,
    MU,
    ON_THE_WAY,
    PEAK,
    RADIUS,
    SHARE,
    WEAR_RATE,
)

REACH, GROWTH, FIRST = 1.5, 0.05, 20.0


def influence(n, cell):
    """Displacement of each cell's middle by a pressure of 1 MPa on each cell [mm/MPa], but for a constant."""
    ends = (np.arange(n) + 0.5) * cell
    wave = ends * np.log(ends) - ends
    row = -2 / (np.pi * MATERIAL.plane_strain_modulus) * np.diff(wave, prepend=-wave[0])
    return row[np.abs(np.subtract.outer(np.arange(n), np.arange(n)))]


def press(gap, compliance, load, cell, on, give=None):
    """Pressures under a load, which cells carry them, and the gaps; ``give`` is the wear's compliance [mm/MPa]."""
    give = np.zeros(len(gap)) if give is None else give
    for _ in range(100):
        cells = np.flatnonzero(on)
        matrix = np.full((len(cells) + 1, len(cells) + 1), -1.0)
        matrix[:-1, :-1] = compliance[np.ix_(cells, cells)] + np.diag(give[cells])
        matrix[-1] = np.append(np.full(len(cells), cell), 0.0)
        solution = np.linalg.solve(matrix, np.append(-gap[cells], load))
        pressure = np.zeros(len(gap))
        pressure[cells] = solution[:-1]
        apart = gap + compliance[:, cells] @ solution[:-1] - solution[-1]
        new = np.where(on, pressure > -1e-9 * PEAK, apart < -1e-12)
        if (new == on).all():
            return pressure, on, apart
        on = new
    raise RuntimeError("the active set does not settle: take another cell")


def main(cell=0.005, share=SHARE):
    n = 2 * round(REACH / cell) + 1
    x, compliance = (np.arange(n) - n // 2) * cell, influence(n, cell)
    worn, touching, sticking = np.zeros(n), np.abs(x) < HALF_WIDTH, np.abs(x) < 0.5 * HALF_WIDTH
    done, marks = 0.0, [ON_THE_WAY, LATE, 4 * LATE]
    while marks:
        jump = min(max(FIRST, GROWTH * done), marks[0] - done)
        gap = x**2 / (2 * RADIUS) + worn
        _, sticking, opened = press(gap, compliance, LOAD * (1 - share), cell, sticking)
        _, touching, closed = press(gap, compliance, LOAD, cell, touching)
        slip = np.where(sticking, 0.0, 2 * MU * np.maximum(opened - np.where(touching, 0.0, closed), 0.0))
        pressure, touching, _ = press(gap, compliance, LOAD, cell, touching, WEAR_RATE * jump * slip)
        worn += WEAR_RATE * jump * slip * pressure
        done += jump
        if done == marks[0]:
            marks.pop(0)
            c = sticking.sum() * cell / 2
            told = (
                f"p(0) / p0 {pressure[n // 2] / PEAK:.4f}, area {worn.sum() * cell:.4e} mm², deepest {worn.max():.3e}"
            )
            print(f"{done:.0f} strokes: c {c:.4f}, {told} mm")  # noqa: T201


if __name__ == "__main__":
    main(*(float(argument) for argument in sys.argv[1:]))
