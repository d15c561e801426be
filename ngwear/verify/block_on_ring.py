"""Block on ring: a rigid ring wears a steel block over 3600 m of sliding, the wear implicit, cycles jumped.

Plane strain; ring R = 20 mm, P' = 10.8333 N/mm, k = 2e-9 mm²/N, no friction, elements of 20 um in the contact.
Set-up of Cruzado et al., Rev. Metal. 46 (2010) 106, where ring and block both have E = 210000 MPa and nu = 0.3;
here the ring is rigid and the block has their common E* = E / (1 - nu^2) / 2 = 115385 MPa, with nu = 0.4995: a
half-plane depends on E* only, and compression (``W = k P ds / J``) then takes no part in the areas. Reference: depth
in the middle, pressure there and half width from an implicit half-plane solver (Archard's law in backward Euler) at
800, 1600, 2400 and 3600 m; a moving-node commercial code finds 16.166, 25.555, 33.417 and 43.707 um but loses 0.8 %
of volume in mesh motion. Backward Euler's pressure is the mean over its step, and a half width is found within an
element: both are compared within 2 %.

Books: the outline loses what Archard's law takes by quadrature of P / J, and the resultant is the load. The area is
not k F s to better than a/R squared: on the conforming arc ``int p ds = F theta / sin(theta)``, theta = a / R, so that
``W = k int F theta / sin(theta) ds``, which is compared as well. The solve counts include the mounting.
The block is 2 x 10 wide and 10 mm high, eight times the last half width; doubling it changes nothing.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ngwear.materials import NeoHooke
from ngwear.verify.base import Bound, Check, Stopwatch
from ngwear.verify.wear_runs import (
    CONTACT,
    Book,
    CylinderOnBlock,
    depth_at,
    half_width,
    middle_pressure,
    steps,
)

EFFECTIVE, POISSON = 210000.0 / (1 - 0.3**2) / 2, 0.4995
BLOCK = CylinderOnBlock(
    material=NeoHooke.from_young(EFFECTIVE * (1 - POISSON**2), POISSON),
    radius=20.0,
    load=10.8333,
    wear_rate=2.0e-9,
    size=10.0,
    patch=0.02,
    travel=1.0e4,
    wear_error=0.05,
)
METRES = (800, 1600, 2400, 3600)
REFERENCE = {  # m: depth [um], pressure in the middle [MPa], half width [mm]
    800: (16.154, 6.754, 0.804),
    1600: (25.650, 5.342, 1.013),
    2400: (33.615, 4.670, 1.160),
    3600: (44.052, 4.079, 1.328),
}
MOST_SOLVES = 60


def arc_excess(start: float, end: float) -> float:
    """``int (theta / sin(theta) - 1) ds`` [mm] with theta = a / R, a³ = 1.5 k R P' s, over a range of s [mm]."""
    s = np.linspace(start, end, 201)
    theta = np.cbrt(1.5 * BLOCK.wear_rate * BLOCK.radius * BLOCK.load * s) / BLOCK.radius
    return float(np.trapezoid(theta**2 / 6, s))


def run() -> list[Check]:
    """Depth, pressure and half width on the way, the books, the number of solves, and a larger block."""
    clock, book, checks, depth = Stopwatch(), Book(), [], {}
    marks = tuple(round(1e3 * m / BLOCK.travel) for m in METRES)

    def add(quantity: str, value: float, reference: float, tolerance: float, bound: Bound = "near") -> None:
        checks.append(Check("block_on_ring", quantity, value, reference, tolerance, clock.seconds, bound=bound))

    scene = BLOCK.scene("block on ring", marks)
    for state in steps(scene, book):
        if state.strokes not in marks:
            continue
        metre = METRES[marks.index(state.strokes)]
        deep, pressure, wide = REFERENCE[metre]
        profile = state.reports[-1].contacts[CONTACT]
        depth[metre] = 1e3 * depth_at(state.contour, "top", BLOCK.size, 0.0)
        add(f"depth after {metre} m [um]", depth[metre], deep, 0.01)
        add(f"pressure in the middle after {metre} m [MPa]", middle_pressure(profile, 0.1 * wide), pressure, 0.02)
        add(f"half width after {metre} m [mm]", half_width(profile), wide, 0.02)
    removed = scene.part.outline.area - state.contour.area
    flat = BLOCK.wear_rate * BLOCK.load * 1e3 * METRES[-1]
    add("area lost by the outline over the law's quadrature [-]", removed / book.worn, 1.0, 1e-6)
    add("area lost by the outline over the stepper's book [-]", removed / state.ledger.worn, 1.0, 1e-6)
    add("resultant of the pressure over the load [-]", book.load / BLOCK.load, 1.0, 1e-6)
    excess = arc_excess(0.0, 1e3 * METRES[-1]) / (1e3 * METRES[-1])
    add("area lost by the outline over k F s (1 + arc) [-]", removed / flat / (1 + excess), 1.0, 1e-6)
    add("contact solves [-]", state.work.solves, MOST_SOLVES, math.nan, bound="below")

    clock.start()
    for state in steps(replace(BLOCK, size=2 * BLOCK.size).scene("twice the block", marks[:1])):
        last = 1e3 * depth_at(state.contour, "top", 2 * BLOCK.size, 0.0)
    add("depth after 800 m in a block of twice the size over that [-]", last / depth[METRES[0]], 1.0, 2e-3)
    return checks
