"""Fretting wear of a cylinder on a flat: both bodies wear, in gross slip, over 10,000 cycles.

Both of steel, E = 200,000 MPa, nu = 0.3; R = 6 mm, 18.5 N per mm of thickness, +-0.025 mm imposed, mu = 0.9,
k = 2.9e-8 mm²/N (flat) and 1.9e-8 mm²/N (cylinder). Reference: depth in the middle of the flat after 1,000, 5,000 and
10,000 cycles, 0.377, 1.127 and 1.809 µm, with the elastic share of the slip.

The model is a rigid cylinder on one incompressible block of E* = E / (2 (1 - nu²)) = 109,890 MPa, G = E*/4. As
half-planes, pair and model are equal, normally and tangentially, and in neither do the two couple (both have Dundurs'
beta = 0). They differ in how far material reaches, on which the tangential deflection d under mu P' depends
logarithmically: 0.82 µm on the unworn contact with a block of 12 x 6 mm (bonded below, as deep as the cylinder's
radius), 0.89 µm with one of 24 x 12 mm, whose depths are 0.2 % less. Each way slips 2 (0.025 mm - d).

d is checked against a way after a reversal, resolved in steps of stick and slip: its mean slip is ``way - 2 d``. The
depths are compared besides with those of half-planes (``tests/benchmarks/fretting_half_plane.py``: Flamant's influence
and an implicit Archard step in place of elements, 2,964 solves, d = 0.75 µm; with d = 0 they are 0.385, 1.151 and
1.847 µm).
"""

from __future__ import annotations

import math

import numpy as np

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.friction import Friction, FullSliding
from ngwear.effects.stick_slip import StickSlip
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.materials import NeoHooke
from ngwear.surfaces import Cylinder, WornProfile
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.builders import meshed
from ngwear.wear.fretting import Fretting, Motion, Scar
from ngwear.wear.jump_control import JumpControl

PAIR_MODULUS = 200_000.0 / (2 * (1 - 0.3**2))  # E* [MPa]
MATERIAL = NeoHooke(shear=PAIR_MODULUS / 4, bulk_modulus=PAIR_MODULUS / 4 * 1e4)
RADIUS, LOAD, MU = 6.0, 18.5, 0.9
MOTION = Motion(amplitude=0.025, wear_rate=2.9e-8, counter_wear_rate=1.9e-8)
BLOCK, SIZE = 6.0, 0.006
REACH = 0.19  # to either side of the middle: where the mesh is fine
WEAR_ERROR, FIRST_JUMP = 0.1, 5
DEPTHS = {1_000: 0.377e-3, 5_000: 1.127e-3, 10_000: 1.809e-3}
HALF_PLANE = {1_000: 0.3789e-3, 5_000: 1.1318e-3, 10_000: 1.8150e-3}
WAY, STEPS = 0.006, 15  # of the resolved stick and slip
SLIDE = "cylinder slide [mm]"


def pressed(reach: float, *, sticks: bool) -> tuple[Problem, OutlineContact, Friction, Elasticity]:
    """The problem under its normal load."""
    seeds = np.arange(-reach, reach + SIZE / 2, SIZE)
    body = meshed(
        Outline.rectangle((-BLOCK, BLOCK), (0.0, BLOCK)), BLOCK / 4, np.stack([seeds, 0 * seeds + BLOCK], axis=1), SIZE
    )
    cylinder = Cylinder(centre=(0.0, BLOCK + RADIUS), radius=RADIUS)
    contact = OutlineContact(
        "cylinder",
        ("top",),
        cylinder,
        force_controlled=True,
        slides=True,
        counter=WornProfile(SIZE),
        modulus=MATERIAL.shear_modulus,
    )
    friction: Friction = StickSlip(contact, MU) if sticks else FullSliding(contact, MU)
    elasticity = Elasticity(MATERIAL)
    problem = Problem(body, PlaneStrain(), [elasticity, contact, friction], supports=[FixedEdges(("bottom",))])
    squared = 4 * LOAD * RADIUS / (math.pi * MATERIAL.plane_strain_modulus)  # Hertz' half width
    problem.fields[contact.travel_name].vec[0] = squared / (2 * RADIUS)
    if not sticks:
        problem.set_loads({"cylinder slip": 0.0})
    advance(problem, {"cylinder force [N]": LOAD}, StepOptions(first=0.25))
    return problem, contact, friction, elasticity


def worn(*, marks: tuple[int, ...] = tuple(DEPTHS)) -> tuple[Fretting, list[Scar]]:
    """Run the cycles; scars before any wear and after the marked cycles."""
    problem, contact, friction, elasticity = pressed(REACH, sticks=False)
    control = JumpControl(WEAR_ERROR, cycles=FIRST_JUMP, longest=marks[-1])
    fretting = Fretting(problem, contact, friction, elasticity, MOTION, control)
    scars = [fretting.scar()]
    for mark in marks:
        while fretting.cycles < mark:
            fretting.advance(mark)
        scars.append(fretting.scar())
    return fretting, scars


def resolved_drag() -> float:
    """Drag d from the slip of one way after a reversal, mean over the contact's force [mm]."""
    problem, contact, *_ = pressed(0.06, sticks=True)
    u = problem.fields[DISPLACEMENT]
    advance(problem, {SLIDE: WAY / 2}, StepOptions(first=0.1))
    slipped, slide = 0.0, WAY / 2
    moved, load = contact.at_nodes(u[0]), contact.profile().load
    for goal in np.linspace(WAY / 2, -WAY / 2, STEPS + 1)[1:]:
        advance(problem, {SLIDE: goal})
        now, carried = contact.at_nodes(u[0]), contact.profile().load
        slipped += float(np.abs(now - moved - (goal - slide)) @ (load + carried)) / (2 * LOAD)
        moved, load, slide = now, carried, goal
    return (WAY - slipped) / 2


def run() -> list[Check]:
    """Depth of the flat, worn areas of both bodies, and the elastic share of the slip."""
    clock, checks = Stopwatch(), []

    def check(quantity: str, value: float, reference: float, tolerance: float) -> None:
        checks.append(Check("fretting", quantity, value, reference, tolerance, clock.seconds))

    fretting, scars = worn()
    for scar in scars[1:]:
        check(f"depth of the flat after {scar.cycles} cycles [mm]", scar.depth.max(), DEPTHS[scar.cycles], 0.03)
        alike = HALF_PLANE[scar.cycles]
        check(f"depth of the flat after {scar.cycles} cycles, of half-planes [mm]", scar.depth.max(), alike, 0.01)
    last = scars[-1]
    check("area lost by the flat over the law's integral [-]", last.area / fretting.worn, 1.0, 1e-10)
    check("area lost by the cylinder over the law's [-]", last.counter.area / fretting.counter_worn, 1.0, 1e-10)
    ratio = MOTION.counter_wear_rate / MOTION.wear_rate
    check("worn area, cylinder over flat [-]", last.counter.area / last.area, ratio, 1e-4)
    clock.start()
    fresh = Fretting(*pressed(0.06, sticks=False), MOTION, JumpControl(WEAR_ERROR))
    check("drag of the unworn flat, of stick and slip resolved [mm]", resolved_drag(), fresh.drag, 5e-3)
    return checks
