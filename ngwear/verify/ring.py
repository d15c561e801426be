"""A long thick-walled ring, axisymmetric: under pressure in its bore, and on a rigid rod.

Bore radius a = 5 mm, outside b = 10 mm, a slice of 2 mm with its faces held axially (plane strain along
the axis), no friction. Displacements in mm, pressures in MPa.

- Small strain, E = 10 MPa, nu = 0.4: Lamé (Timoshenko & Goodier, *Theory of Elasticity*, section 28),
  ``u(a) = (1 + nu) p a ((1 - 2 nu) a^2 + b^2) / (E (b^2 - a^2))``; the pressure gives the bore's
  displacement, a rod of radius a + u(a) gives the contact pressure.
- Large strain, incompressible Mooney-Rivlin (C10 = 0.6, C01 = 0.15; K/G = 1e6), bore expanded to 1.2 a:
  ``closed_forms.expanding_pressure``. Under fluid pressure the bore's displacement is compared, on the rod
  the contact pressure.
"""

from __future__ import annotations

import math

from ngwear.effects.base import DISPLACEMENT, Term
from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.fluid_pressure import FluidPressure
from ngwear.equilibrium.newton import NewtonOptions
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.fields.kinematics import Axisymmetric
from ngwear.geometry.outline import Outline
from ngwear.materials import Hyperelastic, MooneyRivlin, NeoHooke
from ngwear.surfaces import rod
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.builders import mean, meshed
from ngwear.verify.closed_forms import expanding_pressure

INNER, OUTER, LENGTH = 5.0, 10.0, 2.0
TOLERANCE = 1e-3
SIZE = 0.5
STEPS = StepOptions(newton=NewtonOptions(tolerance=1e-9))


def lame_compliance(material: Hyperelastic) -> float:
    """Displacement of the bore over the pressure in it at small strain, plane strain [mm/MPa]."""
    a, b, nu = INNER, OUTER, material.poisson_ratio
    return (1 + nu) * a * ((1 - 2 * nu) * a**2 + b**2) / (material.young_modulus * (b**2 - a**2))


def _problem(material: Hyperelastic, load: Term) -> Problem:
    body = meshed(Outline.rectangle((0.0, LENGTH), (INNER, OUTER)), SIZE)
    held = FixedEdges(("left", "right"), y=False)
    return Problem(body, Axisymmetric(), [Elasticity(material), load], supports=[held])


def pressurised(material: Hyperelastic, pressure: float) -> float:
    """Mean radial displacement of the bore under fluid pressure [mm]."""
    problem = _problem(material, FluidPressure(("bottom",), ("bottom",), ()))
    advance(problem, {"fluid pressure [MPa]": pressure}, STEPS)
    return mean(problem.fields[DISPLACEMENT][1], problem.body, "bottom")


def on_rod(material: Hyperelastic, displacement: float) -> tuple[float, float]:
    """Mean and largest Cauchy contact pressure on a rod that expands the bore by ``displacement`` [MPa]."""
    contact = OutlineContact("rod", ("bottom",), rod(2 * INNER), modulus=material.shear_modulus)
    problem = _problem(material, contact)
    advance(problem, {"rod approach [mm]": displacement}, STEPS)
    # The rod's surface: 2 pi times its radius times the length.
    area = 2 * math.pi * (INNER + displacement) * LENGTH
    return float(contact.force()[1]) / area, contact.profile().pressure.max()


def run() -> list[Check]:
    """Pressure and rod, at small strain and at 20 %."""
    checks: list[Check] = []
    clock = Stopwatch()

    def add(quantity: str, value: float, reference: float) -> None:
        checks.append(Check("ring", quantity, value, reference, TOLERANCE, clock.seconds))

    soft, slight = NeoHooke.from_young(10.0, 0.4), 1e-5 * INNER
    pressure = slight / lame_compliance(soft)
    add("bore displacement under pressure, small strain [mm]", pressurised(soft, pressure), slight)
    clock.start()
    average, peak = on_rod(soft, slight)
    add("mean contact pressure on the rod, small strain [MPa]", average, pressure)
    add("peak contact pressure on the rod, small strain [MPa]", peak, pressure)

    rubber, large = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1.5e6), 0.2 * INNER
    pressure = expanding_pressure(rubber.shear_modulus, INNER, OUTER, INNER + large)
    clock.start()
    add("bore displacement under pressure, 20 % [mm]", pressurised(rubber, pressure), large)
    clock.start()
    average, peak = on_rod(rubber, large)
    add("mean contact pressure on the rod, 20 % [MPa]", average, pressure)
    add("peak contact pressure on the rod, 20 % [MPa]", peak, pressure)
    return checks
