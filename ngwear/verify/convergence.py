"""Order of convergence of displacements of orders 1, 2 and 3, at finite strain.

Quarter of a ring (a = 1 mm, b = 2 mm, plane strain) whose bore a follower pressure expands by 20 %;
incompressible Mooney-Rivlin (C10 = 0.6, C01 = 0.15 MPa; K/G = 1e8). The exact solution keeps areas,
``r^2 = R^2 + r_a^2 - a^2``; its pressure is ``closed_forms.expanding_pressure``. Elements of order k on a curved
outline shall converge with h^(k+1) in the L2 norm of the displacement and with h^k in that of its gradient (Taylor &
Hood 1973; Arnold, Brezzi & Fortin 1984 for order 1); the observed order is ``log2`` of the error's ratio when the
elements are halved.

Tetrahedra: a block of 2 mm whose whole surface is twisted about its axis by 0.1 rad/mm. Torsion is in equilibrium in
every incompressible isotropic material (Ericksen, Z. Angew. Math. Phys. 5 (1954) 466), so that the inside must twist
along.

Quadrilaterals: a square with straight sides, cut out of the expanding ring and moved along its whole outline as there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.fluid_pressure import FluidPressure
from ngwear.equilibrium.newton import NewtonOptions
from ngwear.equilibrium.problem import FixedEdges, Problem
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
ORDERS = {1: SIZES[1:], 3: SIZES[:3]}  # meshes for displacements of other orders
LEAST_ORDER = 2.8  # of order 2; of order k as much more or less


def ring_errors(size: float, order: int = 2) -> tuple[float, float]:
    """L2 norm of the error of the displacement, and of its gradient, over that of either; elements of ``size`` [mm]."""
    body = meshed(quarter_ring(INNER, OUTER), size)
    pressure = expanding_pressure(RUBBER.shear_modulus, INNER, OUTER, EXPANDED)
    fluid = FluidPressure(("bore",), ("bore",), ())
    supports = [FixedEdges(("along x",), x=False), FixedEdges(("along y",), y=False)]
    problem = Problem(body, PlaneStrain(), [Elasticity(RUBBER, order=order), fluid], supports=supports, order=order)
    advance(problem, {"fluid pressure [MPa]": pressure}, StepOptions(newton=NewtonOptions(tolerance=1e-9)))
    field, exact, slope = problem.fields[DISPLACEMENT], _expanded(), _expanded_gradient()
    return _relative(field - exact, exact, body), _relative(ng.Grad(field) - slope, slope, body)


def cut_error(body: Meshed) -> float:
    """The same for a part of the ring whose outline, all of it, is moved as there."""
    problem = Problem(body, PlaneStrain(), [Elasticity(TWISTED)], supports=[FixedEdges(body.region_names)])
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
    supports = [FixedEdges(("bottom", "top", "side"))]
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


def _expanded_gradient() -> ng.CoefficientFunction:
    """Its gradient."""
    r2, place = ng.x**2 + ng.y**2, ng.CF((ng.x, ng.y))
    bend = (INNER**2 - EXPANDED**2) / (r2**2 * (1 + _growth(r2)))  # twice the derivative of the growth by r2
    return _growth(r2) * ng.Id(2) + bend * ng.OuterProduct(place, place)


def _relative(off: ng.CoefficientFunction, exact: ng.CoefficientFunction, body: Meshed) -> float:
    measure = ng.dx(bonus_intorder=4)
    squares = [ng.Integrate(ng.InnerProduct(f, f) * measure, body.mesh) for f in (off, exact)]
    return math.sqrt(squares[0] / squares[1])


def run() -> list[Check]:
    """Observed order between each two meshes."""
    checks = _orders("section", ring_errors, SIZES)
    checks += _orders("solid", lambda size: (torsion_error(size),), SOLID_SIZES)
    checks += _orders("quadrilaterals", lambda size: (cut_error(QuadBlock(*CUT, round(1 / size))),), QUAD_SIZES)
    for k, sizes in ORDERS.items():
        checks += _orders(f"section of order {k}", partial(ring_errors, order=k), sizes, LEAST_ORDER + k - 2)
    return checks


def _orders(
    kind: str, error_at: Callable[[float], tuple[float, ...]], sizes: tuple[float, ...], least: float = LEAST_ORDER
) -> list[Check]:
    """Orders of the displacement's error, and of its gradient's if there is one, one less."""
    checks: list[Check] = []
    last: tuple[float, ...] = ()
    for size in sizes:
        clock = Stopwatch()
        errors = error_at(size)
        for i, (before, error) in enumerate(zip(last, errors, strict=False)):
            of = ("displacement's", "displacement gradient's")[i]
            name = f"order of the {of} L2 error, {kind}, h = {2 * size:g} to {size:g} mm [-]"
            order = math.log2(before / error)
            checks.append(Check("convergence", name, order, least - i, 0.0, clock.seconds, bound="above"))
        last = errors
    return checks
