"""Write contour.toml: a wiper for a rod of 20 mm, whose lip points outwards and whose back lies in a groove.

python geometries/wiper/make_contour.py
"""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "rectangular_ring"))

from make_contour import rounded, write  # noqa: E402

ROD = 10.0  # radius [mm]
CORNERS = [  # x, y over the rod, radius [mm], edge that begins there; the outside is at the left
    (0.50, -0.30, 0.15, "lip"),
    (3.20, 0.35, 0.80, "heel"),
    (6.00, 0.35, 0.30, "base"),
    (6.00, 4.20, 0.30, "back"),
    (0.30, 4.20, 0.30, "shoulder"),
    (0.30, 2.90, 0.20, "throat"),
    (2.60, 2.80, 0.40, "throat"),
    (2.60, 1.85, 0.40, "throat"),
    (0.70, 0.85, 0.20, "scraper"),
]


def main() -> None:
    """Write the outline beside this file."""
    edges = rounded([(x, ROD + y, radius, name) for x, y, radius, name in CORNERS])
    write(HERE, "Wiper for a rod of 20 mm", edges)


if __name__ == "__main__":
    main()
