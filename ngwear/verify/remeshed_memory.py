"""Memory through 100 unrelated meshes against a run that never remeshed, plane and axisymmetric.

Half of a rubber block, 3 x 1.5 mm, on a frictionless floor, with arms of 0.1, 1 and 10 s, under a rigid cylinder of
2 mm radius that goes up and down between 0.05 and 0.25 mm of indentation, 40 steps of 0.05 s a cycle. One run
meshes the section anew before each step, with sizes and seeds drawn at random; its memory lives on a background.
The reference keeps one mesh and its memory at its own material points.

What is compared is the field norm of each arm, ``|q - q_ref| / |q_ref|`` in L2 over the section at the reference's
points, where the background's q_i are brought as a body sees them: neither force nor energy sees a wrong memory. The
mesh's own error is that between two runs that never remesh, on different meshes, at the background's points.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.viscosity import Viscosity
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.state_transfer import transfer
from ngwear.equilibrium.stepping import StepOptions, Work, advance, settle
from ngwear.errors import ConvergenceError
from ngwear.fields.background_mesh import Background, Seat
from ngwear.fields.kinematics import Axisymmetric, Kinematics, PlaneStrain
from ngwear.geometry.body import Body
from ngwear.geometry.outline import Outline
from ngwear.materials import MooneyRivlin, PronySeries
from ngwear.surfaces import Cylinder
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.builders import meshed

Array = NDArray[np.float64]
CASE = "remeshed_memory"
RUBBER = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1500.0)
ARMS = PronySeries((0.8, 0.6, 0.4), (0.1, 1.0, 10.0))
WIDTH, BOTTOM, TOP, RADIUS = 1.5, 3.0, 4.5, 2.0
PATCH, COARSE = 0.04, 0.2
SEEDS = 26
STEP, EARLY, LATE = 0.05, 20, 100
OUTLINE = Outline.rectangle((0.0, WIDTH), (BOTTOM, TOP))
KINEMATICS: dict[str, Kinematics] = {"plane strain": PlaneStrain(), "axisymmetric": Axisymmetric()}


def depth(time: float) -> float:
    """Indentation [mm]."""
    return 0.15 - 0.1 * math.cos(math.pi * time)


def section(rng: np.random.Generator | None = None) -> Body:
    """The block, fine where the cylinder touches it; with a generator, meshed at random."""
    x = np.linspace(0.0, 1.0, SEEDS)
    size: Array | float = PATCH
    coarse = COARSE
    if rng is not None:
        x = np.sort(rng.uniform(0.0, 1.0, SEEDS))
        size, coarse = PATCH * rng.uniform(0.85, 1.1, SEEDS), COARSE * rng.uniform(0.8, 1.1)
    return meshed(OUTLINE, coarse, np.column_stack([x, np.full(SEEDS, TOP)]), size)


def problem_on(body: Body, kinematics: Kinematics, memory: Viscosity) -> Problem:
    """The block under the cylinder."""
    cylinder = Cylinder(centre=(0.0, TOP + RADIUS), radius=RADIUS)
    contact = OutlineContact("roller", ("top",), cylinder, modulus=RUBBER.shear_modulus)
    supports = [FixedEdges(("bottom",), x=False), FixedEdges(("left",), y=False)]
    return Problem(body, kinematics, [Elasticity(RUBBER), memory, contact], supports=supports)


def solve_step(problem: Problem, number: int) -> None:
    """One step of time to its end; the state before it is at hand or, after a new mesh, its carried guess."""
    problem.set_loads({"roller approach [mm]": depth(number * STEP)})
    problem.set_time_step(STEP)
    report = settle(problem, StepOptions(), Work())
    if not report.converged:
        raise ConvergenceError(f"no equilibrium in step {number}", report)
    problem.commit()


def mounted(body: Body, kinematics: Kinematics, memory: Viscosity) -> Problem:
    """Problem in the long-term equilibrium at the first depth."""
    problem = problem_on(body, kinematics, memory)
    advance(problem, {"roller approach [mm]": depth(0.0)}, StepOptions(first=0.25))
    return problem


class NeverRemeshed:
    """The run on one mesh, its memory at its own points; ``beside`` sees its strains on a background."""

    def __init__(self, body: Body, kinematics: Kinematics, background: Background) -> None:
        self.memory = Viscosity(RUBBER, ARMS)
        self.problem = mounted(body, kinematics, self.memory)
        self.beside = Viscosity(RUBBER, ARMS, background=background)
        self._watching = problem_on(body, kinematics, self.beside)
        self._look()
        self.seat = Seat(
            background,
            body=body,
            kinematics=kinematics,
            points=self.problem.points,
            displacement=self.problem.fields[DISPLACEMENT],
        )

    def step(self, number: int) -> None:
        """One step of time."""
        solve_step(self.problem, number)
        self._watching.set_time_step(STEP)
        self._look()

    def _look(self) -> None:
        self._watching.state.vec.data = self.problem.state.vec
        self._watching.commit()

    def error_of(self, relaxed: Array) -> Array:
        """Error of arms q_i on the background as a body sees them, in L2 over this run's own; shape (arms,)."""
        seen = np.array([self.seat.at_points(q) for q in relaxed])
        return distance(seen, self.memory.relaxed, self.problem.points.volumes)


def always_remeshed(kinematics: Kinematics, background: Background, *, seed: int = 3) -> Iterator[Array]:
    """The same with a new mesh, drawn at random, before each step."""
    rng = np.random.default_rng(seed)
    memory = Viscosity(RUBBER, ARMS, background=background)
    problem = mounted(section(rng), kinematics, memory)
    yield memory.relaxed
    for number in range(1, LATE + 1):
        before, old = memory, problem
        memory = Viscosity(RUBBER, ARMS, background=background)
        problem = problem_on(section(rng), kinematics, memory)
        (guess,) = transfer(old, [old.state.vec.FV().NumPy().copy()], problem)
        problem.state.vec.FV().NumPy()[:] = guess
        memory.take(before)
        solve_step(problem, number)
        yield memory.relaxed


def distance(found: Array, reference: Array, weight: Array) -> Array:
    """``|q - q_ref| / |q_ref|`` of each arm in L2 over the section [-]."""

    def norm(q: Array) -> Array:
        return np.sqrt((weight[..., None] * q**2).sum(axis=(1, 2, 3)))

    return norm(found - reference) / norm(reference)


def errors(kinematics: Kinematics) -> dict[str, Array]:
    """Errors of the arms after 20 and after 100 meshes, and the mesh's own after 100."""
    background = Background(section(np.random.default_rng(5)))
    reference = NeverRemeshed(section(), kinematics, background)
    other = NeverRemeshed(section(np.random.default_rng(11)), kinematics, background)
    found: dict[str, Array] = {}
    for number, remeshed in enumerate(always_remeshed(kinematics, background)):
        if number > 0:
            reference.step(number)
            other.step(number)
        if number == EARLY:
            found["early"] = reference.error_of(remeshed)
        if number == LATE:
            found["late"] = reference.error_of(remeshed)
            found["own"] = distance(other.beside.relaxed, reference.beside.relaxed, reference.seat.volumes)
    return found


def run() -> list[Check]:
    """Both kinematics."""
    checks = []
    for name, kinematics in KINEMATICS.items():
        clock = Stopwatch()
        found = errors(kinematics)
        for arm, time in enumerate(ARMS.times):
            early, late, own = (float(found[k][arm]) for k in ("early", "late", "own"))
            for quantity, value, reference in (
                ("error after 100 meshes against the mesh's own + 1 %", late, own + 0.01),
                ("error after 100 meshes over that after 20", late / early, 1.1),
            ):
                label = f"{quantity}, arm of {time:g} s, {name} [-]"
                checks.append(Check(CASE, label, value, reference, 0.0, clock.seconds, bound="below"))
    return checks
