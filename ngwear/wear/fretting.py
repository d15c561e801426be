"""Fretting: a surface moves to and fro across a part, and both wear."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.friction import Friction
from ngwear.equilibrium.problem import Problem
from ngwear.equilibrium.stepping import StepOptions, Work, advance, settle
from ngwear.errors import SceneError
from ngwear.geometry.meshed_section import MeshedSection
from ngwear.geometry.outline import Outline
from ngwear.geometry.recession import recede
from ngwear.surfaces import WornProfile
from ngwear.wear.archard import worn_share
from ngwear.wear.jump_control import JumpControl

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Motion:
    """Oscillating motion in gross slip.

    Parameters
    ----------
    amplitude : float
        Amplitude of the surface [mm].
    wear_rate, counter_wear_rate : float
        Specific wear rates of the part and of the surface [mm²/N].
    places : int
        Gauss points on each stroke.
    """

    amplitude: float
    wear_rate: float
    counter_wear_rate: float
    places: int = 3


@dataclass(frozen=True)
class Scar:
    """Both worn profiles and the pressure of the place solved last.

    Attributes
    ----------
    cycles : int
    place, worn : array, shape (n, 2)
        Points of the part's edges before any wear and now, in the order of the outline [mm].
    counter : WornProfile
    touched : array, shape (k, 2)
        Nodes of the contact, on the undeformed outline [mm].
    pressure : array, shape (k,)
        Cauchy pressure there [MPa].
    """

    cycles: int
    place: Array
    worn: Array
    counter: WornProfile
    touched: Array
    pressure: Array

    @property
    def depth(self) -> Array:
        """Worn depth at each point of the part [mm], shape (n,)."""
        return np.linalg.norm(self.worn - self.place, axis=1)

    @property
    def area(self) -> float:
        """Area between the part's edges before any wear and now [mm²]."""
        # Summed over quadrilaterals, each of half its diagonals' cross product.
        first, second = self.worn[1:] - self.place[:-1], self.worn[:-1] - self.place[1:]
        return float(0.5 * (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]).sum())


@dataclass
class Visit:
    """One position of the surface on a stroke, with the data that the next solved cycle starts from.

    Attributes
    ----------
    place : float
        Position of the surface during slip, over half the slip distance [-].
    weight : float
        Share of the stroke [-].
    direction : int
        Of the motion.
    vector : array or None
        Equilibrium of the last solve.
    pressure : array, shape (k,)
        Nominal pressure at the contact's nodes then [MPa]; empty before it has been solved.
    """

    place: float
    weight: float
    direction: int
    vector: Array | None = None
    pressure: Array = field(default_factory=lambda: np.empty(0))


@dataclass
class Fretting:
    """Wear of a contact in gross slip, by single cycles or by cycle jumps.

    The surface drags the part along by d, the mean over the contact's force of the part's tangential displacement
    under the full friction; after each reversal it has to travel 2 d before all of the contact slips again. So the slip
    distance of a stroke is ``2 (amplitude - d)``, and during slip the surface is between ``-(amplitude - d)`` and
    ``amplitude - d`` over the material. Each solve gives the d of the next one. Neglected: the differences of the slip
    within the contact, and the wear before all of it slips (Cattaneo and Mindlin).

    A jump of N cycles is one cycle, to and fro, with N times the slip at each place. There, wear of both bodies is
    implicit in the contact law: ``kappa = (k1 + k2) ds``; afterwards ``k1 P ds / J`` is taken off the outline and
    ``k2 p ds`` off the surface's profile, which moves with the surface.

    Parameters
    ----------
    problem : Problem
        In equilibrium at rest under its load.
    contact : OutlineContact
        That slides and has a worn profile.
    friction : Friction
        That slides in full.
    elasticity : Elasticity
    motion : Motion
    control : JumpControl

    Attributes
    ----------
    cycles : int
        Done so far.
    drag : float
        Displacement d [mm].
    worn : float
        Worn area of the part by the law, ``int W dA`` [mm²].
    counter_worn : float
        Worn area of the surface by the law [mm²].
    """

    problem: Problem
    contact: OutlineContact
    friction: Friction
    elasticity: Elasticity
    motion: Motion
    control: JumpControl
    cycles: int = 0
    drag: float = 0.0
    worn: float = 0.0
    counter_worn: float = 0.0
    work: Work = field(default_factory=Work)

    def __post_init__(self) -> None:
        places, weights = np.polynomial.legendre.leggauss(self.motion.places)
        to = [Visit(float(z), float(w) / 2, 1) for z, w in zip(places, weights, strict=True)]
        fro = [Visit(visit.place, visit.weight, -1) for visit in reversed(to)]
        self._visits = to + fro
        self._unworn = self.body.contour.points
        self._load = self.contact.profile().load.sum()
        for visit in self._visits:
            self._solve(visit, 0.0)

    @property
    def body(self) -> MeshedSection:
        """The worn part."""
        return self.contact.section

    @property
    def counter(self) -> WornProfile:
        """The worn profile of the surface; SceneError if the contact keeps none."""
        if self.contact.counter is None:
            raise SceneError("contact.counter", None, "both bodies wear: give the contact a worn profile")
        return self.contact.counter

    def scar(self) -> Scar:
        """Present state of both bodies."""
        mine = self.body.contour.on(self.contact.edges)
        on = mine | np.roll(mine, 1)
        profile, worn = self.contact.profile(), self.body.contour.points[on]
        return Scar(self.cycles, self._unworn[on], worn, self.counter, profile.reference, profile.pressure)

    def advance(self, goal: int) -> None:
        """Compute one jump, with as many cycles as its error allows, up to ``goal`` cycles in total."""
        while True:
            jump = min(self.control.cycles, goal - self.cycles)
            saved = self._save()
            ratio = self._jump(jump)
            if self.control.accepts(ratio, jump):
                self.control.update(ratio, jump)
                self.cycles += jump
                return
            self._restore(*saved)
            self.work.retries += 1
            self.control.cut(jump)

    def _save(self) -> tuple[Outline, WornProfile, list[Visit], dict[str, float]]:
        numbers = {name: getattr(self, name) for name in ("drag", "worn", "counter_worn")}
        return self.body.contour, self.counter, [replace(visit) for visit in self._visits], numbers

    def _restore(self, contour: Outline, counter: WornProfile, visits: list[Visit], numbers: dict[str, float]) -> None:
        self.body.move_to(contour)
        self.contact.counter, self._visits = counter, visits
        self.__dict__.update(numbers)

    def _jump(self, cycles: int) -> float:
        """Compute one cycle in place of many; return the relative error of the worn area."""
        error = 0.0
        for visit in self._visits:
            before = visit.pressure
            slip = 2 * (self.motion.amplitude - self.drag) * visit.weight * cycles
            self._solve(visit, slip)
            error += slip * 0.5 * float(np.abs(visit.pressure - before) @ self.contact.profile().weight)
            self._wear(slip)
        return error / (4 * (self.motion.amplitude - self.drag) * cycles * self._load)

    def _solve(self, visit: Visit, slip: float) -> None:
        """Bring the surface to a place, sliding, with the wear over a path ``slip`` implicit."""
        problem, contact, motion = self.problem, self.contact, self.motion
        name, vector = contact.name, problem.state.vec.FV().NumPy()
        contact.compliance.Set((motion.wear_rate + motion.counter_wear_rate) * slip)
        at = visit.place * (motion.amplitude - self.drag) + visit.direction * self.drag
        # A slide along +x of a surface pushed along -y is against its tangent.
        loads = {f"{name} slide [mm]": at, f"{name} slip": -visit.direction}
        start, stood = vector.copy(), {name: problem.get_loads()[name] for name in loads}
        if visit.vector is not None:
            vector[:] = visit.vector
        problem.set_loads(loads)
        if not settle(problem, StepOptions(), self.work).converged:
            vector[:] = start
            problem.set_loads(stood)
            self.work.add(advance(problem, loads, StepOptions(first=0.25)))
        visit.vector = vector.copy()
        profile = contact.profile()
        visit.pressure = profile.nominal_pressure
        ax, ay = contact.surface.approach
        u = problem.fields[DISPLACEMENT]
        along = contact.at_nodes(ng.CF(ax * u[1] - ay * u[0]))
        self.drag = visit.direction * float(along @ profile.load) / self._load

    def _wear(self, slip: float) -> None:
        """Take the wear over a path ``slip`` off both bodies."""
        contact, contour, motion = self.contact, self.body.contour, self.motion
        profile = contact.profile()
        ratio = contact.at_nodes(self.elasticity.volume_ratio())
        share = worn_share(contour, profile, motion.wear_rate * slip * profile.load / ratio)
        ends, pressure = contact.imprint()
        counter = self.counter.worn(ends, motion.counter_wear_rate * slip * pressure)
        self.body.move_to(recede(contour, share, contact.edges))
        contact.counter = counter
        self.worn += float(share.sum())
        self.counter_worn += motion.counter_wear_rate * slip * float(profile.load.sum())
