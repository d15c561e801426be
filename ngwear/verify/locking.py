"""No locking: the error on a coarse mesh does not grow with K/G.

Quarter of a ring (a = 1 mm, b = 2 mm, plane strain, G = 1 MPa) with a pressure in the bore that expands
it by 0.01 %, elements of 0.2 mm, K/G from 1e2 to 1e5. Reference: Lamé (Timoshenko & Goodier,
*Theory of Elasticity*, section 28), ``u = (p a^2 / (b^2 - a^2)) (R / (2 (K + G/3)) + b^2 / (2 G R))``,
exact for every K/G. Displacements of order 1 without an unknown pressure would be too stiff by a factor
that grows with K/G; here the relative L2 error of the displacement stays where it is, for each order of it.

Quadrilaterals: a square cut out of the ring and moved along its whole outline as there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import ngsolve as ng

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.fluid_pressure import FluidPressure
from ngwear.equilibrium.newton import NewtonOptions
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance, relax
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.meshed import Meshed
from ngwear.materials import NeoHooke
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.builders import QuadBlock, meshed, quarter_ring

INNER, OUTER, SHEAR, STRAIN = 1.0, 2.0, 1.0, 1e-4
SIZE = 0.2
RATIOS = (1e2, 1e3, 1e4, 1e5)
TOLERANCE, GROWTH = 1e-3, 1.1
LINEAR = 4e-2  # the tolerance of displacements of order 1
CUT, ALONG = (0.8, 0.6), 5  # lower left corner of the square, 1 mm from the axis, and elements along its side
TIGHT = StepOptions(newton=NewtonOptions(tolerance=1e-11))


def displacement_error(ratio: float, order: int = 2) -> float:
    """Relative L2 error of the displacement for K/G = ``ratio``."""
    a, b = INNER, OUTER
    factor, _ = _lame(ratio)
    fluid = FluidPressure(("bore",), ("bore",), ())
    supports = [FixedEdges(("along x",), x=False), FixedEdges(("along y",), y=False)]
    body, terms = meshed(quarter_ring(a, b), SIZE), [_elasticity(ratio, order), fluid]
    problem = Problem(body, PlaneStrain(), terms, supports=supports, order=order)
    advance(problem, {"fluid pressure [MPa]": factor * (b**2 - a**2) / a**2}, TIGHT)
    return _relative(problem, ratio)


def cut_error(ratio: float, body: Meshed) -> float:
    """The same for a part of the ring whose outline, all of it, is moved as there."""
    problem = Problem(body, PlaneStrain(), [_elasticity(ratio)], supports=[FixedEdges(body.region_names)])
    _, exact = _lame(ratio)
    problem.fields[DISPLACEMENT].Set(exact, definedon=body.boundary(body.region_names))
    relax(problem, TIGHT)
    return _relative(problem, ratio)


def _elasticity(ratio: float, order: int = 2) -> Elasticity:
    return Elasticity(NeoHooke(shear=SHEAR, bulk_modulus=ratio * SHEAR), order=order)


def _lame(ratio: float) -> tuple[float, ng.CoefficientFunction]:
    """``p a^2 / (b^2 - a^2)`` [MPa] and the displacement."""
    a, b = INNER, OUTER
    uniform, shearing = 1 / (2 * (ratio * SHEAR + SHEAR / 3)), b**2 / (2 * SHEAR)
    factor = STRAIN * a / (uniform * a + shearing / a)
    radius2 = ng.x**2 + ng.y**2
    return factor, factor * (uniform + shearing / radius2) * ng.CF((ng.x, ng.y))


def _relative(problem: Problem, ratio: float) -> float:
    _, exact = _lame(ratio)
    off = problem.fields[DISPLACEMENT] - exact
    measure, mesh = ng.dx(bonus_intorder=4), problem.body.mesh
    return math.sqrt(ng.Integrate(off * off * measure, mesh) / ng.Integrate(exact * exact * measure, mesh))


def run() -> list[Check]:
    """The error for each K/G, and how much it grows from the softest to the stiffest."""
    square = QuadBlock(*CUT, ALONG)
    checks = [*_checks("", displacement_error), *_checks(", quadrilaterals", lambda ratio: cut_error(ratio, square))]
    for order in (1, 3):
        checks += _checks(f", order {order}", partial(displacement_error, order=order), order)
    return checks


def _checks(kind: str, error_at: Callable[[float], float], order: int = 2) -> list[Check]:
    checks, errors = [], []
    total = Stopwatch()
    for ratio in RATIOS:
        clock = Stopwatch()
        errors.append(error_at(ratio))
        name = f"relative L2 error of the displacement at K/G = {ratio:.0e}{kind} [-]"
        checks.append(Check("locking", name, errors[-1], 0.0, LINEAR if order == 1 else TOLERANCE, clock.seconds))
    name = f"error at K/G = {RATIOS[-1]:.0e} over that at {RATIOS[0]:.0e}{kind} [-]"
    checks.append(Check("locking", name, errors[-1] / errors[0], GROWTH, 0.0, total.seconds, bound="below"))
    return checks
