"""A cylinder that wears into rubber: the late times of Archard's law in closed form.

Plane strain, nearly incompressible block, E = 1 MPa, nu = 0.4995, in place of a half-plane; rigid cylinder R = 20 mm,
no friction, P' that of Hertz' half width a_H = 0.05 mm, k = 1e-3 mm²/N. Once worn, the flat conforms to the cylinder
and the pressure is uniform: depth a²/(2R), volume 2 a³/(3R) = k P' s, hence ``a³ = a_H³ + 1.5 k R P' s``, exact at
both ends (Hertz, and s -> infinity), and a pressure of P'/(2a). Half width and pressure are compared at a = 1.4 mm,
28 a_H; depth there and at a = 1.0 mm. Backward Euler's pressure is the mean over its step, in which it falls with
s^(-1/3); so the last step is a short one.
"""

from __future__ import annotations

import math

import numpy as np

from ngwear.materials import NeoHooke
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.wear_runs import (
    CONTACT,
    Book,
    CylinderOnBlock,
    depth_at,
    half_width,
    middle_pressure,
    steps,
)

RUBBER = NeoHooke.from_young(1.0, 0.4995)
RADIUS, HERTZ, WEAR_RATE, TRAVEL = 20.0, 0.05, 1e-3, 2000.0
LOAD = math.pi * RUBBER.plane_strain_modulus * HERTZ**2 / (4 * RADIUS)
BLOCK = CylinderOnBlock(
    material=RUBBER,
    radius=RADIUS,
    load=LOAD,
    wear_rate=WEAR_RATE,
    size=12.0,
    patch=0.0125,
    travel=TRAVEL,
    wear_error=0.05,
)
WANTED = (1.0, 1.4)
EVE = 0.97  # of the strokes: where the last, short step begins
TOLERANCE = 0.01


def run() -> list[Check]:
    """Depth on the way; depth, half width and mean pressure at the end."""
    clock, book, checks = Stopwatch(), Book(), []

    def add(quantity: str, value: float, reference: float, tolerance: float) -> None:
        checks.append(Check("worn_cylinder", quantity, value, reference, tolerance, clock.seconds))

    growth = 1.5 * WEAR_RATE * RADIUS * LOAD * TRAVEL  # of a³ in a stroke
    marks = tuple(round((a**3 - HERTZ**3) / growth) for a in WANTED)
    eve = round(EVE * marks[-1])
    scene = BLOCK.scene("worn cylinder", (marks[0], eve, marks[-1]))
    for state in steps(scene, book):
        if state.strokes in marks:
            a = float(np.cbrt(HERTZ**3 + growth * state.strokes))
            deep = depth_at(state.contour, "top", BLOCK.size, 0.0)
            add(f"depth at a = {a:.1f} mm [mm]", deep, a**2 / (2 * RADIUS), TOLERANCE)
    profile = state.reports[-1].contacts[CONTACT]
    add("half width [mm]", half_width(profile), a, TOLERANCE)
    add("mean pressure within 0.8 a [MPa]", middle_pressure(profile, 0.8 * a), LOAD / (2 * a), TOLERANCE)
    removed = scene.part.outline.area - state.contour.area
    add("area lost by the outline over the law's quadrature [-]", removed / book.worn, 1.0, 1e-6)
    add("resultant of the pressure over the load [-]", book.load / LOAD, 1.0, 1e-6)
    return checks
