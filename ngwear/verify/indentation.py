"""A ball on a bonded rubber sheet, 40 % deep: penetration and contact area.

Sheet 4 mm thick, bonded, Mooney-Rivlin with C10 = 0.6, C01 = 0.15 MPa, K/G = 1000; ball R = 5 mm, 100 N, no friction.
Reference: an independent solution with P2/P0 tetrahedra, 1.578 +- 0.005 mm and 29.3 mm² of the undeformed surface in
contact, that came with the project's statement (Hertz's half-space would say 3 mm). How far that sheet reaches is not
said; here it reaches 12 mm to each side, three thicknesses. It matters: with ``pressed(FAR)``, 20 and 14 mm as the pin
on a plate takes it, the free sides are farther and the penetration is 0.5 % less.
"""

from __future__ import annotations

from ngwear.materials import MooneyRivlin
from ngwear.scene.pin_scene import Pin, PinMesh
from ngwear.sliding.patch import contact_patch
from ngwear.sliding.pin import PinStage
from ngwear.verify.base import Check, Stopwatch

RUBBER = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1500.0)
BLOCK = PinMesh(patch=0.45, coarse=2.0, reach=3.0, beside=3.0)
FAR = PinMesh(patch=0.45, coarse=2.0)
DEPTH, AREA = 1.578, 29.3  # mm, mm²


def pressed(mesh: PinMesh) -> PinStage:
    """The ball under its load, straight from first touch."""
    stage = PinStage(Pin(material=RUBBER, series=None, friction=0.0), mesh, (0.0, 0.0, 3.0))
    stage.press()
    return stage


def run() -> list[Check]:
    """One load."""
    clock = Stopwatch()
    stage = pressed(BLOCK)
    area = contact_patch(stage.contact).reference_area
    return [
        Check("indentation", "penetration [mm]", stage.depth, DEPTH, 0.005, clock.seconds),
        Check("indentation", "undeformed surface in contact [mm²]", area, AREA, 0.03, clock.seconds),
        Check("indentation", "force along the track over load [-]", stage.contact.resistance() / 100, 0.0, 1e-9, 0.0),
    ]
