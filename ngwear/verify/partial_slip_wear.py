"""Wear in partial slip: a shaft turns to and fro on a half-plane by so little that its middle sticks.

Incompressible (K/G = 1e4, so that normal and tangential tractions do not couple), rigid shaft R = 400 mm, load per mm
of thickness P that of a half width a = 1 mm, mu = 0.02, k = 5 mm²/N. The shaft goes to and fro by 5.2 um; the block
stands on two thin legs, which give way to it like a spring, so that the friction Q goes to and fro by the same from
stroke to stroke whatever wears (to 0.5 %); on a bonded block of finite height the stick zone would grow as the contact
settles.

What slips wears until it carries no pressure; what sticks, |x| < c, keeps its size and its shape (M. Ciavarella and
D.A. Hills, J. Strain Anal. 34 (1999) 113; I.G. Goryacheva, P.T. Rajeev and T.N. Farris, J. Tribol. 123 (2001) 848; for
three dimensions V.L. Popov, Sci. Rep. 4 (2014) 3749). With Q's range D per stroke, c / a = sqrt(1 - D / (2 mu P)). The
pressure is then Hertz' for c and a flat punch's for the rest of P, and the worn depth w what keeps the surface outside
off the cylinder (the punch's displacement beside Hertz' gap; Johnson, *Contact Mechanics*, 2.64 and 4.43):

    p = (E*/2R) sqrt(c^2 - x^2) + (P - P_c) / (pi sqrt(c^2 - x^2)),    P_c = pi E* c^2 / (4R)
    p(0) / p0 = (a^2 + c^2) / (2 a c)
    2 R w = a^2 arcosh(|x|/c) - |x| sqrt(x^2 - c^2) >= 0,    deepest at |x| = sqrt((a^2 + c^2) / 2)

On the way there, after 6,000 strokes, the reference is a half-plane with Flamant's influence, whose slip is
2 mu times the gap that opens as P sinks by D / (2 mu) (Jaeger, Ciavarella; 601 cells of 5 um,
``tests/benchmarks/partial_slip_half_plane.py``).

The scene is a user's: two strokes a cycle under force, cycle jumps. The legs' elements are as the stresses ask: where
they are coarse, the legs are stiff, a stroke takes friction and slip with it, and all wears faster than the half-plane
that gives way as the legs should. On the way what is worn depends on the elements at the stick zone's ends: it is 13 %
short on those of 0.05 mm (``FINEST``), so that part has finer ones.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ngwear.geometry.outline import Outline
from ngwear.loop.state import State
from ngwear.loop.stepper import Stepper
from ngwear.materials import NeoHooke
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Support
from ngwear.scene.contact import Contact
from ngwear.scene.options import Wear
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Cylinder
from ngwear.verify.base import Bound, Check, Stopwatch

Array = NDArray[np.float64]
MATERIAL = NeoHooke(shear=1.0, bulk_modulus=1e4)
RADIUS, HALF_WIDTH, MU, WEAR_RATE, TRAVEL = 400.0, 1.0, 0.02, 5.0, 5.2e-3
LOAD = math.pi * MATERIAL.plane_strain_modulus * HALF_WIDTH**2 / (4 * RADIUS)
PEAK = 2 * LOAD / (math.pi * HALF_WIDTH)
BLOCK, LEG = 40.0, 8.0  # height of block and legs, and half the block's width; width of a leg
CASE = "partial_slip_wear"
PATCHES, FINEST = (0.1, 0.05), 0.025
ON_THE_WAY, LATE = 6_000, 12_000
SHARE = 0.638  # D / (2 mu P), as the legs give way, and of the half-plane
HALF_PLANE = {"p(0) / p0": 1.1169, "area": 3.638e-4}


def scene(patch: float) -> Scene:
    """A block on two legs under a shaft that turns to and fro."""
    top, half = 2 * BLOCK, BLOCK
    points = [(-half, 0.0), (LEG - half, 0.0), (LEG - half, BLOCK), (half - LEG, BLOCK), (half - LEG, 0.0)]
    points += [(half, 0.0), (half, top), (-half, top)]
    names = ("feet", "free", "free", "free", "feet", "free", "top", "free")
    shaft = Cylinder(centre=(0.0, top + RADIUS), radius=RADIUS)
    to, fro = (Stroke(name=name, travel=TRAVEL, direction=way) for name, way in (("to", 1.0), ("fro", -1.0)))
    return Scene(
        name="wear in partial slip",
        part=Part(Outline(np.array(points), names, np.ones(len(points), dtype=bool)), material=MATERIAL),
        contacts=(
            Contact(name="shaft", edges=("top",), surface=shaft, force=LOAD, friction=MU, specific_wear_rate=WEAR_RATE),
        ),
        supports=(Support(edges=("feet",)),),
        program=Program(cycle=(to, fro), strokes=LATE),
        accuracy=Accuracy(patch=patch, coarse=8.0, mounting=0.2, grading=0.4, stress_error=0.1, wear_error=0.05),
        wear=Wear(max_jump=LATE),
        axisymmetric=False,
    )


def stick_width(state: State) -> float:
    """Half of the width that sticks in either stroke [mm]: its mesh edges' ends."""
    ends = state.stage.contacts["shaft"].end_places()[:, :, 0]
    edges = state.reports[-1].contacts["shaft"].edges
    slips = [phase.shares["shaft"] for phase in state.phases if phase.shares is not None]
    stuck = np.any([(share[edges].max(axis=1) < 1e-3 * share.max()) for share in slips], axis=0)
    inside = stuck & (np.abs(ends).max(axis=1) < HALF_WIDTH)
    return 0.5 * float(ends[inside].max() - ends[inside].min())


def friction_range(state: State) -> float:
    """By how much the friction changes from stroke to stroke [N/mm]."""
    forces = [float(report.forces["shaft friction"][0]) for report in state.reports[:2]]
    return abs(forces[0] - forces[1])


def stuck_half_width(change: float) -> float:
    """Cattaneo's c [mm] for a friction that changes by so much [N/mm]."""
    return HALF_WIDTH * math.sqrt(1 - change / (2 * MU * LOAD))


def middle_pressure(state: State) -> float:
    """Pressure in the middle over p0 [-]."""
    profile = state.reports[-1].contacts["shaft"]
    return float(np.interp(0.0, *ordered(profile.reference[:, 0], profile.pressure))) / PEAK


def ordered(x: Array, y: Array) -> tuple[Array, Array]:
    """Both by ascending x."""
    order = np.argsort(x)
    return x[order], y[order]


def run() -> list[Check]:
    """Both meshes: how near the limit they come; a finer one on the way."""
    return [check for patch in PATCHES for check in late(patch)] + on_the_way(FINEST)


def late(patch: float) -> list[Check]:
    """All strokes, against the limit."""
    clock, stepper = Stopwatch(), Stepper(scene(patch))
    state = stepper.advance(stepper.start())
    first = friction_range(state)
    while not stepper.finished(state):
        last = friction_range(state)
        state = stepper.advance(state)
    c = stuck_half_width(last)
    deepest = HALF_WIDTH * math.sqrt((1 + c**2) / 2)
    wanted = (math.acosh(deepest / c) - deepest * math.sqrt(deepest**2 - c**2)) / (2 * RADIUS)
    top = state.contour.points[:, 1] > 2 * BLOCK - 0.1
    depth = 2 * BLOCK - float(state.contour.points[top & inner(state), 1].min())
    check = _checker(patch, clock.seconds)
    return [
        check("change of friction, last over first [-]", last / first, 1.0, 5e-3),
        check("half width that sticks [mm]", stick_width(state), c - 2 * patch, math.nan, "above"),
        check("p(0) / p0 [-]", middle_pressure(state), 0.5 * (1 / c + c), 0.03),
        check("greatest depth [mm]", depth, wanted, 0.05),
        check("area lost over the law's [-]", state.ledger.removed / state.ledger.worn, 1.0, 1e-6),
    ]


def on_the_way(patch: float) -> list[Check]:
    """The first half of the strokes, against the half-plane."""
    clock, whole = Stopwatch(), scene(patch)
    stepper = Stepper(replace(whole, program=replace(whole.program, strokes=ON_THE_WAY)))
    state = stepper.advance(stepper.start())
    share = friction_range(state) / (2 * MU * LOAD)
    while not stepper.finished(state):
        state = stepper.advance(state)
    check = _checker(patch, clock.seconds)
    return [
        check("change of friction over 2 mu P, the half-plane's [-]", share, SHARE, 5e-3),
        check("p(0) / p0 after 6,000 strokes [-]", middle_pressure(state), HALF_PLANE["p(0) / p0"], 0.01),
        check("worn area after 6,000 strokes [mm²]", state.ledger.removed, HALF_PLANE["area"], 0.05),
    ]


def _checker(patch: float, seconds: float) -> Callable[..., Check]:
    """Checks of a mesh, which their names tell."""

    def check(quantity: str, value: float, reference: float, tolerance: float, bound: Bound = "near") -> Check:
        return Check(CASE, f"{quantity}, elements of {patch} mm", value, reference, tolerance, seconds, bound=bound)

    return check


def inner(state: State) -> NDArray[np.bool_]:
    """Points of the outline under the shaft."""
    return np.abs(state.contour.points[:, 0]) < 2 * HALF_WIDTH
