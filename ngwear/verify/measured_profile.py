"""A profile that is made up from a closed form, disturbed as an instrument would, and compared with a run.

The run: a cylinder wears into a block with k = 1e-3 mm²/N (``ngwear.verify.worn_cylinder``, on a coarser mesh). The
profile: that of a part with 1.6 times this rate, once its flat is 2 a = 2.4 mm wide, from the late-time closed form
depth ``max(0, (a² - x²) / (2 R))``, area ``2 a³ / (3 R)``, ``a³ = a_H³ + 1.5 k R P' s``, which gives its sliding
distance. It is scanned over 6 mm, tilted by 0.5 degrees, shifted by 0.2 mm, with normal noise of 1 µm. Wanted back: the
rate, the area, shift and tilt.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import numpy as np

from ngwear.loop.run import run as run_scene
from ngwear.materials import NeoHooke
from ngwear.profiles.comparison import compare_profile
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.wear_runs import CylinderOnBlock

RUBBER = NeoHooke.from_young(1.0, 0.4995)
RADIUS, HERTZ, WEAR_RATE, TRAVEL = 20.0, 0.05, 1e-3, 2000.0
LOAD = math.pi * RUBBER.plane_strain_modulus * HERTZ**2 / (4 * RADIUS)
BLOCK = CylinderOnBlock(
    material=RUBBER, radius=RADIUS, load=LOAD, wear_rate=WEAR_RATE, size=6.0, patch=0.05, travel=TRAVEL, wear_error=0.1
)
FACTOR, HALF_WIDTH, LAST = 1.6, 1.2, 1.4  # of the part's rate over the run's; of the part's flat; of the run's last
SCAN, POINTS, NOISE, TILT, SHIFT = 6.0, 2000, 1e-3, 0.5, 0.2


def sliding(half_width: float, wear_rate: float) -> float:
    """Sliding distance after which the flat is so wide [mm]."""
    return (half_width**3 - HERTZ**3) / (1.5 * wear_rate * RADIUS * LOAD)


def write_profile(path: Path) -> float:
    """Write the disturbed profile; return its worn area before it was disturbed [mm²]."""
    noise = np.random.default_rng(0)
    x = np.linspace(-SCAN / 2, SCAN / 2, POINTS)
    depth = np.maximum(0.0, (HALF_WIDTH**2 - x**2) / (2 * RADIUS))
    z = noise.normal(-depth, NOISE)
    c, s = math.cos(math.radians(TILT)), math.sin(math.radians(TILT))
    table = np.column_stack([c * x - s * z + SHIFT, 1e3 * (s * x + c * z)])
    np.savetxt(path, table, delimiter=",", header="x [mm],z [µm]", comments="", encoding="utf-8")
    return 2 * HALF_WIDTH**3 / (3 * RADIUS)


def run() -> list[Check]:
    """Rate, area, shift and tilt."""
    clock = Stopwatch()
    with tempfile.TemporaryDirectory() as folder:
        out, path = Path(folder) / "out", Path(folder) / "profile.csv"
        strokes = round(sliding(LAST, WEAR_RATE) / TRAVEL)
        run_scene(BLOCK.scene("worn cylinder", (strokes,)), out=out, figures=False)
        area = write_profile(path)
        found = compare_profile(out, path, distance=sliding(HALF_WIDTH, FACTOR * WEAR_RATE)).as_dict()
    rate = found["ring specific wear rate [mm^2/N]"]
    return [
        Check("measured_profile", quantity, value, reference, tolerance, clock.seconds, absolute=absolute)
        for quantity, value, reference, tolerance, absolute in (
            ("specific wear rate [mm²/N]", rate, FACTOR * WEAR_RATE, 0.02, False),
            ("worn area of the profile [mm²]", found["worn area, measured [mm^2]"], area, 0.01, False),
            ("shift [mm]", found["shift along x [mm]"], -SHIFT, 0.01, True),
            ("tilt [degrees]", found["tilt [deg]"], -TILT, 0.01, True),
        )
    ]
