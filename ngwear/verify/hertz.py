"""Hertz's line contact: a rigid cylinder on an elastic half-plane, frictionless, under a small load.

Plane strain, E = 1 MPa, nu = 0.3, R = 250 mm; the load per mm of thickness P' is that of a half width
a = 1 mm, so that strains stay near p0/E* = a/(2R) = 0.2 %. Half of a block of 200 x 100 mm (symmetric,
bottom bonded) stands for the half-plane. Reference (Johnson, *Contact Mechanics*, section 4.2), with
E* = E/(1 - nu^2): ``a = sqrt(4 P' R / (pi E*))`` [mm], ``p0 = 2 P' / (pi a)`` [MPa] and
``p = p0 sqrt(1 - x^2/a^2)``, compared at the nodes with |x| < 0.95 a.

Displacements of order 2, and of orders 1 and 3 on meshes that bring them to about the same error: of order 1 the
elements below the contact must grow more slowly, or the width is 1.1 % off and the ellipse 2.3 %, even on edges of
a/100.
"""

from __future__ import annotations

import math

import numpy as np

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.equilibrium.newton import NewtonOptions
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.materials import NeoHooke
from ngwear.surfaces import Cylinder
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.builders import meshed

MATERIAL = NeoHooke.from_young(1.0, 0.3)
RADIUS, HALF_WIDTH, BLOCK = 250.0, 1.0, 100.0
COARSE = 20.0
MESHES = {2: (0.01, 0.25), 1: (0.02, 0.05), 3: (0.04, 0.25)}  # by order: element edge in the contact [mm], grading
TOLERANCE = 5e-3


def run() -> list[Check]:
    """Half width, peak and shape of the pressure under a given load."""
    return [check for order in MESHES for check in _pressed(order)]


def _pressed(order: int) -> list[Check]:
    size, grading = MESHES[order]
    clock = Stopwatch()
    a, load = HALF_WIDTH, math.pi * MATERIAL.plane_strain_modulus * HALF_WIDTH**2 / (4 * RADIUS)
    p0 = 2 * load / (math.pi * a)

    at = np.arange(0.0, 1.1 * a, size)
    seeds = np.stack([at, np.full(len(at), BLOCK)], axis=1)
    body = meshed(Outline.rectangle((0.0, BLOCK), (0.0, BLOCK)), COARSE, seeds, size, grading)
    cylinder = Cylinder(centre=(0.0, BLOCK + RADIUS), radius=RADIUS)
    modulus = MATERIAL.shear_modulus
    contact = OutlineContact("cylinder", ("top",), cylinder, force_controlled=True, modulus=modulus, order=order)
    supports = [FixedEdges(("bottom",)), FixedEdges(("left",), y=False)]
    terms = [Elasticity(MATERIAL, order=order), contact]
    problem = Problem(body, PlaneStrain(), terms, supports=supports, order=order)
    problem.fields[contact.travel_name].vec[0] = a * a / (2 * RADIUS)
    advance(problem, {"cylinder force [N]": load / 2}, StepOptions(newton=NewtonOptions(tolerance=1e-9)))

    profile = contact.profile()
    (zone,) = profile.zones()
    x = profile.place[:, 0]
    inside = x < 0.95 * a
    off = profile.pressure[inside] / p0 - np.sqrt(1 - (x[inside] / a) ** 2)
    seconds, of = clock.seconds, "" if order == 2 else f", order {order}"
    return [
        Check("hertz", f"{quantity}{of} {unit}", value, reference, TOLERANCE, seconds)
        for quantity, unit, value, reference in (
            ("half width", "[mm]", max(zone.start[0], zone.end[0]), a),
            ("peak pressure", "[MPa]", zone.peak, p0),
            ("largest deviation from the ellipse over p0", "[-]", np.abs(off).max(), 0.0),
            ("root mean square deviation over p0", "[-]", math.sqrt(np.mean(off**2)), 0.0),
        )
    ]
