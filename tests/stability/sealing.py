"""Rings on rods and under pressure, a part that nothing holds, the shipped seal's pressure turned round at once."""

from dataclasses import replace
from functools import partial

import numpy as np
from case import Case
from physics import Finding, body, near, pressure

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.fluid_pressure import FluidPressure
from ngwear.effects.friction import FullSliding
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.fields.kinematics import Axisymmetric, PlaneStrain
from ngwear.geometry.body import Body
from ngwear.geometry.outline import Outline
from ngwear.loop.mounting import mount
from ngwear.loop.refinement import mounting_field
from ngwear.loop.stage import Stage
from ngwear.loop.stepper import Stepper
from ngwear.materials import MooneyRivlin
from ngwear.scene.accuracy import Accuracy
from ngwear.surfaces import Plane, rod
from ngwear.verify import extrusion_gap, ring
from ngwear.verify.builders import mean, meshed
from ngwear.verify.closed_forms import expanding_pressure
from ngwear.verify.rod_seal import imbalance, shipped_scene

RUBBER = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1.5e6)
PRESS = "fluid pressure [MPa]"
GAPS, ROUNDED = (0.05, 0.1, 0.2, 0.3), 0.05  # mm


def on_rod(interference, mu) -> list[Finding]:
    """A ring on a rod that expands its bore; the closed form has no friction."""
    shaft = OutlineContact("rod", ("bottom",), rod(2 * ring.INNER), modulus=RUBBER.shear_modulus)
    terms = [Elasticity(RUBBER), shaft] + ([FullSliding(shaft, mu)] if mu else [])
    outline = Outline.rectangle((0.0, ring.LENGTH), (ring.INNER, ring.OUTER))
    held = FixedEdges(("left", "right"), y=False)
    problem = Problem(meshed(outline, ring.SIZE), Axisymmetric(), terms, supports=[held])
    grown = interference * ring.INNER
    advance(problem, {"rod approach [mm]": grown})
    expected = expanding_pressure(RUBBER.shear_modulus, ring.INNER, ring.OUTER, ring.INNER + grown)
    found = float(shaft.force()[1]) / (2 * np.pi * (ring.INNER + grown) * ring.LENGTH)
    return [*body(problem), *pressure(shaft), near("pressure on the rod", found, expected, 1e-4)]


def turned_round(first, second) -> list[Finding]:
    """Pressure in a ring's bore that goes to another one, through zero if it pulls, in one step and back."""
    problem = ring._problem(RUBBER, FluidPressure(("bottom",), ("bottom",), ()))
    found, seen = [], []
    for load in (first, second, first):
        advance(problem, {PRESS: load}, StepOptions(first=1.0))
        seen.append(mean(problem.fields[DISPLACEMENT][1], problem.body, "bottom"))
        if load == 0:
            found.append(Finding("bore left [mm]", abs(seen[-1]), 1e-9))
            continue
        found += body(problem)
        expected = expanding_pressure(RUBBER.shear_modulus, ring.INNER, ring.OUTER, ring.INNER + seen[-1])
        found.append(Finding("error of the pressure over G", abs(expected - load) / RUBBER.shear_modulus, 1e-3))
    return [*found, near("bore back again", seen[2], seen[0], 1e-6)]


def seal_turned_round(pressure_on) -> list[Finding]:
    """The shipped seal, mounted: its outward stroke, and the inward one under pressure, each in a single step."""
    scene = shipped_scene()
    outward, inward = scene.program.cycle
    inward = replace(inward, pressure=pressure_on)
    stage = Stage(scene, Body(scene.part.outline, mounting_field(scene)))
    mount(stage, lambda _: None)
    found, lips = [], []
    for stroke in (outward, inward, outward, inward):
        advance(stage.problem, stage.stroke_loads(stroke), StepOptions(first=1.0))
        rod = stage.contacts["rod"]
        found += [
            *body(stage.problem),
            *pressure(rod),
            Finding("forces out of balance", imbalance(stage.forces()), 1e-6),
        ]
        found.append(Finding("leaks", float(any(fluid.leaks for fluid in stage.fluids.values())), 0.0))
        lips.append(abs(float(rod.force()[1])))
    found.append(near("force on the rod, outward again", lips[2], lips[0], 1e-4))
    found.append(near("force on the rod, inward again", lips[3], lips[1], 1e-4))
    return found


def extruded(gap, ratio) -> list[Finding]:
    """A block pressed against a wall with a gap, into which it comes."""
    pressure_on, half = ratio * extrusion_gap.MODULUS, 1.0
    scene = extrusion_gap.scene(
        gap / 2, ROUNDED, half=half, pressure=pressure_on, accuracy=Accuracy.preset("engineering")
    )
    stage = Stepper(scene).start().stage
    wall = stage.contacts["wall"]
    return [*body(stage.problem), near("force on the wall", -float(wall.force()[1]), pressure_on * half, 1e-3)]


def unheld(held, mu) -> list[Finding]:
    """A block under a lid that a force presses on, and something that does not hold it."""
    body_ = meshed(Outline.rectangle((0.0, 2.0), (0.0, 1.0)), 0.5)
    lid = Plane(point=(0.0, 1.0), normal_vector=(0.0, -1.0))
    contact = OutlineContact("lid", ("top",), lid, modulus=1.5, force_controlled=True)
    terms = [Elasticity(RUBBER), contact] + ([FullSliding(contact, mu)] if mu else [])
    problem = Problem(body_, PlaneStrain(), terms, supports=held)
    problem.fields[contact.travel_name].vec[0] = 1e-3
    advance(problem, {"lid force [N]": 0.5})
    return [*body(problem), *pressure(contact)]


def cases() -> list[Case]:
    """Every case of this file."""
    found = [Case("interference", f"{100 * x:g} %", partial(on_rod, x, 0.0)) for x in (0.02, 0.05, 0.1, 0.15, 0.3)]
    found += [Case("interference", f"{100 * x:g} %, mu 0.3", partial(on_rod, x, 0.3)) for x in (0.02, 0.15)]
    turns = ((0.2, 0.0), (0.2, -0.2), (0.4, -0.4), (0.4, 0.2))
    found += [
        Case("pressure turned round in a step", f"{a:g} to {b:g} MPa", partial(turned_round, a, b)) for a, b in turns
    ]
    seal = "the shipped seal turned round in a step"
    found += [Case(seal, f"0 to {p:g} MPa and friction reversed", partial(seal_turned_round, p)) for p in (0.5, 2.0)]
    found += [
        Case("extrusion gap", f"{gap:g} mm, p/G {ratio:g}", partial(extruded, gap, ratio))
        for gap in GAPS
        for ratio in (1, 3)
    ]
    found += [
        Case(
            "extrusion gap",
            f"{gap:g} mm, p/G 20",
            partial(extruded, gap, 20),
            "folds the surface|the part touches itself" if gap > 0.05 else "",
        )
        for gap in GAPS
    ]
    bottom = [FixedEdges(("bottom",))]
    found += [
        Case(
            "nothing holds the part",
            "no support",
            partial(unheld, [], 0.0),
            "nothing holds the part along x and along y",
        ),
        Case(
            "nothing holds the part",
            "free along",
            partial(unheld, [FixedEdges(("bottom",), x=False)], 0.3),
            "the part along x:",
        ),
        Case(
            "nothing holds the part",
            "free across",
            partial(unheld, [FixedEdges(("bottom",), y=False)], 0.0),
            "the part along y:",
        ),
        Case("nothing holds the part", "held", partial(unheld, bottom, 0.3)),
    ]
    return found
