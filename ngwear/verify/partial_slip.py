"""Cattaneo and Mindlin's partial slip: a cylinder pressed on a half-plane, pushed along it, and pulled back.

Plane strain, incompressible (K/G = 1e4, so that normal and tangential tractions do not couple), R = 250 mm, the load
per mm of thickness P' that of a half width a = 1 mm, mu = 0.5; block of 200 x 100 mm, bottom bonded. The cylinder is
pushed until Q = 0.6 mu P', then pulled back until Q is near -0.2 mu P'. References (Johnson, *Contact Mechanics*,
section 7.2), at the Q that each state has:

    loading:    c / a = sqrt(1 - Q / (mu P')),     q = mu p0 [f(x, a) - (c/a) f(x, c)],   f(x, b) = sqrt(1 - x^2/b^2)
    unloading:  c'/ a = sqrt(1 - (Q_max - Q) / (2 mu P')),  q = q_max - 2 mu p0 [f(x, a) - (c'/a) f(x, c')]

with f = 0 outside of its zone. c is where mu p - |q| vanishes (its square is linear there), tractions are compared at
the nodes, over mu p0.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.stick_slip import StickSlip
from ngwear.equilibrium.newton import NewtonOptions
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.materials import NeoHooke
from ngwear.surfaces import Cylinder
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.builders import meshed

Array = NDArray[np.float64]
MATERIAL = NeoHooke(shear=1.0, bulk_modulus=1e4)
RADIUS, HALF_WIDTH, BLOCK = 250.0, 1.0, 100.0
SIZE, COARSE = 0.01, 20.0
MU = 0.5
STEPS = StepOptions(first=0.25, newton=NewtonOptions(tolerance=1e-9))
PUSH, PULL = 0.6, -0.2  # Q over mu P'
TOLERANCE = 0.02


def cap(x: Array, b: float) -> Array:
    """``sqrt(1 - x^2/b^2)`` within b, else 0."""
    return np.sqrt(np.maximum(1 - (x / b) ** 2, 0.0))


def stick_end(x: Array, spare: Array) -> float:
    """Half width of the zone where ``spare``, the friction not used over its peak, is above 0."""
    ends = []
    for side in (1, -1):
        place, left = side * x[side * x >= 0], spare[side * x >= 0]
        order = np.argsort(place)
        place, left = place[order], left[order] ** 2
        last = int(np.flatnonzero(left > 1e-4)[-1])
        slope = (left[last] - left[last - 1]) / (place[last] - place[last - 1])
        ends.append(place[last] - left[last] / slope)
    return float(np.mean(ends))


def pressed() -> tuple[Problem, OutlineContact, StickSlip, float]:
    """The problem under its normal load P' [N/mm]."""
    load = math.pi * MATERIAL.plane_strain_modulus * HALF_WIDTH**2 / (4 * RADIUS)
    at = np.arange(-1.1, 1.1 + SIZE / 2, SIZE) * HALF_WIDTH
    seeds = np.stack([at, np.full(len(at), BLOCK)], axis=1)
    body = meshed(Outline.rectangle((-BLOCK, BLOCK), (0.0, BLOCK)), COARSE, seeds, SIZE)
    cylinder = Cylinder(centre=(0.0, BLOCK + RADIUS), radius=RADIUS)
    contact = OutlineContact(
        "cylinder", ("top",), cylinder, force_controlled=True, slides=True, modulus=MATERIAL.shear_modulus
    )
    friction = StickSlip(contact, MU)
    problem = Problem(
        body, PlaneStrain(), [Elasticity(MATERIAL), contact, friction], supports=[FixedEdges(("bottom",))]
    )
    problem.fields[contact.travel_name].vec[0] = HALF_WIDTH**2 / (2 * RADIUS)
    advance(problem, {"cylinder force [N]": load}, STEPS)
    return problem, contact, friction, load


def push(problem: Problem, friction: StickSlip, wanted: float) -> None:
    """Slide the cylinder until the tangential force is the wanted one [N/mm], by secants."""
    name = "cylinder slide [mm]"
    stiff = friction.contact.modulus  # of the order of Q over slide
    for _ in range(4):
        force, at = friction.force()[0], problem.get_loads()[name]
        if abs(force - wanted) < 1e-3 * abs(wanted):
            return
        goal = at + 0.9 * (wanted - force) / stiff
        advance(problem, {name: goal}, STEPS)
        if friction.force()[0] != force:
            stiff = abs((friction.force()[0] - force) / (goal - at))


def run() -> list[Check]:
    """Stick zone and traction after pushing and after pulling back."""
    clock = Stopwatch()
    problem, contact, friction, load = pressed()
    a, limit, p0 = HALF_WIDTH, MU * load, 2 * load / (math.pi * HALF_WIDTH)
    checks: list[Check] = []

    def look() -> tuple[Array, Array, Array, float]:
        profile = contact.profile()
        q = -contact.at_nodes(problem.fields[friction.tractions[0]])  # the tangent of a surface above points to -x
        on = np.abs(profile.reference[:, 0]) < 0.97 * a
        return profile.reference[on, 0], q[on] / (MU * p0), profile.nominal_pressure[on] / p0, friction.force()[0]

    def check(quantity: str, value: float, reference: float) -> None:
        checks.append(Check("partial_slip", quantity, value, reference, TOLERANCE, clock.seconds))

    push(problem, friction, PUSH * limit)
    x, q, p, highest = look()
    sign = np.sign(highest)
    first = a * math.sqrt(1 - abs(highest) / limit)
    pushed = sign * (cap(x, a) - first / a * cap(x, first))
    check("stick zone over contact, pushed [-]", stick_end(x, p - np.abs(q)) / a, first / a)
    check("root mean square error of the traction over mu p0, pushed [-]", math.sqrt(np.mean((q - pushed) ** 2)), 0.0)
    push(problem, friction, PULL * limit * sign)
    x, q, p, force = look()
    second = a * math.sqrt(1 - abs(highest - force) / (2 * limit))
    pulled = pushed - 2 * sign * (cap(x, a) - second / a * cap(x, second))
    # Since the reversal the traction may change by twice the limit.
    spare = p - np.abs(q - pushed) / 2
    check("stick zone over contact, pulled back [-]", stick_end(x, spare) / a, second / a)
    check("root mean square error of the traction over mu p0, pulled [-]", math.sqrt(np.mean((q - pulled) ** 2)), 0.0)
    return checks
