"""An O-ring squeezed along its axis between two plates: force, width of contact and peak pressure.

Cord d = 3.53 mm, bore 19.6 mm, Mooney-Rivlin of 75 Shore A (C10 = 0.94, C01 = 0.235 MPa), no friction; the ring may
grow in the radial direction. Squeeze C of 10, 15, 20 and 25 % of the cord.

It is compared with

- FElupe 11.3 on 24,576 quads (``tests/benchmarks/o_ring_felupe.py``), good to 0.05 % in force and peak and to 0.15 % in
  width.
- P. B. Lindley, *J. Inst. Rubber Ind.* 1 (1967) 209, fitted to measurements: force per length
  ``F = E d (1.25 C^1.5 + 50 C^6)``, and with it Hertz's ``b^2 = 6 F d / (pi E)`` and ``p = 4 F / (pi b)``. It is taken
  as good to 10 %. The force at C = 10 % fails that bound: both programs lie 12.7 % above it. At a small squeeze Hertz's
  law is almost linear in C, so that C^1.5 falls too fast; for a ring that may grow it lies 7 % above at C = 10 %, and
  more below. The ratio does not depend on the bore, and no model of rubber with E = 3 G that was tried comes nearer
  than 11 %.

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
LINDLEY, FELUPE = 0.10, 0.005  # tolerances
REFERENCE = {  # of FElupe: force [N/mm], width [mm] and peak pressure [MPa] at each squeeze
    0.10: (1.10993, 1.0123, 1.36007),
    0.15: (1.93721, 1.3195, 1.79054),
    0.20: (2.97059, 1.6070, 2.21239),
    0.25: (4.26400, 1.8870, 2.64986),
}


def run() -> Iterator[Check]:
    """Run the case."""
    rubber = MooneyRivlin(c10=0.94, c01=0.235, bulk_modulus=2000.0)
    young = 3 * rubber.shear_modulus
    for squeeze, (force, width, peak) in REFERENCE.items():
        watch = Stopwatch()
        state = Stepper(scene(rubber, squeeze)).start()
        report = state.reports[-1]
        (zone,) = report.contacts["left plate"].zones()
        by_hand = young * CORD * (1.25 * squeeze**1.5 + 50 * squeeze**6)
        wide = math.sqrt(6 * by_hand * CORD / (math.pi * young))
        per_length = float(report.forces["left plate"][0]) / (math.pi * (BORE + CORD))
        rows = {
            "force [N/mm]": (per_length, force, by_hand),
            "width [mm]": (zone.width, width, wide),
            "peak pressure [MPa]": (zone.peak, peak, 4 * by_hand / (math.pi * wide)),
        }
        for name, (value, fine_mesh, lindley) in rows.items():
            quantity, unit = name.split(" [")
            what = f"{quantity}, squeeze {squeeze:.0%}"
            yield Check(CASE, f"{what} [{unit}", value, fine_mesh, FELUPE, watch.seconds)
            yield Check(CASE, f"{what}, Lindley [{unit}", value, lindley, LINDLEY, watch.seconds)


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
