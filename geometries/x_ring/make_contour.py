"""Write contour.toml: an X-ring of 19.6 x 3.53 mm, four round lobes with round valleys between them.

python geometries/x_ring/make_contour.py
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

WIDTH, BORE = 3.53, 19.6  # mm: of the section, and of the ring
LOBE, VALLEY = 0.95, 0.35  # mm: radius of a lobe, and depth of a valley
LOBE_POINTS, VALLEY_POINTS = 24, 7
QUARTERS = ("rod side", "sealed side", "groove side", "air side")  # a valley and the lobe after it, counter-clockwise


def quarter() -> np.ndarray:
    """The valley below the centre of the section and the lobe to its right."""
    c, depth = (
        WIDTH / 2 - LOBE,
        WIDTH / 2 - VALLEY,
    )  # centre of the lobe at (c, -c), bottom of the valley at (0, -depth)
    root = (c**2 + (depth - c) ** 2 - LOBE**2) / (2 * (LOBE - depth + c))  # radius of the valley, tangent to the lobes
    lean = math.atan2(c, depth + root - c)
    valley = np.linspace(-lean, lean, VALLEY_POINTS + 2)[1:-1]
    lobe = np.linspace(-math.pi / 2 - lean, lean, LOBE_POINTS)
    return np.concatenate(
        [
            np.stack([root * np.sin(valley), root * np.cos(valley) - depth - root], axis=1),
            np.stack([c + LOBE * np.cos(lobe), LOBE * np.sin(lobe) - c], axis=1),
        ]
    )


def main() -> None:
    """Write the outline beside this file."""
    lines = [f'title = "X-ring {BORE} x {WIDTH}"', 'provenance = "invented, typical proportions"']
    points = quarter()
    for name in QUARTERS:
        rows = ", ".join(f"[{x:.5f}, {y + BORE / 2 + WIDTH / 2:.5f}]" for x, y in points + 0.0)
        lines.append(f'[[edge]]\nname = "{name}"\ncorner = false\npoints = [{rows}]')
        points = points @ np.array([[0.0, 1.0], [-1.0, 0.0]])  # a quarter turn
    Path(__file__).with_name("contour.toml").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
