"""A rectangular ring in a closed groove: the fluid's pressure adds to the pressure of its contacts.

Section 3.4 x 3.5 mm with corners rounded by 0.3 mm, neo-Hooke G = 0.6, K = 2000 MPa, no friction; rod of 20 mm, groove
3 mm deep and 4.45 mm wide, which leaves 1.05 mm of room along the axis. Fluid from the right, p/G of 1, 5 and 10.

Reference: a uniform pressure does not strain an incompressible part. So a part that surfaces and fluid enclose answers
a fluid's pressure p by the same pressure in itself, and its contact pressure is its own plus p. It is not exact: beside
the left wall the corners are free of fluid, and the ring creeps in. Compared in the middle of the contact with the rod.

Pressures in MPa.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ngwear.geometry.outline import Outline
from ngwear.loop.state import StrokeReport
from ngwear.loop.stepper import Stepper
from ngwear.materials import NeoHooke
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Fluid
from ngwear.scene.contact import Contact
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Plane, bore, rod
from ngwear.verify.base import Check, Stopwatch

CASE = "confined_ring"
WIDTH, HEIGHT, CORNER, ROD, DEPTH, ROOM = 3.4, 3.5, 0.3, 20.0, 3.0, 1.05  # mm
MODULUS, RATIOS = 0.6, (1.0, 5.0, 10.0)
TOLERANCE = 0.01


def run() -> Iterator[Check]:
    """Run the case."""
    watch = Stopwatch()
    first, *others = Stepper(scene()).start().reports
    own = middle_pressure(first, "rod")
    for ratio, report in zip(RATIOS, others, strict=True):
        added = ratio * MODULUS
        value = middle_pressure(report, "rod")
        yield Check(CASE, f"pressure on the rod, p/G = {ratio:g} [MPa]", value, own + added, TOLERANCE, watch.seconds)


def middle_pressure(report: StrokeReport, contact: str) -> float:
    """Mean pressure of the middle third of the contact's widest zone [MPa]."""
    profile = report.contacts[contact]
    zone = max(profile.zones(), key=lambda zone: zone.width)
    nodes = zone.nodes[len(zone.nodes) // 3 : -(len(zone.nodes) // 3)]
    return float((profile.load[nodes]).sum() / (profile.load[nodes] / profile.pressure[nodes]).sum())


def outline() -> Outline:
    """The section, its lower left corner at (0, rod radius - squeeze / 2)."""
    low = ROD / 2 + (DEPTH - HEIGHT) / 2
    points: list[tuple[float, float]] = []
    names: list[str] = []
    ends = [(WIDTH, low, -0.5), (WIDTH, low + HEIGHT, 0.0), (0.0, low + HEIGHT, 0.5), (0.0, low, 1.0)]
    for (x, y, turn), name in zip(ends, ("right", "top", "left", "bottom"), strict=True):
        angles = np.pi * np.linspace(turn, turn + 0.5, 8)
        centre = x + (CORNER if x == 0 else -CORNER), y + (CORNER if y == low else -CORNER)
        points += [(centre[0] + CORNER * np.cos(a), centre[1] + CORNER * np.sin(a)) for a in angles]
        names += [name] * 8
    return Outline(np.array(points), tuple(names), np.zeros(len(points), dtype=bool))


def scene() -> Scene:
    """The ring at rest, and under each pressure."""
    plane = {"left wall": ((0.0, 0.0), (1.0, 0.0)), "right wall": ((WIDTH + ROOM, 0.0), (-1.0, 0.0))}
    contacts = [
        Contact("rod", surface=rod(diameter=ROD), refine=True),
        Contact("groove", surface=bore(diameter=ROD + 2 * DEPTH)),
        *(Contact(name, surface=Plane(point=p, normal_vector=n), refine=True) for name, (p, n) in plane.items()),
    ]
    pressures = [0.0, *(ratio * MODULUS for ratio in RATIOS)]
    cycle = [Stroke(f"{p:g} MPa", direction=0, travel=1.0, pressure=p) for p in pressures]
    names = ("right", "top", "left", "bottom")
    return Scene(
        "rectangular ring",
        Part(outline(), material=NeoHooke(shear=MODULUS, bulk_modulus=2000.0)),
        contacts=contacts,
        fluid=Fluid(edges=names, inlet=("right",)),
        program=Program(strokes=len(cycle), cycle=cycle),
        accuracy=Accuracy(across=12.0),
    )
