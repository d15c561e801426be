"""Write contour.toml: an O-ring of 19.6 x 3.53 mm, a circle of 160 points in four named quarters.

python geometries/o_ring/make_contour.py
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

CORD, BORE, POINTS = 3.53, 19.6, 160  # mm, mm
QUARTERS = ("rod side", "sealed side", "groove side", "air side")  # counter-clockwise from the lower left


def main() -> None:
    """Write the outline beside this file."""
    turn = np.linspace(-3 * math.pi / 4, 5 * math.pi / 4, POINTS, endpoint=False)
    x, y = CORD / 2 * np.cos(turn), BORE / 2 + CORD / 2 + CORD / 2 * np.sin(turn)
    lines = [f'title = "O-ring {BORE} x {CORD}"', 'provenance = "a circle of the standard size"']
    for k, name in enumerate(QUARTERS):
        span = slice(k * POINTS // 4, (k + 1) * POINTS // 4)
        rows = ", ".join(f"[{a:.5f}, {b:.5f}]" for a, b in zip(x[span], y[span], strict=True))
        lines.append(f'[[edge]]\nname = "{name}"\ncorner = false\npoints = [{rows}]')
    Path(__file__).with_name("contour.toml").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
