"""A bonded rubber sheet under a rigid cylinder, without friction (problem P1a).

Plane strain sheet 20 x 2 mm, bottom bonded, sides free; cylinder R = 5 mm; Mooney-Rivlin C10 = 0.6,
C01 = 0.15, K = 1000 MPa; half of it by symmetry. Forces F are N per mm of thickness of the whole sheet,
a is half the distance between the deformed ends of the contact [mm], p the peak Cauchy pressure [MPa].

References: the limit of fine meshes, cross-checked between four programs (FElupe, GetFEM, NGSolve, Kratos; the half
widths by FElupe and fine meshes of ngwear): F = 5.3572 +- 0.0005 N/mm, a = 1.756 +- 0.002 mm, p = 2.039 +- 0.002 MPa at
an indentation of d = 0.30 mm; d = 0.2538 +- 0.0001 mm, a = 1.582 +- 0.002 mm, p = 1.671 +- 0.003 MPa at F = 4 N/mm.
FElupe alone, on quads of 0.01 mm, has a = 1.7563 and 1.5825 mm (``tests/benchmarks/p1a_felupe_edge.py``).

A tolerance is what the reference may be off by and what this mesh is off by: with a third of all edges, half at the
contact's end, F is 0.0003 N/mm less, the half widths are 0.0001 mm more, the peaks 0.0007 MPa more. Half widths are
read between nodes, where the gap comes to zero.
"""

from __future__ import annotations

import numpy as np

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import advance, relax
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.materials import MooneyRivlin
from ngwear.surfaces import Cylinder
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.builders import meshed

THICKNESS, WIDTH, RADIUS = 2.0, 20.0, 5.0
RUBBER = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1000.0)
COARSE, PATCH, EDGE = 0.35, 0.1, 0.005


def sheet(*, force_controlled: bool, edge: float) -> tuple[Problem, OutlineContact]:
    """Half sheet and cylinder, just touching; finest around ``edge``, the undeformed place of the contact's end."""
    patch, ends = np.arange(0.0, 2.0, PATCH), np.arange(edge - 0.04, edge + 0.04, EDGE)
    at = np.concatenate([patch, ends])
    size = np.repeat([PATCH, EDGE], [len(patch), len(ends)])
    seeds = np.stack([at, np.full(len(at), THICKNESS)], axis=1)
    body = meshed(Outline.rectangle((0.0, WIDTH / 2), (0.0, THICKNESS)), COARSE, seeds, size)
    cylinder = Cylinder(centre=(0.0, THICKNESS + RADIUS), radius=RADIUS)
    contact = OutlineContact(
        "roller", ("top",), cylinder, force_controlled=force_controlled, modulus=RUBBER.shear_modulus
    )
    supports = [FixedEdges(("bottom",)), FixedEdges(("left",), y=False)]
    return Problem(body, PlaneStrain(), [Elasticity(RUBBER), contact], supports=supports), contact


def width_and_peak(contact: OutlineContact) -> tuple[float, float]:
    """Half width [mm] and largest Cauchy pressure [MPa]."""
    (zone,) = contact.profile().zones()
    return max(zone.start[0], zone.end[0]), zone.peak


def run() -> list[Check]:
    """Indentation given, then force given."""
    checks: list[Check] = []
    clock = Stopwatch()

    def add(quantity: str, value: float, reference: float, *, uncertain: float, mesh: float) -> None:
        tolerance = uncertain + mesh
        checks.append(Check("p1a", quantity, value, reference, tolerance, clock.seconds, absolute=True))

    problem, contact = sheet(force_controlled=False, edge=1.595)
    advance(problem, {"roller approach [mm]": 0.30})
    half_width, peak = width_and_peak(contact)
    add("force at d = 0.30 mm [N/mm]", -2 * contact.force()[1], 5.3572, uncertain=5e-4, mesh=3e-4)
    add("half width at d = 0.30 mm [mm]", half_width, 1.756, uncertain=2e-3, mesh=1e-4)
    add("half width at d = 0.30 mm, against FElupe's [mm]", half_width, 1.7563, uncertain=2e-3, mesh=1e-4)
    add("peak pressure at d = 0.30 mm [MPa]", peak, 2.039, uncertain=2e-3, mesh=7e-4)

    clock.start()
    problem, contact = sheet(force_controlled=True, edge=1.46)
    travel = problem.fields[contact.travel_name].vec
    travel[0] = 0.25  # any guess that touches: a cylinder under force is free to move until it does
    problem.set_loads({"roller force [N]": 4.0 / 2})
    relax(problem)  # from the overlap at hand
    half_width, peak = width_and_peak(contact)
    add("indentation at F = 4 N/mm [mm]", travel[0], 0.2538, uncertain=1e-4, mesh=1e-5)
    add("half width at F = 4 N/mm [mm]", half_width, 1.582, uncertain=2e-3, mesh=1e-4)
    add("half width at F = 4 N/mm, against FElupe's [mm]", half_width, 1.5825, uncertain=2e-3, mesh=1e-4)
    add("peak pressure at F = 4 N/mm [MPa]", peak, 1.671, uncertain=3e-3, mesh=7e-4)
    return checks
