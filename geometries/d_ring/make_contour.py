"""Write contour.toml: a D-ring of 43.4 x 3.4 x 3.45 mm, flat on the groove's bottom and round to the bore.

python geometries/d_ring/make_contour.py
"""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "rectangular_ring"))

from make_contour import rounded, write  # noqa: E402

BORE, WIDTH, HEIGHT = 43.4, 3.4, 3.45  # mm
ROUND, CROWN = 0.3, 1.65  # radii of the corners at the groove's bottom, and of the two that make the crown [mm]


def main() -> None:
    """Write the outline beside this file."""
    half, inner, outer = WIDTH / 2, BORE / 2, BORE / 2 + HEIGHT
    corners = [
        (-half, inner, ROUND, "groove side"),
        (half, inner, ROUND, "sealed side"),
        (half, outer, CROWN, "bore side"),
        (-half, outer, CROWN, "bore side"),
        (-half, (inner + outer) / 2 - 0.2, 0.0, "air side"),
    ]
    write(HERE, f"D-ring {BORE} x {WIDTH} x {HEIGHT}", rounded(corners))


if __name__ == "__main__":
    main()
