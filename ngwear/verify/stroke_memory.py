"""One solve a stroke with the mean overstress against the same strokes resolved in time.

A bonded rubber block, 3 x 1.5 mm in plane strain, under a rigid cylinder of 2 mm radius pressed in by 0.2 mm, which
slides to and fro (friction 0.2, 0.9 s a stroke); every second stroke 0.3 MPa press on one side. Arms of 0.1, 1 and
10 s, 1.8 times as stiff together as the long-term rubber, G = 1.5 MPa. The block has relaxed under the cylinder
before the first stroke.

Resolved: each reversal at once, then 24 growing steps. Compared are the means over each of the first six strokes of the
cylinder's force and of the highest contact pressure. With a pressed side strains do not stand still during a stroke:
that is the error. What a run of the same scene states of it (``ngwear.loop.time_step_error``) is held against the
strokes resolved in time, and its error with strokes in four parts against that with strokes in one.

Jumps of 1, 3, 9 and 27 cycles, growing as wear's do, against the 40 one by one: force and pressure of the last
strokes. A jump takes the other strokes' strains as they were solved last; while the arms still settle, that is its
error.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.fluid_pressure import FluidPressure
from ngwear.effects.friction import FullSliding
from ngwear.effects.memory import Memory
from ngwear.effects.stroke_memory import StrokeMemory
from ngwear.effects.viscosity import Viscosity
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.fields.background_mesh import Background
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.body import Body
from ngwear.geometry.meshed_section import MeshedSection
from ngwear.geometry.outline import Outline
from ngwear.loop.memory_over_cycles import CycleMemory
from ngwear.loop.run import run as run_scene
from ngwear.loop.time_step_error import next_cycle
from ngwear.materials import MooneyRivlin, PronySeries
from ngwear.results import quantities_of_interest
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Fluid, Support
from ngwear.scene.contact import Contact
from ngwear.scene.options import Wear
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Cylinder
from ngwear.verify.base import BAND, Check, Stopwatch
from ngwear.verify.builders import meshed

Array = NDArray[np.float64]
CASE = "stroke_memory"
RUBBER = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1500.0)
ARMS = PronySeries((0.8, 0.6, 0.4), (0.1, 1.0, 10.0))
HALF, HEIGHT, RADIUS, DEPTH, FRICTION, PRESSURE = 1.5, 1.5, 2.0, 0.2, 0.2, 0.3
DURATION, STROKES, SUBSTEPS, AT_ONCE = 0.9, 6, 24, 1e-6
JUMPS = (1, 3, 9, 27)
WAY = 10.0  # mm


def block() -> Body:
    """The section, 0.06 mm in the contact."""
    x = np.linspace(-1.0, 1.0, 34)
    contour = Outline.rectangle((-HALF, HALF), (0.0, HEIGHT))
    return meshed(contour, 0.3, np.column_stack([x, np.full(34, HEIGHT)]), 0.06)


class Rig:
    """The block with a memory of either kind."""

    def __init__(self, body: MeshedSection, memory: Memory) -> None:
        cylinder = Cylinder(centre=(0.0, HEIGHT + RADIUS), radius=RADIUS)
        self.contact = OutlineContact("roller", ("top",), cylinder, modulus=RUBBER.shear_modulus)
        side = FluidPressure(("right",), ("right",), (self.contact,))
        terms = [Elasticity(RUBBER), memory, self.contact, FullSliding(self.contact, FRICTION), side]
        self.problem = Problem(body, PlaneStrain(), terms, supports=[FixedEdges(("bottom",))])
        self.problem.set_loads({"roller slip": -1.0})
        advance(self.problem, {"roller approach [mm]": DEPTH}, StepOptions(first=0.25))

    @staticmethod
    def loads(kind: int) -> dict[str, float]:
        """Loads of the stroke to (0) or fro (1)."""
        return {"roller slip": (-1.0, 1.0)[kind], "fluid pressure [MPa]": (0.0, PRESSURE)[kind]}

    def seen(self) -> Array:
        """Force of the cylinder [N/mm] and highest pressure [MPa]."""
        return np.array([abs(self.contact.force()[1]), self.contact.profile().pressure.max()])


def resolved(body: MeshedSection, strokes: int) -> Array:
    """Means over each stroke, shape (strokes, 2)."""
    rig = Rig(body, Viscosity(RUBBER, ARMS))
    times = DURATION * np.concatenate([[0.0], np.geomspace(2e-3, 1.0, SUBSTEPS)])
    means = []
    for stroke in range(strokes):
        advance(rig.problem, rig.loads(stroke % 2), StepOptions(first=0.5), duration=AT_ONCE)
        found = [rig.seen()]
        for start, end in pairwise(times):
            advance(rig.problem, {}, duration=end - start)
            found.append(rig.seen())
        means.append(np.trapezoid(found, times, axis=0) / DURATION)
    return np.array(means)


class Strokes:
    """The same by one solve a stroke."""

    def __init__(self) -> None:
        body = block()
        background = Background(block())
        self.term = StrokeMemory(RUBBER, ARMS, background)
        self.rig = Rig(body, self.term)
        mounted = self.term.stress()
        self.memory = CycleMemory(background, ARMS, (DURATION, DURATION), mounted=mounted, rest=np.inf)

    def step(self, plan: list[tuple[int, int]]) -> Array:
        """Solve all strokes of a plan; what is seen in each, shape (kinds, 2)."""
        seen = []
        for kind, _ in plan:
            self.memory.prepare(self.term, plan, kind)
            advance(self.rig.problem, self.rig.loads(kind), StepOptions(first=0.5))
            self.memory.record(self.term, kind)
            seen.append(self.rig.seen())
        self.memory.commit(plan)
        return np.array(seen)


def run() -> list[Check]:
    """Strokes against time, and a jump against strokes."""
    clock = Stopwatch()
    reference = resolved(block(), STROKES)
    one_by_one = Strokes()
    found = np.concatenate([one_by_one.step([(stroke % 2, 1)]) for stroke in range(STROKES)])
    relaxed = Strokes().rig.seen()
    error = np.abs(found / reference - 1).max(axis=0)
    seconds = clock.seconds
    checks = [
        Check(CASE, f"largest error of {what}'s mean over a stroke [-]", float(e), 0.0, 0.01, seconds)
        for what, e in zip(("the force", "the highest pressure"), error, strict=True)
    ]
    swing = float(np.abs(reference / relaxed - 1).max())
    checks.append(
        Check(CASE, "largest change that memory and strokes make [-]", swing, 0.05, 0.0, seconds, bound="above")
    )
    clock.start()
    singles, jump = Strokes(), Strokes()
    for _ in range(sum(JUMPS)):
        last = singles.step([(0, 1), (1, 1)])
    for cycles in JUMPS:
        leapt = jump.step([(0, cycles), (1, cycles)])
    off = float(np.abs(leapt / last - 1).max())
    checks.append(Check(CASE, f"{sum(JUMPS)} cycles in jumps against one by one [-]", off, 0.0, 0.01, clock.seconds))
    return checks + time_step()


def scene(parts: int) -> Scene:
    """The block as a scene, its strokes in parts."""
    cylinder = Cylinder(centre=(0.0, HEIGHT + RADIUS - DEPTH), radius=RADIUS)
    to = Stroke(name="to", travel=WAY, direction=-1.0, speed=WAY / DURATION)
    return Scene(
        name="block under a cylinder",
        part=Part(Outline.rectangle((-HALF, HALF), (0.0, HEIGHT)), material=RUBBER, prony=ARMS),
        contacts=(Contact(name="roller", edges=("top",), surface=cylinder, friction=FRICTION, refine=True),),
        program=Program(cycle=(to, replace(to, name="fro", direction=1.0, pressure=PRESSURE)), strokes=STROKES),
        fluid=Fluid(edges=("right",), inlet=("right",)),
        supports=(Support(edges=("bottom",)),),
        accuracy=Accuracy(patch=0.06, coarse=0.3, mounting=0.06, parts=parts),
        wear=Wear(step="each"),
        axisymmetric=False,
    )


def time_step() -> list[Check]:
    """What runs state of their time step against the next two strokes resolved in time, on the same mesh."""
    watch, checks, off = Stopwatch(), [], {}
    for parts in (1, 4):
        result = run_scene(scene(parts), figures=False)
        exact = resolved(result.end.stage.body, STROKES + 2)[-2:, 0]
        forces = [abs(report.forces["roller"][1]) for report in next_cycle(result.end).reports]
        force = np.mean(np.reshape(forces, (2, parts)), axis=1)
        off[parts] = float(np.linalg.norm(force - exact) / np.linalg.norm(exact))
        said = result.summary["error estimates"][
            f"{quantities_of_interest.FRICTION[:-4]} {quantities_of_interest.BY_TIME_STEP}"
        ]
        words = (
            f"{parts} part{'' if parts == 1 else 's'} a stroke: stated over true error of the force by its time step"
        )
        for limit, bound in BAND:
            label = f"{words}, {bound} {limit:g} [-]"
            checks.append(Check(CASE, label, said / off[parts], limit, 0.0, watch.seconds, bound=bound))
    label = "error by the time step, 4 parts a stroke over 1 [-]"
    checks.append(Check(CASE, label, off[4] / off[1], 0.5, 0.0, watch.seconds, bound="below"))
    return checks
