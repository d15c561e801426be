"""Heating of counter-surfaces over the program without cooling."""

from __future__ import annotations

import math

import numpy as np

from ngwear.explanation import heat
from ngwear.explanation.assumptions import Assumed
from ngwear.explanation.contact_pressures import Strip
from ngwear.scene.scene import Scene
from ngwear.surfaces import Cylinder, Plane


def warming(scene: Scene, strips: list[Strip], assumed: Assumed) -> float:
    """Temperature rise of a counter-surface over the program without cooling, with all frictional heat [K].

    The heat is spread over the volume that conduction reaches in that time: to the same depth below the surface (a
    shaft or rod at most to its axis), and as far beyond the ends of the rubbed length. It is 0 for a plane that slides
    in one direction only, because it enters the contact cold. Cooling by air, oil and housing is neglected: an upper
    bound.

    Parameters
    ----------
    scene : Scene
        With a speed in every stroke.
    strips : list of Strip
        Zones of one contact in all kinds of stroke.
    assumed : Assumed
    """
    spec, program = strips[0].contact, scene.program
    depth = heat.reach(program.duration, assumed.counter_diffusivity)
    places = np.cumsum([0.0, *(s.direction * s.travel for s in program.cycle)])
    turns = len({math.copysign(1.0, s.direction) for s in program.cycle}) > 1
    if isinstance(spec.surface, Cylinder):
        volume = _ring(spec.surface.radius, depth)
    elif not isinstance(spec.surface, Plane) or not turns or program.strokes == 0:
        return 0.0
    else:
        along = [strip.place[0] for strip in strips]
        length = float(np.ptp(places)) + max(along) - min(along) + 2 * depth
        rod = scene.axisymmetric and spec.surface.normal_vector[1] > 0
        section = _ring(spec.surface.point[1], depth) if rod else depth
        if scene.axisymmetric and not rod:
            section = math.pi * ((spec.surface.point[1] + depth) ** 2 - spec.surface.point[1] ** 2)
        volume = length * section
    return heat.uncooled_rise(rubbed(scene, strips), volume, assumed.counter_heat_capacity) if volume > 0 else 0.0


def rubbed(scene: Scene, strips: list[Strip]) -> float:
    """Frictional heat of one contact over the program, with the pressure of the unworn part [mJ, or mJ/mm]."""
    program, law, total = scene.program, strips[0].contact.friction_law, 0.0
    end = program.slid(program.strokes)
    for stroke in program.cycle:
        same = (stroke.direction, stroke.pressure, stroke.speed)
        alike = [s for s in strips if (s.stroke.direction, s.stroke.pressure, s.stroke.speed) == same]
        load = sum(s.load * (2 * math.pi * s.place[1] if scene.axisymmetric else 1.0) for s in alike)
        mu = law.curve(stroke.speed).mean(0.0, end) if law is not None and end > 0 else 0.0
        total += mu * load * stroke.travel * program.strokes / len(program.cycle)
    return total


def _ring(radius: float, depth: float) -> float:
    """Area of the outer ring of a disc with this depth [mm²]."""
    return math.pi * (radius**2 - max(radius - depth, 0.0) ** 2)
