"""A rigid cylinder slides without friction over a viscoelastic half-plane (Hunter's problem), solved as steady.

Standard linear solid ``E*(t) = E_inf + E_1 exp(-t / tau)``, incompressible. Closed form (Hunter, J. Appl. Mech. 28
(1961) 611): with alpha = V tau, beta = alpha (E_inf + E_1) / E_inf, half length l, z = l / alpha, y = l / beta,

    c = (beta - alpha) I1(z)/I0(z) / (I1(z)/I0(z) + K1(y)/K0(y))      centre of the contact ahead of the axis
    P = pi E_inf / (4 R) (l^2 + 2 c l K1(y)/K0(y))                    load per thickness
    mu = (pi E_inf l^2 (beta - c) / (4 R P) - alpha + c) / R          horizontal over vertical force

E_inf = 13.33, E_1 = 40 MPa, tau = 1 ms, R = 0.25 mm, P = 0.5 N/mm. The theory is of small strains, and l/R = 0.2 to 0.4
is not: solved is its own scaling R -> 100 R, P -> P / 100, under which l and c stay and mu falls to a hundredth, with
strains of 0.4 %. The block is 8 times the larger of four wakes ``V tau (E_inf + E_1) / E_inf`` and 30 l deep: with half
of these mu comes out 1 % lower. What dissipates sits at the ends of the contact, within V tau: elements of V tau / 4
there (at most l / 120), l / 24 between.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import i0e, i1e, k0e, k1e

from ngwear.effects.contact import Contact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.steady_memory import SteadyMemory
from ngwear.equilibrium.problem import Problem, Support
from ngwear.equilibrium.steady import solve_steady
from ngwear.equilibrium.stepping import relax
from ngwear.fields.kinematics import PlaneStrain
from ngwear.materials import NeoHooke, PronySeries
from ngwear.surfaces import Cylinder
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.builders import meshed, rectangle

Array = NDArray[np.float64]
RADIUS, LOAD = 0.25, 0.5  # mm, N/mm
LONG_TERM, ARM, TIME = 13.33, 40.0, 1e-3  # MPa, MPa, s
SPEEDS = (1.0, 5.0, 20.0, 32.1, 50.0, 200.0, 2000.0)  # mm/s
SCALE = 100.0
SHEAR = LONG_TERM / 4  # E* = 4 G
RUBBER = NeoHooke(shear=SHEAR, bulk_modulus=1e5 * SHEAR)


@dataclass(frozen=True)
class Sliding:
    """Friction coefficient [-], half length and centre of the contact ahead of the axis [mm]."""

    friction: float
    half_length: float
    centre: float


def closed_form(speed: float) -> Sliding:
    """Hunter's solution at a speed [mm/s]."""
    alpha = speed * TIME
    beta = alpha * (LONG_TERM + ARM) / LONG_TERM

    def centre_and_load(half: float) -> tuple[float, float]:
        a, b = i1e(half / alpha) / i0e(half / alpha), k1e(half / beta) / k0e(half / beta)
        centre = (beta - alpha) * a / (a + b)
        return centre, np.pi * LONG_TERM / (4 * RADIUS) * (half**2 + 2 * centre * half * b)

    half = brentq(lambda length: centre_and_load(length)[1] - LOAD, 1e-6, 10.0)
    centre, _ = centre_and_load(half)
    stiff = np.pi * LONG_TERM * half**2 * (beta - centre) / (4 * RADIUS * LOAD)
    return Sliding((stiff - alpha + centre) / RADIUS, half, centre)


def march(start: float, stop: float, size: Callable[[float], float]) -> Array:
    """Places from start to stop, each ``size`` of the last one further."""
    places = [start]
    while places[-1] < stop:
        places.append(places[-1] + size(places[-1]))
    places[-1] = stop
    return np.array(places)


def steady(speed: float) -> Sliding:
    """The same from a steady solve."""
    expected = closed_form(speed)
    half, ends = expected.half_length, expected.centre + expected.half_length * np.array([-1.0, 1.0])
    reach = 8 * max(4 * speed * TIME * (LONG_TERM + ARM) / LONG_TERM, 30 * half)
    middle, finest = half / 24, float(np.clip(speed * TIME / 4, half / 600, half / 120))

    def patch(x: float) -> float:
        return float(np.clip(0.2 * np.abs(ends - x).min(), finest, middle))

    seeds = march(-1.6 * half, 1.6 * half, patch)
    away = march(1.6 * half, reach, lambda x: max(middle, 0.08 * (x - 1.6 * half)))[1:]
    columns = np.concatenate([-away[::-1], seeds, away])
    rows = reach - march(0.0, reach, lambda depth: max(finest / 2, 0.08 * depth))[::-1]
    body = meshed(
        rectangle((-reach, reach), (0.0, reach)),
        reach / 4,
        np.stack([seeds, np.full(len(seeds), reach)], axis=1),
        np.array([patch(x) for x in seeds]),
    )
    radius, load = SCALE * RADIUS, LOAD / SCALE
    cylinder = Cylinder(centre=(0.0, reach + radius), radius=radius)
    contact = Contact("cylinder", ("top",), cylinder, force_controlled=True, modulus=SHEAR)
    memory = SteadyMemory(
        RUBBER, PronySeries.from_moduli([ARM], [TIME], long_term=LONG_TERM), columns=columns, rows=rows
    )
    supports = [Support(("bottom",)), Support(("left", "right"), y=False)]
    problem = Problem(body, PlaneStrain(), [Elasticity(RUBBER), memory, contact], supports=supports)
    problem.fields[contact.travel_name].vec[0] = half**2 / (4 * radius)  # an overlap to start from
    problem.set_loads({"cylinder force [N]": load})
    relax(problem)
    memory.set_speed(speed, 4 * half)
    solve_steady(problem, memory)
    along, across = contact.force()
    (zone,) = contact.profile().zones()
    start, end = sorted((zone.start[0], zone.end[0]))
    return Sliding(float(abs(along / across)) * SCALE, (end - start) / 2, (end + start) / 2)


def run() -> list[Check]:
    """Friction, half length and centre at seven speeds."""
    checks: list[Check] = []
    for speed in SPEEDS:
        clock = Stopwatch()
        found, expected = steady(speed), closed_form(speed)
        for name, quantity, tolerance in (
            ("friction", "friction coefficient at {} mm/s [-]", 0.01),
            ("half_length", "half length at {} mm/s [mm]", 0.02),
            ("centre", "centre ahead of the axis at {} mm/s [mm]", 0.02),
        ):
            values = (getattr(found, name), getattr(expected, name))
            checks.append(Check("hunter", quantity.format(f"{speed:g}"), *values, tolerance, clock.seconds))
    return checks
