"""One rubber block with memory: relaxation, creep and oscillation against closed forms.

A block of two elements in plane strain between frictionless plates, nearly incompressible (K/G = 1e9), with 1, 3 and 15
arms whose times lie a decade apart around 1 s. References: a stress at constant strain falls as ``G(t)`` also at
finite strain, since S_iso does not change (20 % here); at small strain (1e-7) a constant force gives the creep
``J(t)`` and a strain ``sin(omega t)`` from rest the stress

    sin(omega t) + sum gamma x / (1 + x^2) (cos(omega t) + x sin(omega t) - exp(-t / tau)),   x = omega tau

(Ferry, *Viscoelastic Properties of Polymers*, 1980, ch. 3). Steps grow from 1e-6 of the shortest time to 1e6 of the
longest in relaxation. Errors are the largest over time, relative to the long-term value (the instantaneous one for the
oscillation).

Energy: the plate goes down and up twice in 4 pi s; its work against what ``EnergyBook`` finds stored and turned into
heat, largest difference over the largest work.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.viscosity import Viscosity
from ngwear.equilibrium.energy_balance import EnergyBook
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.materials import NeoHooke, PronySeries
from ngwear.surfaces import Plane
from ngwear.verify.base import Bound, Check, Stopwatch
from ngwear.verify.builders import meshed

Array = NDArray[np.float64]
RUBBER = NeoHooke(shear=1.0, bulk_modulus=1e9)
SMALL, MEAN, LARGE = 1e-8, 20, 0.2  # strains; the second times the first
AT_ONCE = 1e-15  # s: far below the shortest relaxation time


def arms(count: int) -> PronySeries:
    """``count`` arms of half the long-term stiffness each, a decade apart about 1 s."""
    return PronySeries((0.5,) * count, tuple(10.0 ** (k - count // 2) for k in range(count)))


def block(series: PronySeries, *, force_controlled: bool) -> tuple[Problem, OutlineContact]:
    """Block of 1 x 1 mm under a plate."""
    body = meshed(Outline.rectangle((0.0, 1.0), (0.0, 1.0)), 1.0)
    plate = Plane(point=(0.5, 1.0), normal_vector=(0.0, -1.0))
    # The modulus given to the contact only makes its own give negligible: 1e-9 of the block's.
    lid = OutlineContact("lid", ("top",), plate, modulus=1e3, force_controlled=force_controlled)
    terms = [Elasticity(RUBBER), Viscosity(RUBBER, series), lid]
    supports = [FixedEdges(("bottom",), x=False), FixedEdges(("left",), y=False)]
    return Problem(body, PlaneStrain(), terms, supports=supports), lid


def relaxation_error(series: PronySeries) -> float:
    """Largest error of the force at 20 % of strain, over the long-term force [-]."""
    problem, lid = block(series, force_controlled=False)
    held = {"lid approach [mm]": LARGE}
    advance(problem, held, StepOptions(first=0.25), duration=AT_ONCE)
    time, forces = [0.0], [lid.force()[1]]
    for step in np.geomspace(1e-6 * series.times[0], 1e6 * series.times[-1], 60):
        advance(problem, held, duration=step)
        time.append(time[-1] + step)
        forces.append(lid.force()[1])
    return float(np.abs(np.array(forces) / forces[-1] - series.relaxation(time)).max())


def creep(series: PronySeries, steps: Array) -> tuple[Array, Array]:
    """Times [s], and the plate's travel under a constant force over its long-term travel [-]."""
    problem, lid = block(series, force_controlled=True)
    travel = problem.fields[lid.travel_name].vec
    travel[0] = 1e-3 * SMALL  # touching
    held = {"lid force [N]": 4 * RUBBER.shear * SMALL}
    advance(problem, held, duration=AT_ONCE)
    found = [travel[0]]
    for step in steps:
        advance(problem, held, duration=step)
        found.append(travel[0])
    advance(problem, held)  # for ever
    return np.concatenate([[0.0], np.cumsum(steps)]), np.array(found) / travel[0]


def creep_error(series: PronySeries, growth: float) -> float:
    """Largest error of creep with steps that grow from a thousandth of the shortest time on [-]."""
    end = 10 * series.times[-1]
    steps = [1e-3 * series.times[0]]
    while sum(steps[-1:]) < growth * end:
        steps.append(steps[-1] * (1 + growth))
    time, found = creep(series, np.array(steps))
    return float(np.abs(found - series.creep(time)).max())


def oscillation_error(series: PronySeries, *, steps: int) -> float:
    """Largest error of the force over a first cycle of 2 pi s about a relaxed compression [-]."""
    problem, lid = block(series, force_controlled=False)
    advance(problem, {"lid approach [mm]": MEAN * SMALL})
    mean = lid.force()[1]
    angle = np.linspace(0.0, 2 * np.pi, steps + 1)
    found = []
    for a, b in itertools.pairwise(angle):
        advance(problem, {"lid approach [mm]": (MEAN + math.sin(b)) * SMALL}, duration=b - a)
        found.append(MEAN * (lid.force()[1] / mean - 1))
    t, x = angle[1:, None], np.array(series.times)
    share = np.array(series.ratios) * x / (1 + x * x) * (np.cos(t) + x * np.sin(t) - np.exp(-t / x))
    error = np.abs(np.array(found) - np.sin(angle[1:]) - share.sum(axis=1)).max()
    return float(error / series.instantaneous)


def energy_error(series: PronySeries, strain: float, *, steps: int) -> float:
    """Largest part of the plate's work that the book does not find again [-]."""
    problem, lid = block(series, force_controlled=False)
    (elasticity,) = (term for term in problem.terms if isinstance(term, Elasticity))
    (memory,) = (term for term in problem.terms if isinstance(term, Viscosity))
    book = EnergyBook(problem, elasticity, memory)
    work = push = depth = 0.0
    missed, spent = [], []
    for angle in np.linspace(0.0, 4 * np.pi, steps + 1)[1:]:
        depth_before, push_before = depth, push
        depth = 0.5 * strain * (1 - math.cos(angle))
        advance(problem, {"lid approach [mm]": depth}, duration=4 * np.pi / steps)
        book.add()
        push = abs(lid.force()[1])
        work += 0.5 * (push + push_before) * (depth - depth_before)
        missed.append(abs(work - book.elastic - book.arms - book.heat))
        spent.append(work)
    return max(missed) / max(spent)


def run() -> list[Check]:
    """Three sets of arms, and what happens where the step resolves nothing."""
    checks: list[Check] = []
    clock = Stopwatch()

    def check(quantity: str, value: float, reference: float, tolerance: float, bound: Bound = "near") -> None:
        checks.append(Check("memory", quantity, value, reference, tolerance, clock.seconds, bound=bound))
        clock.start()

    for count in (1, 3, 15):
        series = arms(count)
        check(f"error of relaxation at 20 % of strain, {count} arms [-]", relaxation_error(series), 0.0, 1e-6)
        check(f"error of creep, steps growing by 0.6 %, {count} arms [-]", creep_error(series, 0.006), 0.0, 1e-6)
        fine = oscillation_error(series, steps=1200)
        check(f"error of oscillation, 1200 steps a cycle, {count} arms [-]", fine, 0.0, 1e-6)
    errors = [oscillation_error(arms(3), steps=n) for n in (50, 100)]
    check("order in the time step, oscillation, 3 arms [-]", math.log2(errors[0] / errors[1]), 1.95, 0.0, "above")
    few, many = (energy_error(arms(3), 1e-4, steps=n) for n in (100, 400))
    check("energy missed at small strain, 200 steps a cycle, 3 arms [-]", many, 0.0, 2e-4)
    check("order in the time step of the energy missed [-]", math.log(few / many, 4), 1.5, 0.0, "above")
    check("energy missed at 20 % of strain, 200 steps a cycle [-]", energy_error(arms(3), LARGE, steps=400), 0.0, 0.03)
    # Bounds up to rounding, at strains of 1e-8.
    _, coarse = creep(arms(3), 10.0 ** np.arange(-6, 7, dtype=float))
    check("smallest rise of creep over steps of 1e-6 to 1e6 s, 3 arms [-]", np.diff(coarse).min(), -1e-7, 0.0, "above")
    check("largest creep over the long-term one, same steps, 3 arms [-]", coarse.max(), 1 + 1e-7, 0.0, "below")
    return checks
