"""Order of convergence of displacements of order 2 with pressures of order 1, at finite strain.

Quarter of a ring (a = 1 mm, b = 2 mm, plane strain) whose bore a follower pressure expands by 20 %;
incompressible Mooney-Rivlin (C10 = 0.6, C01 = 0.15 MPa; K/G = 1e8). The exact solution keeps areas,
``r^2 = R^2 + r_a^2 - a^2``; its pressure is ``closed_forms.expanding_pressure``. Elements of order 2 on a curved
outline shall converge with h^3 in the displacement's L2 norm (Taylor & Hood 1973); the observed order is
``log2`` of the error's ratio when the elements are halved.

Tetrahedra: a block of 2 mm whose whole surface is twisted about its axis by 0.1 rad/mm. Torsion is in equilibrium in
every incompressible isotropic material (Ericksen, Z. Angew. Math. Phys. 5 (1954) 466), so that the inside must twist
along.

Quadrilaterals: a square with straight sides, cut out of the expanding ring and moved along its whole outline as there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.fluid_pressure import FluidPressure
from ngwear.equilibrium.newton import NewtonOptions
from ngwear.equilibrium.problem import Problem, Support
from ngwear.equilibrium.stepping import StepOptions, advance, relax
from ngwear.fields.kinematics import PlaneStrain, Solid
from ngwear.geometry.meshed import Meshed
from ngwear.geometry.sheet import Sheet
from ngwear.materials import MooneyRivlin
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.builders import QuadBlock, meshed, quarter_ring
from ngwear.verify.closed_forms import expanding_pressure

INNER, OUTER, EXPANDED = 1.0, 2.0, 1.2
RUBBER = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1.5e8)
# Whose volume the boundary's interpolation fixes as well: K/G = 1e5.
TWISTED = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1.5e5)
SIZES = (0.4, 0.2, 0.1, 0.05)
SOLID_SIZES = (1.0, 0.5, 0.25)
QUAD_SIZES = (0.25, 0.125, 0.0625)
CUT = (0.8, 0.6)  # lower left corner of the square, 1 mm from the axis
TWIST = 0.1  # rad/mm
LEAST_ORDER = 2.8


def displacement_error(size: float) -> float:
    """L2 norm of the displacement's error over that of the displacement with elements of ``size`` [mm]."""
    body = meshed(quarter_ring(INNER, OUTER), size)
    pressure = expanding_pressure(RUBBER.shear_modulus, INNER, OUTER, EXPANDED)
    fluid = FluidPressure(("bore",), ("bore",), ())
    supports = [Support(("along x",), x=False), Support(("along y",), y=False)]
    problem = Problem(body, PlaneStrain(), [Elasticity(RUBBER), fluid], supports=supports)
    advance(problem, {"fluid pressure [MPa]": pressure}, StepOptions(newton=NewtonOptions(tolerance=1e-9)))
    return _relative(problem.fields[DISPLACEMENT] - _expanded(), _expanded(), body)


def cut_error(body: Meshed) -> float:
    """The same for a part of the ring whose outline, all of it, is moved as there."""
    problem = Problem(body, PlaneStrain(), [Elasticity(TWISTED)], supports=[Support(body.region_names)])
    field, exact = problem.fields[DISPLACEMENT], _expanded()
    places = body.node_places()
    body.set_nodal(field, _growth((places**2).sum(axis=1, keepdims=True)) * places)
    relax(problem, StepOptions(newton=NewtonOptions(tolerance=1e-9)))
    return _relative(field - exact, exact, body)


def torsion_error(size: float) -> float:
    """The same for a twisted block of tetrahedra of ``size`` [mm]."""
    nowhere = np.empty((0, 3))
    sheet = {"thickness": 2.0, "track_radius": math.inf, "reach": 1.0, "beside": 1.0}
    body = Sheet(**sheet, seeds=nowhere, sizes=nowhere[:, 0], coarse=size)
    supports = [Support(("bottom", "top", "side"))]
    problem = Problem(body, Solid(), [Elasticity(TWISTED)], supports=supports)
    angle = TWIST * ng.z
    turned = (ng.x * ng.cos(angle) - ng.y * ng.sin(angle), ng.x * ng.sin(angle) + ng.y * ng.cos(angle))
    exact = ng.CF((turned[0] - ng.x, turned[1] - ng.y, 0))
    field = problem.fields[DISPLACEMENT]
    field.Set(exact, definedon=body.boundary(("bottom", "top", "side")))
    relax(problem, StepOptions(newton=NewtonOptions(tolerance=1e-9)))
    return _relative(field - exact, exact, body)


def _growth(radius2: Any) -> Any:
    """Radial displacement of the ring over the radius."""
    return (1 + (EXPANDED**2 - INNER**2) / radius2) ** 0.5 - 1


def _expanded() -> ng.CoefficientFunction:
    """Displacement of the ring."""
    return _growth(ng.x**2 + ng.y**2) * ng.CF((ng.x, ng.y))


def _relative(off: ng.CoefficientFunction, exact: ng.CoefficientFunction, body: Meshed) -> float:
    measure = ng.dx(bonus_intorder=4)
    return math.sqrt(ng.Integrate(off * off * measure, body.mesh) / ng.Integrate(exact * exact * measure, body.mesh))


def run() -> list[Check]:
    """Observed order between each two meshes."""
    return [
        *_orders("section", displacement_error, SIZES),
        *_orders("solid", torsion_error, SOLID_SIZES),
        *_orders("quadrilaterals", lambda size: cut_error(QuadBlock(*CUT, round(1 / size))), QUAD_SIZES),
    ]


def _orders(kind: str, error_at: Callable[[float], float], sizes: tuple[float, ...]) -> list[Check]:
    checks, last = [], math.nan
    for size in sizes:
        clock = Stopwatch()
        error = error_at(size)
        if not math.isnan(last):
            checks.append(
                Check(
                    "convergence",
                    f"order of the displacement's L2 error, {kind}, h = {2 * size:g} to {size:g} mm [-]",
                    math.log2(last / error),
                    LEAST_ORDER,
                    0.0,
                    clock.seconds,
                    bound="above",
                )
            )
        last = error
    return checks
