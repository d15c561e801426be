"""A ring that a sliding rod rolls over: how far it turns, and the friction that it takes.

Cord d = 2 mm, mean radius R = 20 mm, neo-Hooke G = 1 MPa, squeezed by 2 % between a rod and a bore on which it sticks.
The rod slides by s, up to a quarter of a turn, in ``STEPS`` load steps; nothing else holds the ring along the axis.

Reference: it rolls without slip, so it turns by s / d. A ring turned by the angle a about the middle of its cord, as
one turns it inside out, is strained along its circumference by r (cos(b + a) - cos(b)) / R at the cord's polar
coordinates r, b. With the modulus E and the cord's second moment of area I = pi d^4 / 64 its energy is
2 pi E I (1 - cos(a)) / R, and the friction on the rod is what that grows by over s:

    F = 2 pi E I sin(a) / (R d)

For a small angle it is the couple of S. Timoshenko, *Strength of Materials*, part II (1956): a couple m over the length
of a ring turns it by m R^2 / (E I), and the friction on rod and bore is a couple of F d over the length 2 pi R.

Angles in degrees, forces in N.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.geometry.outline import Outline
from ngwear.loop.mounting import mount, unworn_body
from ngwear.loop.stage import Stage
from ngwear.materials import NeoHooke
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.contact import Contact
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import bore, rod
from ngwear.verify.base import Check, Stopwatch

CASE = "rolling_ring"
CORD, RADIUS, SQUEEZE, POINTS = 2.0, 20.0, 0.02, 160
MODULUS, FRICTION = 1.0, 2.0  # MPa; friction so high that nothing slips
EDGE, COARSE, STEPS = 0.05, 0.15, 60  # mm in contact, mm inside; load steps of a quarter of a turn
MARKS = (30.0, 60.0, 90.0)  # degrees
TURNS, PULLS = 0.005, 0.02  # tolerances


def run() -> Iterator[Check]:
    """Run the case."""
    watch, stage = Stopwatch(), Stage(scene(), unworn_body(scene()))
    mount(stage, lambda fraction: None)
    bending = 3 * MODULUS * math.pi * CORD**4 / 64
    for step in range(1, STEPS + 1):
        angle = math.pi / 2 * step / STEPS
        advance(stage.problem, {"rod travel [mm]": angle * CORD}, StepOptions(first=1.0))
        degrees = math.degrees(angle)
        if any(math.isclose(degrees, mark) for mark in MARKS):
            pull = 2 * math.pi * bending * math.sin(angle) / (RADIUS * CORD)
            friction = float(stage.forces()["rod friction"][0])
            for what, value, reference, tolerance in (
                ("angle of the ring, {} [degrees]", stage.problem.turned(), degrees, TURNS),
                ("friction on the rod, {} [N]", friction, pull, PULLS),
            ):
                quantity = what.format(f"rod slid by {degrees:.0f}° of the cord")
                yield Check(CASE, quantity, value, reference, tolerance, watch.seconds)


def scene() -> Scene:
    """The ring between rod and bore."""
    turn = np.linspace(-math.pi, math.pi, POINTS, endpoint=False)
    points = np.column_stack([CORD / 2 * np.cos(turn), RADIUS + CORD / 2 * np.sin(turn)])
    ring = Outline(points, ("outline",) * POINTS, np.zeros(POINTS, dtype=bool))
    half = CORD * (1 - SQUEEZE) / 2
    surfaces = {"rod": rod(diameter=2 * (RADIUS - half)), "bore": bore(diameter=2 * (RADIUS + half))}
    contacts = [
        Contact(name, surface=surface, friction=FRICTION, sticks=True, slides=name == "rod", refine=True)
        for name, surface in surfaces.items()
    ]
    program = Program(strokes=1, cycle=[Stroke("rolls", direction=1, travel=math.pi / 2 * CORD)])
    part = Part(ring, material=NeoHooke(shear=MODULUS, bulk_modulus=2000.0))
    accuracy = Accuracy(patch=EDGE, coarse=COARSE, mounting=EDGE)
    return Scene("rolling ring", part, contacts=contacts, program=program, accuracy=accuracy)
