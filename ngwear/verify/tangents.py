"""Every term's tangent against central differences of its residual.

At a smooth, random, admissible state x and for a random direction d, ``K(x) d`` is compared with
``(R(x + s d) - R(x - s d)) / (2 s)``, s = 1e-5: norm of the difference over norm of K d, the largest over the
unknowns' rows (displacement, pressures, travel), so that none hides another; the reference is 0. Strains
are near 10 %. Contact is loaded left of the middle and open right of it; the change of state is too small
to carry an integration point across. What a solve holds fixed (the stretch in the wear compliance, the
wetted part of the outline, the pressure about which a law of wear is linearised) is fixed here.

Displacements of order 2; all terms of a section that sees other orders are tried with those too.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT, VOLUMETRIC_STRESS, Term
from ngwear.effects.coefficient import Coefficient
from ngwear.effects.contact import OutlineContact
from ngwear.effects.contact_patch import PatchContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.fluid_pressure import FluidPressure
from ngwear.effects.friction import FullSliding
from ngwear.effects.pressure_wear import PressureWear
from ngwear.effects.rounding import Rounding
from ngwear.effects.stick_slip import StickSlip
from ngwear.effects.unilateral import UnilateralContact
from ngwear.effects.viscosity import Viscosity
from ngwear.equilibrium.problem import Problem
from ngwear.fields.kinematics import Axisymmetric, Kinematics, PlaneStrain, Solid
from ngwear.geometry.outline import Outline
from ngwear.geometry.sheet import Sheet
from ngwear.laws import ByPressure, FrictionalEnergyWear, FrictionLaw, PowerWear, SaturatingWear, ThresholdWear, WearLaw
from ngwear.materials import MooneyRivlin, NeoHooke, PronySeries
from ngwear.surfaces import Corner, Cylinder, Plane, RigidSurface, Sphere
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.builders import meshed

STEP, TOLERANCE = 1e-5, 1e-6
WIDTH, BOTTOM, TOP, SIZE = 4.0, 1.0, 3.0, 0.5
NOWHERE = np.empty((0, 3))
MATERIALS = {
    "neo-Hooke": NeoHooke(shear=1.5, bulk_modulus=1000.0),
    "Mooney-Rivlin": MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1000.0),
}
ARMS = PronySeries((3.0, 2.0), (0.1, 1.0))
FRICTION: dict[str, FrictionLaw | float] = {
    "": 0.8,
    " by pressure": ByPressure(light=0.9, limit=0.1, pressure=0.8, exponent=0.7),
}
WEAR_LAWS = {
    "power 2": PowerWear(exponent=2.0),
    "power 0.5": PowerWear(exponent=0.5),
    "threshold": ThresholdWear(pressure=0.8),
    "saturating": SaturatingWear(pressure=0.8),
    "frictional energy": FrictionalEnergyWear(),
}
SECTION = {"plane strain": PlaneStrain(), "axisymmetric": Axisymmetric()}
SOLID = {"solid": Solid()}
KINEMATICS = SECTION | SOLID
ROUNDED = 0.5  # of G: some points are on the rounded part
SURFACES = {
    "plane": Plane(point=(WIDTH / 2, TOP), normal_vector=(0.3, -1.0)),
    "corner": Corner(point=(WIDTH / 2, TOP - 0.1), normal_vector=(0.0, -1.0), side=(1.0, 0.0), radius=0.5),
    "cylinder": Cylinder(centre=(0.5, TOP + 2.5), radius=3.0),
}
BALLS = {"ball": Sphere(centre=(-1.5, 0.0, TOP + 2.5), radius=3.0, track_radius=8.0)}


class _FullSliding(FullSliding):
    """With the smooth pressure of its ripples held, as the tangent has it."""

    def gather(self) -> None:
        """Keep it."""


def _set_state(problem: Problem, rng: np.random.Generator) -> None:
    """Smooth waves for the displacement and every pressure, 0.05 mm for a surface's travel."""

    def wave(mean: float, size: float) -> ng.CoefficientFunction:
        kx, ky, phase = rng.uniform(0.5, 1.5), rng.uniform(0.5, 1.5), rng.uniform(0, 2 * np.pi)
        return mean + size * ng.sin(kx * ng.x + ky * ng.y - ng.z + phase)

    for name, field in problem.fields.items():
        if name == DISPLACEMENT:
            field.Set(ng.CF(tuple(wave(0, 0.1) for _ in range(problem.body.mesh.dim))))
        elif name == VOLUMETRIC_STRESS:
            field.Set(wave(0, 1))
        elif field.space.ndof == 1:
            field.vec[0] = 0.05
        else:
            field.Set(wave(1, 0.5), definedon=problem.body.boundary(("top",)))


def tangent_error(problem: Problem, rng: np.random.Generator) -> float:
    """Largest relative difference over the unknowns' rows at the problem's state."""
    state = problem.state.vec
    direction, product, ahead, behind = (state.CreateVector() for _ in range(4))
    direction.FV().NumPy()[:] = rng.uniform(-1, 1, len(direction))
    product.data = problem.assemble() * direction
    state.data += STEP * direction
    problem.residual(ahead)
    state.data -= 2 * STEP * direction
    problem.residual(behind)
    exact = product.FV().NumPy()
    off = (ahead.FV().NumPy() - behind.FV().NumPy()) / (2 * STEP) - exact
    errors = []
    for name in problem.names:
        rows = problem.part(name)
        # Rows in which the term says nothing are measured against the whole.
        scale = np.linalg.norm(exact[rows]) or np.linalg.norm(exact)
        errors.append(np.linalg.norm(off[rows]) / scale)
    return float(max(errors))


class _HeldWear(PressureWear):
    """Linearised about 1.3 times the first pressure, which stays, as the tangent has it; its slope without a bound."""

    def gather(self) -> None:
        if not self._tried.vec.Norm():
            self._tried.vec.data = 1.3 * self._state.vec
            self._bound.Set(0.0)


def _contact(
    surface: RigidSurface, forced: bool, wear: float, law: WearLaw | None = None, order: int = 2
) -> UnilateralContact:
    contact: UnilateralContact
    if isinstance(surface, Sphere):
        contact = PatchContact("rigid", ("top",), surface, force_controlled=forced, modulus=1.5)
    else:
        contact = OutlineContact("rigid", ("top",), surface, force_controlled=forced, modulus=1.5, order=order)
    if law is not None:
        contact.pressure_wear = _HeldWear(law, modulus=1.5, coefficient=Coefficient("rigid", FRICTION[" by pressure"]))
    contact.load.Set(2.0 if forced else 0.05)
    contact.compliance.Set(wear)
    return contact


def _cases() -> Iterator[tuple[str, Kinematics, list[Term]]]:
    for (kin, kinematics), (name, material) in itertools.product(KINEMATICS.items(), MATERIALS.items()):
        yield f"elasticity, {name}, {kin}", kinematics, [Elasticity(material)]
        yield f"viscosity, {name}, {kin}", kinematics, [Elasticity(material), Viscosity(material, ARMS)]
    pairs = itertools.product(SECTION.items(), SURFACES.items())
    for (kin, kinematics), (name, surface) in (*pairs, *itertools.product(SOLID.items(), BALLS.items())):
        for forced, wear in itertools.product((False, True), (0.0, 0.02)):
            how = f"{'force' if forced else 'displacement'}{' and wear' if wear else ''}"
            yield f"contact, {name}, {how}, {kin}", kinematics, [_contact(surface, forced, wear)]
        for wears, wear_law in WEAR_LAWS.items():
            contact = _contact(surface, True, 0.02, wear_law)
            yield f"contact, {name}, force and wear, {wears}, {kin}", kinematics, [contact]
        for forced in (False, True):
            how = "force" if forced else "displacement"
            for by, law in FRICTION.items():
                contact = _contact(surface, forced, 0.0)
                terms = [contact, _FullSliding(contact, law)]
                yield f"full sliding{by}, {name}, {how}, {kin}", kinematics, terms
                contact = _contact(surface, forced, 0.0)
                sticks = StickSlip(contact, law)
                sticks.travel.Set(0.02)
                yield f"stick and slip{by}, {name}, {how}, {kin}", kinematics, [contact, sticks]
    for kin, kinematics in SECTION.items():
        yield f"fluid pressure, {kin}", kinematics, [_fluid()]
        contact = _contact(SURFACES["plane"], True, 0.0)
        contact.rounding = Rounding(contact.modulus)
        contact.round_off(ROUNDED)
        sticks = StickSlip(contact, FRICTION[""])
        sticks.travel.Set(0.02)
        yield f"stick and slip, corners rounded, {kin}", kinematics, [contact, sticks]


def _fluid() -> FluidPressure:
    fluid = FluidPressure(("right", "top"), ("right",), ())
    fluid.pressure.Set(2.0)
    return fluid


def _cases_of_order(order: int) -> Iterator[tuple[str, Kinematics, list[Term]]]:
    for (kin, kinematics), (name, material) in itertools.product(SECTION.items(), MATERIALS.items()):
        yield f"elasticity, {name}, {kin}, order {order}", kinematics, [Elasticity(material, order=order)]
    for (kin, kinematics), (name, surface) in itertools.product(SECTION.items(), SURFACES.items()):
        of = f"{name}, force and wear, {kin}, order {order}"
        yield f"contact, {of}", kinematics, [_contact(surface, True, 0.02, order=order)]
        contact = _contact(surface, True, 0.02, order=order)
        yield f"full sliding, {of}", kinematics, [contact, _FullSliding(contact, FRICTION[""])]
        contact = _contact(surface, True, 0.02, order=order)
        sticks = StickSlip(contact, FRICTION[""])
        sticks.travel.Set(0.02)
        if order > 1:
            yield f"stick and slip, {of}", kinematics, [contact, sticks]
    for kin, kinematics in SECTION.items():
        yield f"fluid pressure, {kin}, order {order}", kinematics, [_fluid()]


def run() -> list[Check]:
    """One check a term and variant."""
    section = meshed(Outline.rectangle((0.0, WIDTH), (BOTTOM, TOP)), SIZE)
    solid = Sheet(
        thickness=TOP, track_radius=8.0, reach=2.0, beside=1.5, seeds=NOWHERE, sizes=NOWHERE[:, 0], coarse=1.0
    )
    checks = []
    others = [(order, *case) for order in (1, 3) for case in _cases_of_order(order)]
    for order, label, kinematics, terms in [*((2, *case) for case in _cases()), *others]:
        clock, rng = Stopwatch(), np.random.default_rng(7)
        problem = Problem(solid if isinstance(kinematics, Solid) else section, kinematics, terms, order=order)
        _set_state(problem, rng)
        for term in terms:
            term.prepare()
            term.gather()
            if isinstance(term, FluidPressure):
                share = term.field.vec.FV().NumPy()
                share[:] = rng.uniform(0, 1, len(share))
            if isinstance(term, Viscosity):
                term.relaxed += rng.uniform(-1, 1, term.relaxed.shape)
                term.set_time_step(0.1)
        error = tangent_error(problem, rng)
        checks.append(Check("tangents", f"{label} [-]", error, 0.0, TOLERANCE, clock.seconds))
    return checks
