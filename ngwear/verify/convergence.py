"""Order of convergence of displacements of order 2 with pressures of order 1, at finite strain.

Quarter of a ring (a = 1 mm, b = 2 mm, plane strain) whose bore a follower pressure expands by 20 %;
incompressible Mooney-Rivlin (C10 = 0.6, C01 = 0.15 MPa; K/G = 1e8). The exact solution keeps areas,
``r^2 = R^2 + r_a^2 - a^2``; its pressure is ``closed_forms.expanding_pressure``. Elements of order 2 on a curved
outline shall converge with h^3 in the displacement's L2 norm (Taylor & Hood 1973); the observed order is
``log2`` of the error's ratio when the elements are halved.
"""

from __future__ import annotations

import math

import ngsolve as ng

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.fluid_pressure import FluidPressure
from ngwear.equilibrium.newton import NewtonOptions
from ngwear.equilibrium.problem import Problem, Support
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.fields.kinematics import PlaneStrain
from ngwear.materials import MooneyRivlin
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.builders import meshed, quarter_ring
from ngwear.verify.closed_forms import expanding_pressure

INNER, OUTER, EXPANDED = 1.0, 2.0, 1.2
RUBBER = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1.5e8)
SIZES = (0.4, 0.2, 0.1, 0.05)
LEAST_ORDER = 2.8


def displacement_error(size: float) -> float:
    """L2 norm of the displacement's error over that of the displacement with elements of ``size`` [mm]."""
    body = meshed(quarter_ring(INNER, OUTER), size)
    pressure = expanding_pressure(RUBBER.shear_modulus, INNER, OUTER, EXPANDED)
    fluid = FluidPressure(("bore",), ("bore",), ())
    supports = [Support(("along x",), x=False), Support(("along y",), y=False)]
    problem = Problem(body, PlaneStrain(), [Elasticity(RUBBER), fluid], supports=supports)
    advance(problem, {"fluid pressure [MPa]": pressure}, StepOptions(newton=NewtonOptions(tolerance=1e-9)))
    radius = ng.sqrt(ng.x**2 + ng.y**2)
    factor = ng.sqrt(radius**2 + EXPANDED**2 - INNER**2) / radius - 1
    exact = ng.CF((factor * ng.x, factor * ng.y))
    off = problem.fields[DISPLACEMENT] - exact
    measure = ng.dx(bonus_intorder=4)
    return math.sqrt(ng.Integrate(off * off * measure, body.mesh) / ng.Integrate(exact * exact * measure, body.mesh))


def run() -> list[Check]:
    """Observed order between each two meshes."""
    checks, last = [], math.nan
    for size in SIZES:
        clock = Stopwatch()
        error = displacement_error(size)
        if not math.isnan(last):
            checks.append(
                Check(
                    "convergence",
                    f"order of the displacement's L2 error, h = {2 * size:g} to {size:g} mm [-]",
                    math.log2(last / error),
                    LEAST_ORDER,
                    0.0,
                    clock.seconds,
                    bound="above",
                )
            )
        last = error
    return checks
