"""A block pressed against a wall with a gap: how far it comes into the gap, and its pressure on the wall.

Plane strain; neo-Hooke, G = 1 MPa, K/G = 1e4. Half of a gap of 2a = 0.2 mm in a wall, which ends in corners of radius
r = 0.01 mm, above a block of W = 0.5 mm (the sides are planes of symmetry) and 1 mm height, under the fluid pressure
p = 0.01 MPa from below; no friction.

At small strain the wall and its mirror image are a row of cracks under tension, in closed form by Westergaard (*J.
Appl. Mech.* 6 (1939) A49; Tada, Paris & Irwin, *The Stress Analysis of Cracks Handbook*, part 7): with cracks of
half-length c at distances of 2W and E' = 4 G (incompressible),

    bulge in the middle of the gap = (2 p / E') (2 W / pi) arccosh(1 / cos(pi c / 2 W)),
    pressure on the wall = p sin(pi x / 2 W) / sqrt(sin(pi x / 2 W)^2 - sin(pi c / 2 W)^2),  x from the gap's middle.

A flat block leaves the wall where the rounding begins: c = a + r as p goes to 0.
"""

from __future__ import annotations

import math

import numpy as np

from ngwear.effects.base import DISPLACEMENT
from ngwear.fields.deformed_outline import outline_places
from ngwear.geometry.outline import Outline
from ngwear.loop.stepper import Stepper
from ngwear.materials import NeoHooke
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Fluid, Support
from ngwear.scene.contact import Contact
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Corner
from ngwear.verify.base import Check, Stopwatch

GAP, RADIUS, HALF, HEIGHT = 0.1, 0.01, 0.5, 1.0
MODULUS, PRESSURE = 1.0, 0.01
ACCURACY = Accuracy(patch=0.005, coarse=0.1, mounting=0.005)
AWAY = 0.2, 0.45  # from the gap's middle: where the pressure on the wall is compared
TOLERANCE, BALANCE = 0.01, 1e-5


def scene(
    gap: float = GAP,
    radius: float = RADIUS,
    *,
    half: float = HALF,
    pressure: float = PRESSURE,
    accuracy: Accuracy = ACCURACY,
) -> Scene:
    """The block under pressure; lengths [mm], half of the gap and of the distance between two, and pressure [MPa]."""
    corner = Corner(point=(gap, HEIGHT), normal_vector=(0.0, -1.0), side=(-1.0, 0.0), radius=radius)
    return Scene(
        "extrusion gap",
        Part(
            Outline.rectangle((0.0, half), (0.0, HEIGHT)),
            material=NeoHooke(shear=MODULUS, bulk_modulus=1e4 * MODULUS),
        ),
        contacts=[Contact("wall", edges=("top",), surface=corner, slides=False, refine=True)],
        axisymmetric=False,
        supports=[Support(edges=("left", "right"), y=False)],
        fluid=Fluid(edges=("bottom",), inlet=("bottom",)),
        program=Program(strokes=1, cycle=[Stroke("pressed", direction=0, travel=1.0, pressure=pressure)]),
        accuracy=accuracy,
    )


def run() -> list[Check]:
    """Bulge, pressure on the wall away from its corner, and balance."""
    clock = Stopwatch()
    stage = Stepper(scene()).start().stage
    place = outline_places(stage.body, stage.problem.fields[DISPLACEMENT])[1][0]
    bulge = float(place[np.abs(place[:, 0]) < 1e-9, 1].max()) - HEIGHT
    wall = stage.contacts["wall"].profile()
    x, p = wall.place[:, 0], wall.pressure
    beside = (p > 0) & (x > AWAY[0]) & (x < AWAY[1])
    angle = math.pi * (GAP + RADIUS) / (2 * HALF)
    opens = 2 * PRESSURE / (4 * MODULUS) * (2 * HALF / math.pi) * math.acosh(1 / math.cos(angle))
    sine = np.sin(math.pi * x[beside] / (2 * HALF))
    ratio = p[beside] / (PRESSURE * sine / np.sqrt(sine**2 - math.sin(angle) ** 2))
    worst = float(ratio[np.abs(ratio - 1).argmax()])
    load, forces = PRESSURE * HALF, stage.forces()
    balance = float(abs(sum(force[1] for force in forces.values()))) / load
    seconds = clock.seconds
    return [
        Check("extrusion_gap", "bulge in the middle of the gap [mm]", bulge, opens, TOLERANCE, seconds),
        Check("extrusion_gap", "pressure on the wall, worst node [-]", worst, 1.0, TOLERANCE, seconds),
        Check("extrusion_gap", "forces out of balance over the load [-]", balance, 0.0, BALANCE, seconds),
    ]
