"""Write contour.toml: the section of the shipped rod seal, straightened, its lip's tip at y = 0.

Nothing here is measured: see ../rod_seal/make_contour.py, whose points these are, 10.2 mm lower, with the lip's tip and
the ridges blunted so that elements of 0.025 mm resolve the stress beside their contacts. The face that may wear ends
where the heel and the sealed face turn away from the rod.

    python geometries/torn_seal/make_contour.py
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "rod_seal"))

from make_contour import CORNER, TIP, edges, write  # noqa: E402

BLUNTING, TIP_RADIUS = 0.05, 0.1  # roots nearer to the tips of the ridges, and the lip's radius [mm]
HEEL_FROM, FACE_TO = 0.20, 4.42  # where the face that may wear begins and ends [mm]


def straightened() -> list[tuple[str, np.ndarray]]:
    """Named edges of the section, counter-clockwise from the foot of the back face."""
    out = []
    for name, points in edges(blunting=BLUNTING, tip_radius=TIP_RADIUS):
        here = points - (0.0, TIP[1])
        if name == "heel":
            k = int(np.searchsorted(here[:, 0], HEEL_FROM))
            out += [("heel round", here[: k + 1]), ("heel", here[k:])]
        elif name == "sealed face":
            k = int(np.searchsorted(here[:, 0], FACE_TO))
            out += [("sealed face", here[: k + 1]), ("sealed heel", here[k:])]
        else:
            out.append((name, here))
    return out


if __name__ == "__main__":
    head = [
        'title = "Section of the invented rod seal, straightened and blunted; 5 x 4 mm"',
        'provenance = "invented after the description in 10.5772/50498; not measured; made by make_contour.py"',
        'coordinates = ["x [mm]", "y [mm]"]',
    ]
    write(HERE / "contour.toml", straightened(), (CORNER - {"heel"}) | {"heel round"}, head)
