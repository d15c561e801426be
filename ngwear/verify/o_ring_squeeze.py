"""An O-ring squeezed along its axis between two plates: force, width of contact and peak pressure.

Cord d = 3.53 mm, bore 19.6 mm, Mooney-Rivlin of 75 Shore A (C10 = 0.94, C01 = 0.235 MPa), no friction; the ring may
grow in the radial direction. Squeeze C of 10, 15, 20 and 25 % of the cord.

Reference: P. B. Lindley, *J. Inst. Rubber Ind.* 1 (1967) 209, fitted to measurements: force per length
``F = E d (1.25 C^1.5 + 50 C^6)``, and with it Hertz's ``b^2 = 6 F d / (pi E)`` and ``p = 4 F / (pi b)``. It is good to
about 10 % for C up to 25 %. At C = 10 % the force is 13 % above it, with 12 and with 24 elements across the contact.

Forces in N/mm, lengths in mm, pressures in MPa.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ngwear.geometry.outline import Outline
from ngwear.loop.stepper import Stepper
from ngwear.materials import MooneyRivlin
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.contact import Contact
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Plane
from ngwear.verify.base import Check, Stopwatch

CASE = "o_ring_squeeze"
CORD, BORE, POINTS = 3.53, 19.6, 160
SQUEEZES = (0.10, 0.15, 0.20, 0.25)
TOLERANCE = 0.10  # of Lindley's formula, by himself


def run() -> Iterator[Check]:
    """Run the case."""
    rubber = MooneyRivlin(c10=0.94, c01=0.235, bulk_modulus=2000.0)
    young = 3 * rubber.shear_modulus
    for squeeze in SQUEEZES:
        watch = Stopwatch()
        state = Stepper(scene(rubber, squeeze)).start()
        report = state.reports[-1]
        force = float(report.forces["left plate"][0]) / (math.pi * (BORE + CORD))
        (zone,) = report.contacts["left plate"].zones()
        wanted = young * CORD * (1.25 * squeeze**1.5 + 50 * squeeze**6)
        width = math.sqrt(6 * wanted * CORD / (math.pi * young))
        values = {
            "force [N/mm]": (force, wanted),
            "width [mm]": (zone.width, width),
            "peak pressure [MPa]": (zone.peak, 4 * wanted / (math.pi * width)),
        }
        for name, (value, reference) in values.items():
            quantity, unit = name.split(" [")
            yield Check(CASE, f"{quantity}, squeeze {squeeze:.0%} [{unit}", value, reference, TOLERANCE, watch.seconds)


def scene(rubber: MooneyRivlin, squeeze: float) -> Scene:
    """The ring between two plates without friction."""
    turn = np.linspace(-math.pi, math.pi, POINTS, endpoint=False)
    x, y = CORD / 2 * np.cos(turn), (BORE + CORD) / 2 + CORD / 2 * np.sin(turn)
    corners = np.zeros(POINTS, dtype=bool)
    ring = Outline(np.column_stack([x, y]), ("outline",) * POINTS, corners)
    half = CORD * (1 - squeeze) / 2
    plates = [
        Contact(f"{name} plate", surface=Plane(point=(way * half, 0.0), normal_vector=(-way, 0.0)), refine=True)
        for name, way in (("left", -1.0), ("right", 1.0))
    ]
    program = Program(strokes=1, cycle=[Stroke("pressed", direction=1, travel=1.0)])
    return Scene(
        "O-ring", Part(ring, material=rubber), contacts=plates, program=program, accuracy=Accuracy(across=24.0)
    )
