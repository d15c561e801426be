"""The case ``fretting`` with half-planes in place of elements: Flamant's influence, cells of constant pressure.

Both ways are resolved at Gauss points, wear is implicit at each; contact by an active set.

    python tests/benchmarks/fretting_half_plane.py [DRAG_IN_MICROMETRES]        (0.75: 40 s)
"""

import sys

import numpy as np

from ngwear.verify.fretting import DEPTHS, LOAD, MOTION, PAIR_MODULUS, RADIUS
from ngwear.wear.jump_control import JumpControl

CELL, REACH = 0.002, 0.25
PLACES, WEAR_ERROR = 6, 0.01


def influence(n):
    """Displacement of each cell's middle by a pressure of 1 MPa on each cell [mm/MPa], but for a constant."""
    ends = (np.arange(n) + 0.5) * CELL
    wave = ends * np.log(ends) - ends
    row = -2 / (np.pi * PAIR_MODULUS) * np.diff(wave, prepend=-wave[0])
    return row[np.abs(np.subtract.outer(np.arange(n), np.arange(n)))]


def press(gap, compliance, give, on):
    """Pressures under the load that close the gap, and where; ``give`` is the wear's compliance [mm/MPa]."""
    while True:
        cells = np.flatnonzero(on)
        matrix = np.full((len(cells) + 1, len(cells) + 1), -1.0)
        matrix[:-1, :-1] = compliance[np.ix_(cells, cells)] + give * np.eye(len(cells))
        matrix[-1] = np.append(np.full(len(cells), CELL), 0.0)
        solution = np.linalg.solve(matrix, np.append(-gap[cells], LOAD))
        pressure = np.zeros(len(gap))
        pressure[cells] = solution[:-1]
        apart = gap + compliance[:, cells] @ solution[:-1] - solution[-1]
        new = np.where(on, pressure > 0, apart < 0)
        if (new == on).all():
            return pressure, on
        on = new


def main(drag=0.75e-3):
    n = 2 * round(REACH / CELL) + 1
    x, compliance = (np.arange(n) - n // 2) * CELL, influence(n)
    flat, cylinder = np.zeros(n), np.zeros(n)
    path, (z, weight) = MOTION.amplitude - drag, np.polynomial.legendre.leggauss(PLACES)
    places, weights = path * np.append(z, z[::-1]), np.append(weight, weight[::-1])
    k1, k2 = MOTION.wear_rate, MOTION.counter_wear_rate
    on, before = [np.abs(x - s) < 0.04 for s in places], [None] * len(places)
    control, done, solves = JumpControl(WEAR_ERROR, cycles=1, longest=10**6), 0, 0
    while done < max(DEPTHS):
        jump = min(control.cycles, min(mark for mark in DEPTHS if mark > done) - done)
        error = 0.0
        for i, (s, w) in enumerate(zip(places, weights, strict=True)):
            slip = path * w * jump
            gap = (x - s) ** 2 / (2 * RADIUS) + flat + np.interp(x - s, x, cylinder)
            p, on[i] = press(gap, compliance, (k1 + k2) * slip, on[i])
            solves += 1
            flat += k1 * slip * p
            moved = np.interp(x + s, x, p)
            cylinder += k2 * slip * moved * p.sum() / moved.sum()
            error += np.nan if before[i] is None else slip * np.abs(p - before[i]).sum() * CELL / 2
            before[i] = p
        control.update(error / (4 * path * jump * LOAD), jump)
        done += jump
        if done in DEPTHS:
            deep = f"flat {flat.max() * 1e3:.4f}, cylinder {cylinder.max() * 1e3:.4f} µm"
            print(f"{done} cycles, {solves} solves: {deep}")  # noqa: T201


if __name__ == "__main__":
    main(*(float(argument) * 1e-3 for argument in sys.argv[1:]))
