"""The shipped pin on a plate (case C2): seven speeds against what the source describes.

Source: Békési, *Modelling Friction and Abrasive Wear of Elastomers*, 10.5772/50498. From 3 to 1036 mm/s, with a surface
friction of 0.06 whatever the speed, the friction coefficient falls slightly, penetration and contact area fall, and
the penetration differs by 0.25 mm between the slowest and the fastest. Neither rubber nor temperature is given; those
of geometries/pin_on_plate are chosen so that the loss factor is nearly flat over the speeds and the penetration
differs by that much. With one arm a decade the loss factor would undulate by 10 % about its mean, and the friction with
it: three arms a decade follow the same moduli within 5 % (``materials.smoothing``).

The errors are the differences between the two meshes of each speed, whose elements and time steps (columns) differ by
a factor 1.6, and between the friction from forces and from energy: the heat of the slip and that of the rubber.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from ngwear.errors import SceneError
from ngwear.plots.pin import read_pin
from ngwear.scene.pin_scene import PinScene
from ngwear.scene.read_scene import read_scene
from ngwear.sliding.run_pin import run_pin
from ngwear.verify.base import Bound, Check

CASE = "pin_on_plate"


def shipped_scene() -> PinScene:
    """Read geometries/pin_on_plate/scene.toml of this checkout."""
    path = Path(__file__).parents[2] / "geometries" / "pin_on_plate" / "scene.toml"
    if not path.is_file():
        raise SceneError("verify", str(path), "the shipped scenes come with the repository: run this in a checkout")
    scene = read_scene(path)
    if not isinstance(scene, PinScene):
        raise SceneError("verify", str(path), "must be a scene of a pin on a plate")
    return scene


def run() -> list[Check]:
    """All speeds, in processes."""
    with tempfile.TemporaryDirectory() as folder:
        summary = run_pin(shipped_scene(), out=folder, figures=False).summary
        series = read_pin(folder).series
    depth, area = series["penetration [mm]"], series["contact area [mm²]"]
    friction, errors = series["friction coefficient [-]"], summary["error estimates"]
    cpu = summary["CPU time [s]"]

    def check(quantity: str, value: float, reference: float, bound: Bound = "below", tolerance: float = 0.0) -> Check:
        return Check(CASE, quantity, float(value), reference, tolerance, cpu, bound=bound)

    rise = np.diff(friction) / friction[1:]
    return [
        check("speeds done [-]", summary["speeds done [-]"], 7, "above"),
        check("penetration, slowest less fastest [mm]", depth[0] - depth[-1], 0.25, "near", 0.1),
        check("largest rise of the penetration between speeds [mm]", np.diff(depth).max(), 0.0),
        check("largest rise of the contact area between speeds [mm²]", np.diff(area).max(), 0.0),
        check("friction, fastest over slowest [-]", friction[-1] / friction[0], 0.99),
        check("largest rise of friction between speeds [-]", rise.max(), 0.0),
        check("fewest elements [-]", series["elements [-]"].min(), 3000, "above"),
        check("friction, between two meshes [-]", errors["friction, between two meshes [-]"], 0.03),
        check("penetration, between two meshes [-]", errors["penetration, between two meshes [-]"], 0.03),
        check("friction, energy against force [-]", errors["friction, energy against force [-]"], 0.01),
        check("wall time [s]", summary["wall time [s]"], 3600.0),
    ]
