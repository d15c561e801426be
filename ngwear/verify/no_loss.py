"""Without loss of elements, deactivation is the moving-node method: an explicit Archard loop written out by hand.

Plane strain; block 4 x 2 mm, bottom bonded, neo-Hooke, G = 1 MPa, K = 100 MPa; a cylinder of R = 2 mm under 0.5 N/mm
slides to and fro across its top with mu = 0.3 and k = 1e-3 mm²/N, 8 strokes of 10 mm. Layers of 0.3 mm, sides 0.1 mm.

- Explicit wear, each stroke solved, against the loop here: equilibrium, ``W = k P s / J`` at each node, nodes moved
  down their columns so that each sweeps W times the half lengths beside it, and again. Outlines within 1e-9 mm per mm.
- The same with a tearing criterion and a filter that nothing reaches: outline and worn area the same to the last bit,
  explicit and implicit.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ngwear.effects.base import VOLUMETRIC_STRESS
from ngwear.equilibrium.stepping import StepOptions, Work, advance, settle
from ngwear.geometry.outline import Array, Outline
from ngwear.laws.damage import Criterion, TensileNormalStress
from ngwear.loop.lost_elements import element_body
from ngwear.loop.stage import Stage
from ngwear.loop.stepper import Stepper
from ngwear.materials import NeoHooke
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Support
from ngwear.scene.contact import Contact
from ngwear.scene.deactivation import Deactivation, DistortionFilter
from ngwear.scene.options import Wear
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Cylinder
from ngwear.verify.base import Check, Stopwatch

WEAR_RATE, STROKES = 1e-3, 8
NEVER_TORN, NEVER_FOUND = TensileNormalStress(critical=1e9), DistortionFilter(corner_cosine=1 - 1e-9)


def scene(
    scheme: str = "explicit",
    strokes: tuple[Stroke, ...] = (),
    *,
    damage: Criterion | None = None,
    distortion: DistortionFilter | None = None,
    reach: float | None = None,
) -> Scene:
    """The block under the cylinder; ``strokes`` are those of a cycle, to and fro unless given."""
    cylinder = Cylinder(centre=(2.0, 3.99), radius=2.0)
    cycle = strokes or (Stroke(name="forth", travel=10.0), Stroke(name="back", travel=10.0, direction=-1.0))
    spec = Contact(
        name="cylinder",
        edges=("top",),
        surface=cylinder,
        force=0.5,
        friction=0.3,
        specific_wear_rate=WEAR_RATE,
        sticks=False,
    )
    return Scene(
        name="block of elements",
        part=Part(Outline.rectangle((0.0, 4.0), (0.0, 2.0)), material=NeoHooke(shear=1.0, bulk_modulus=100.0)),
        contacts=(spec,),
        supports=(Support(edges=("bottom",)),),
        program=Program(cycle=cycle, strokes=STROKES),
        accuracy=Accuracy(patch=0.1, coarse=0.5, mounting=0.1),
        wear=Wear(scheme=scheme, step="each", remesh="never"),
        deactivation=Deactivation(depth=0.3, damage=damage, distortion=distortion, reach=reach),
        axisymmetric=False,
    )


def by_hand(scene: Scene) -> Array:
    """Outline after explicit wear, node by node, shape (n, 2) [mm]."""
    body = element_body(scene)
    stage = Stage(scene, body)
    problem, contact = stage.problem, stage.contacts["cylinder"]
    problem.set_loads(stage.first_touch())
    advance(problem, stage.mounted_loads(), StepOptions(first=1 / 64))
    bulk = stage.elasticity.split[1]
    for number in range(scene.program.strokes):
        stroke = scene.program.cycle[number % len(scene.program.cycle)]
        if number == 0 or len(scene.program.cycle) > 1:
            advance(problem, stage.stroke_loads(stroke), StepOptions(first=0.25))
        settle(problem, StepOptions(), Work())
        points, profile = body.contour.points, contact.profile().straight()
        node = np.rint(profile.t).astype(int)
        after, before = (node + 1) % len(points), node - 1
        vertices = np.append(body.outline.vertices[:, 0], 0)[node]
        j = 1 + problem.fields[VOLUMETRIC_STRESS].vec.FV().NumPy()[vertices] / bulk
        worn = WEAR_RATE * stroke.travel * profile.load / profile.weight / j
        lengths = (
            np.linalg.norm(points[after] - points[node], axis=1),
            np.linalg.norm(points[node] - points[before], axis=1),
        )
        moved = points.copy()
        moved[node, 1] -= worn * (lengths[0] + lengths[1]) / np.abs(points[after, 0] - points[before, 0])
        body.move_to(replace(body.contour, points=moved))
    return body.contour.points


def run_of(scene: Scene) -> tuple[Array, float]:
    """Outline and worn area at the end of a run by the loop."""
    stepper = Stepper(scene)
    state = stepper.start()
    while not stepper.finished(state):
        state = stepper.advance(state)
    return state.contour.points, state.ledger.worn


def run() -> list[Check]:
    """The loop against that by hand, and with criteria out of reach."""
    checks, clock = [], Stopwatch()

    def add(quantity: str, value: float, reference: float, tolerance: float) -> None:
        checks.append(Check("tearing_off", quantity, value, reference, tolerance, clock.seconds))

    hand, (found, worn) = by_hand(scene()), run_of(scene())
    middle = np.abs(found[:, 0] - 2.0) < 0.5
    add(
        "greatest depth, so that there is something to compare [mm]",
        2.0 - found[middle & (found[:, 1] > 1.0), 1].min(),
        0.045,
        0.1,
    )
    add("outline against that by hand, over the size [-]", np.abs(found - hand).max() / 4.0, 0.0, 1e-9)
    law = WEAR_RATE * 0.5 * 10.0 * STROKES
    add("worn area over k F s [-]", worn / law, 1.0, 0.02)
    for scheme in ("explicit", "implicit"):
        clock.start()
        first, second = run_of(scene(scheme)), run_of(scene(scheme, damage=NEVER_TORN, distortion=NEVER_FOUND))
        add(f"{scheme}: points that criteria out of reach change [-]", float((first[0] != second[0]).sum()), 0.0, 0.0)
        add(f"{scheme}: worn area that they change [mm²]", abs(first[1] - second[1]), 0.0, 0.0)
    return checks
