"""The sheet of P1a under a roller that slides at F = 4 N/mm, force controlled, full sliding, friction ramped up.

Plane strain sheet 20 x 2 mm, bottom bonded, rigid cylinder R = 5 mm, C10 = 0.6, C01 = 0.15, K = 1000 MPa; the force
is that of pressure and friction together. No closed form: indentation and tangential force at mu = 0.3, 0.5, 0.7 and 1
on elements of 0.1 and 0.05 mm against 0.025 mm.

At mu = 1 the margin of steady sliding (see ``Ripples``) is a little below 0: such sliding would not stay steady. The
steady state is found on every mesh all the same, but its pressure is not quite free of ripples (1.8 G at the most).
"""

from __future__ import annotations

import numpy as np

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.friction import FullSliding
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.surfaces import Cylinder
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.builders import meshed
from ngwear.verify.p1a import RADIUS, RUBBER, THICKNESS, WIDTH

FORCE, FRICTIONS, MESHES = 4.0, (0.3, 0.5, 0.7, 1.0), (0.1, 0.05, 0.025)
BITE = 0.02  # mm: how deep the roller starts, so that it meets a stiffness


class Slider:
    """The sheet on one mesh, pressed without friction at first."""

    def __init__(self, patch: float) -> None:
        along = np.arange(-3.0, 2.5, patch)
        seeds = np.stack([along, np.full(len(along), THICKNESS)], axis=1)
        body = meshed(Outline.rectangle((-WIDTH / 2, WIDTH / 2), (0.0, THICKNESS)), 0.5, seeds, patch)
        roller = Cylinder(centre=(0.0, THICKNESS + RADIUS), radius=RADIUS)
        self.contact = OutlineContact("roller", ("top",), roller, force_controlled=True, modulus=RUBBER.shear_modulus)
        self.friction = FullSliding(self.contact, 1.0)  # times "slip": mu
        terms = [Elasticity(RUBBER), self.contact, self.friction]
        self.problem = Problem(body, PlaneStrain(), terms, supports=[FixedEdges(("bottom",))])
        self.problem.set_loads({"roller slip": 0.0})
        self.problem.fields[self.contact.travel_name].vec[0] = BITE
        advance(self.problem, {"roller force [N]": FORCE}, StepOptions(first=1 / 64))

    def at(self, friction: float) -> tuple[float, float]:
        """Indentation [mm] and tangential force [N/mm]."""
        advance(self.problem, {"roller slip": friction})
        along = self.contact.force()[0] + self.friction.force()[0]
        return float(self.problem.fields[self.contact.travel_name].vec[0]), float(along)

    def ripple(self) -> float:
        """Total variation of the pressure over twice its maximum, less 1 [-]."""
        pressure = self.contact.profile().pressure
        return float(np.abs(np.diff(pressure)).sum() / (2 * pressure.max())) - 1.0


def run() -> list[Check]:
    """Ramp friction up on each mesh; compare with the finest."""
    checks, found, seconds, ripples, margins = [], {}, {}, {}, {}
    for patch in MESHES:
        watch = Stopwatch()
        slider = Slider(patch)
        found[patch] = [slider.at(friction) for friction in FRICTIONS]
        ripples[patch], margins[patch] = slider.ripple(), slider.friction.margin()
        seconds[patch] = watch.seconds
    for patch in MESHES[:-1]:
        for friction, mine, finest in zip(FRICTIONS, found[patch], found[MESHES[-1]], strict=True):
            where = f"mu = {friction}, elements of {patch} mm"
            names = ("indentation [mm]", "tangential force [N/mm]")
            for name, value, reference in zip(names, mine, finest, strict=True):
                checks.append(Check("sliding_roller", f"{where}: {name}", value, reference, 0.005, seconds[patch]))
    for patch in MESHES:
        where = f"mu = {FRICTIONS[-1]}, elements of {patch} mm"
        for name, value, bound in (
            ("ripple of the pressure [-]", ripples[patch], 0.03),
            ("margin [-]", margins[patch], 0.0),
        ):
            checks.append(Check("sliding_roller", f"{where}: {name}", value, bound, 0.0, seconds[patch], bound="below"))
    return checks
