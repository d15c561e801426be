"""Wear: steps far beyond the explicit limit, gaps, vanishing ridges, sheets worn through, noisy outlines, lips."""

from dataclasses import replace
from functools import partial

import numpy as np
from case import Case
from physics import ROUGHNESS, Finding, body, book, near, pressure

from ngwear.geometry.outline import Outline
from ngwear.loop.stepper import Stepper
from ngwear.materials import NeoHooke
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Support
from ngwear.scene.contact import Contact
from ngwear.scene.options import Wear
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Cylinder, Plane
from ngwear.verify import stability_pair

RUBBER = NeoHooke(shear=1.0, bulk_modulus=1000.0)
WEAR_RATE = 1e-3


class Watched(Stepper):
    """A stepper that measures every equilibrium before its wear moves the outline."""

    def __init__(self, scene: Scene) -> None:
        super().__init__(scene)
        self.found: list[Finding] = []

    def _report(self, state, index, iterations, sliding):
        contact = state.stage.contacts[self.scene.contacts[0].name]
        friction = state.stage.frictions.get(contact.name)
        force = self.scene.contacts[0].force
        self.found += [*body(state.stage.problem), *pressure(contact)]
        if force is not None:
            across = -contact.force()[1] - (friction.force()[1] if friction else 0.0)
            self.found.append(near("force across", across, force, 1e-6))
        return super()._report(state, index, iterations, sliding)


def worn(scene: Scene):
    """Run a scene; the last state and what was found at every equilibrium, and in the books."""
    stepper = Watched(scene)
    state = stepper.start()
    begin = state.contour
    while not stepper.finished(state):
        state = stepper.advance(state)
    return state, [*stepper.found, *book(state.ledger, begin, state.contour)]


def stepped(scheme, times) -> list[Finding]:
    """Wear steps of ``times`` the explicit scheme's critical distance."""
    scene = stability_pair.scene(scheme, times)
    scene = replace(scene, program=replace(scene.program, strokes=12))
    state, found = worn(scene)
    law = (
        stability_pair.WEAR_RATE * 2 * stability_pair.HALF * stability_pair.MEAN * 12 * times * stability_pair.CRITICAL
    )
    found.append(near("worn area", state.ledger.worn, law, 1e-4))
    if scheme == "explicit":
        rough = stability_pair.roughness(state.reports[-1].contacts["plane"]) - 1
        found = [f for f in found if f.what != "roughness"]
        return [*found, Finding("explicit ripple of the pressure", rough, 10 * ROUGHNESS, least=True)]
    return found


def top(points: list[tuple[float, float]], width: float, height: float, *, corners=()) -> Outline:
    """Rectangle from x = 0 whose top, from right to left, runs through points; ``corners`` of them are sharp."""
    outline = [(0.0, 0.0), (width, 0.0), (width, height), *points, (0.0, height)]
    names = ("bottom", "right", *(("top",) * (len(points) + 1)), "left")
    sharp = np.array([True, True, True, *(k in corners for k in range(len(points))), True])
    return Outline(np.array(outline), names, sharp)


def pressed_by(
    surface, contour, *, force, travel, strokes, patch=0.05, rate=WEAR_RATE, mu=0.0, coarse=0.3, **options
) -> Scene:
    """A part, its bottom bonded, under a surface that a force presses on and that slides."""
    contact = Contact(
        name="counter", edges=("top",), surface=surface, force=force, specific_wear_rate=rate, friction=mu, refine=True
    )
    return Scene(
        name="hard",
        part=Part(contour, material=RUBBER),
        contacts=(contact,),
        supports=(Support(edges=("bottom",)),),
        program=Program(cycle=(Stroke(name="stroke", travel=travel),), strokes=strokes),
        accuracy=Accuracy(patch=patch, coarse=coarse, mounting=patch),
        wear=Wear(**({"step": "each"} | options)),
        axisymmetric=False,
    )


def from_a_gap(gap) -> list[Finding]:
    """A roller that hovers above the sheet and is pressed on: the same equilibrium as from touch."""
    forces = []
    for away in (0.0, gap):
        roller = Cylinder(centre=(2.0, 3.0 + away), radius=2.0)
        outline = Outline.rectangle((0.0, 4.0), (0.0, 1.0))
        scene = pressed_by(roller, outline, force=0.5, travel=1.0, strokes=1, rate=0.0, patch=0.1)
        stepper = Stepper(scene)
        state = stepper.start()
        contact = state.stage.contacts["counter"]
        travel = float(state.stage.problem.fields[contact.travel_name].vec[0]) - away
        forces.append((travel, contact.profile().pressure.max()))
    found = [*body(state.stage.problem), *pressure(contact), near("force across", -contact.force()[1], 0.5, 1e-6)]
    for what, here, there in zip(("indentation", "peak pressure"), *forces, strict=True):
        found.append(near(f"{what} from a gap", there, here, 2e-3))
    return found


def ridge_worn_away(count, high) -> list[Finding]:
    """Ridges on a block's top under a plane, worn until nothing is left of them.

    Where the contacts of ridge and top have just met, the pressure has a cusp: it has to be smooth in the end.
    """
    half, middle = 0.15, np.linspace(0, 2, count + 2)[1:-1][::-1]
    wave = 0.5 * (1 + np.cos(np.linspace(-np.pi, np.pi, 17)))
    points = [
        (float(m - half * s), 1.0 + high * float(w))
        for m in middle
        for s, w in zip(np.linspace(-1, 1, 17), wave, strict=True)
    ]
    feet = [k for k in range(len(points)) if k % 17 in (0, 16)]
    plane = Plane(point=(0.0, 1.0 + high), normal_vector=(0.0, -1.0))
    area = count * high * half
    strokes = 16
    travel = 3 * area / (WEAR_RATE * 0.2) / strokes  # the ridges' area and more: the plane wears beside them as well
    scene = pressed_by(
        plane, top(points, 2.0, 1.0, corners=feet), force=0.2, travel=travel, strokes=strokes, patch=0.02
    )
    state, found = worn(scene)
    rough = [f for f in found if f.what == "roughness"]
    found = [f for f in found if f.what != "roughness"] + rough[-1:]
    left = state.contour.points[state.contour.on(("top",)), 1]
    share = (left.max() - left.min()) / high
    area_law = near("worn area", state.ledger.worn, WEAR_RATE * 0.2 * travel * strokes, 2e-3)
    return [*found, area_law, Finding("ridge left", float(share), 0.2)]


def worn_thin(left, *, strokes=20) -> list[Finding]:
    """A sheet of 0.4 mm, 2 mm wide, worn by a plane until this share of it is left."""
    outline = Outline.rectangle((0.0, 2.0), (0.0, 0.4))
    plane = Plane(point=(0.0, 0.4), normal_vector=(0.0, -1.0))
    travel = (1 - left) * 0.8 / (WEAR_RATE * 0.1) / strokes
    scene = pressed_by(plane, outline, force=0.1, travel=travel, strokes=strokes, patch=0.05, coarse=0.1)
    state, found = worn(scene)
    thick = state.contour.points[:, 1].max()
    return [*found, near("thickness left", float(thick), 0.4 * left, 0.02 / left)]


def noisy(share) -> list[Finding]:
    """A worn hollow whose depth is noisy from point to point: the pressure is rough at first, and wear smooths it."""
    rng = np.random.default_rng(11)
    x = np.linspace(1.9, 0.1, 37)
    hollow = 0.05 * np.clip(1 - ((x - 1) / 0.6) ** 2, 0, None)
    rough = hollow * (1 + share * rng.uniform(-1, 1, len(x)))
    roller = Cylinder(centre=(1.0, 2.99), radius=2.0)
    outline = top([(float(a), 1 - float(d)) for a, d in zip(x, rough, strict=True)], 2.0, 1.0)
    scene = pressed_by(roller, outline, force=0.3, travel=5.0, strokes=24, patch=0.025)
    state, found = worn(scene)
    rough = [f for f in found if f.what == "roughness"]
    found = [f for f in found if f.what != "roughness"] + rough[-1:]
    first = max(f.value for f in rough)
    found.append(Finding("last roughness over the highest", rough[-1].value / first, 0.5))
    return [*found, near("worn area", state.ledger.worn, WEAR_RATE * 0.3 * 120.0, 0.03)]


def lip(radius, mu, rate) -> list[Finding]:
    """A wedge of 90 degrees with a round tip, pressed on a plane by 2 % of its height, rubbed and worn."""
    flank, angle = 0.5, np.linspace(-np.pi / 4, np.pi / 4, 13)
    centre = 1.0 + flank - radius * np.sqrt(2)
    arc = [(1.0 + radius * float(np.sin(-a)), centre + radius * float(np.cos(a))) for a in angle]
    contour = top([(1.0 + flank, 1.0), *arc, (1.0 - flank, 1.0)], 2.0, 1.0, corners=(0, 1, 13, 14))
    plane = Plane(point=(0.0, centre + radius), normal_vector=(0.0, -1.0))
    scene = pressed_by(
        plane, contour, force=0.05, travel=1.0, strokes=6 if rate else 1, patch=radius / 5, mu=mu, rate=rate
    )
    if rate:
        state, found = worn(scene)
        return [*found, near("worn area", state.ledger.worn, rate * 0.05 * 6, 0.02)]
    stepper = Watched(scene)
    stepper.advance(stepper.start())
    return stepper.found


def cases() -> list[Case]:
    """Every case of this file."""
    steps = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)
    found = [Case("wear step", f"{k:g} ds_crit", partial(stepped, "implicit", k)) for k in steps]
    unstable = "explicit wear over .* a step is unstable"
    found += [Case("wear step, explicit", f"{k:g} ds_crit", partial(stepped, "explicit", k), unstable) for k in (4.0,)]
    found += [
        Case("first contact under force", f"gap {g:g} mm", partial(from_a_gap, g)) for g in (1e-3, 0.1, 1.0, 10.0)
    ]
    ridges = ((1, 0.05), (1, 0.1), (3, 0.05))
    found += [Case("ridge worn away", f"{n} of {h:g} mm", partial(ridge_worn_away, n, h)) for n, h in ridges]
    found += [Case("sheet worn nearly through", f"{100 * s:g} % left", partial(worn_thin, s)) for s in (0.5, 0.2, 0.1)]
    found.append(Case("sheet worn through", "worn by 120 %", partial(worn_thin, -0.2), "worn through|worn away"))
    found += [Case("noise of the worn depth", f"{100 * s:g} %", partial(noisy, s)) for s in (0.1, 0.3)]
    tips = (
        (0.05, 0.0, 0.0),
        (0.02, 0.0, 0.0),
        (0.02, 0.5, 0.0),
        (0.02, 0.1, 1e-3),
        (0.005, 0.0, 0.0),
        (0.005, 0.1, 0.0),
    )
    for r, mu, k in tips:
        how = f"radius {r:g} mm, mu {mu:g}{', worn' if k else ''}"
        found.append(Case("tip of a lip", how, partial(lip, r, mu, k)))
    creases = "no equilibrium found under the mounting load.*friction of 0.5 .* compresses the surface at .* it creases"
    found.append(Case("tip of a lip", "radius 0.005 mm, mu 0.5", partial(lip, 0.005, 0.5, 0.0), creases))
    return found
