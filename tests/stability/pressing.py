"""A roller on a bonded sheet (P1a's rubber and sizes): friction, stiffness, meshes, units, release, instability."""

from functools import partial

import numpy as np
from case import Case
from physics import Finding, body, near, pressure

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.friction import FullSliding
from ngwear.effects.stick_slip import StickSlip
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.materials import MooneyRivlin
from ngwear.surfaces import Cylinder
from ngwear.verify.builders import meshed
from ngwear.verify.locking import displacement_error

RUBBER = {"c10": 0.6, "c01": 0.15, "bulk_modulus": 1000.0}
FORCE, DEPTH = 4.0, 0.30  # N/mm, mm
P1A = {"indentation": 0.2538, "force": 5.3572, "pressure": 2.039, "pressure under force": 1.671}
WAVES = r"friction of [\d.]+ under p/G = [\d.]+ at contact 'roller' is more than steady sliding bears"
GENTLY = StepOptions(first=0.05)
APPROACH, PRESS, SLIP, TRAVEL = "roller approach [mm]", "roller force [N]", "roller slip", "roller travel [mm]"


def sheet(*, mu=0.0, law=FullSliding, forced=True, patch=0.05, bulk=1000.0, length=1.0, modulus=1.0, finest=1.0):
    """Problem, contact and friction; ``length`` and ``modulus`` are the sizes of a mm and an MPa."""
    rubber = MooneyRivlin(**{k: v * modulus for k, v in (RUBBER | {"bulk_modulus": bulk}).items()})
    at = np.arange(-2.4, 2.4 + patch / 2, patch)
    sizes = np.full(len(at), patch)
    if finest < patch:
        bands = np.concatenate([x + finest * np.arange(-30, 31) for x in (-1.595, 0.0, 1.595)])
        at, sizes = np.concatenate([at, bands]), np.concatenate([sizes, np.full(len(bands), finest)])
    seeds = np.stack([at, np.full(len(at), 2.0)], axis=1)
    outline = Outline.rectangle((-10 * length, 10 * length), (0.0, 2 * length))
    block = meshed(outline, 0.5 * length, seeds * length, sizes * length)
    roller = Cylinder(centre=(0.0, 7.0 * length), radius=5.0 * length)
    contact = OutlineContact("roller", ("top",), roller, force_controlled=forced, modulus=rubber.shear_modulus)
    terms, friction = [Elasticity(rubber), contact], None
    if mu > 0:
        friction = law(contact, mu)
        terms.append(friction)
    problem = Problem(block, PlaneStrain(), terms, supports=[FixedEdges(("bottom",))])
    if forced:
        problem.fields[contact.travel_name].vec[0] = 0.01 * length
    return problem, contact, friction


def carried(contact, friction=None, force=FORCE) -> Finding:
    """What pressure and friction carry against the force that presses."""
    found = -contact.force()[1] - (friction.force()[1] if friction else 0.0)
    return near("force across", found, force, 1e-6)


def slid(mu, force, patch=0.05) -> list[Finding]:
    """Full sliding under a force: forward, then turned round."""
    problem, contact, friction = sheet(mu=mu, patch=patch)
    problem.set_loads({SLIP: 0.0} if friction else {})
    advance(problem, {PRESS: force}, GENTLY)
    found, depth = [], problem.fields[contact.travel_name].vec
    depths = []
    for sign in (1.0, -1.0) if friction else (0.0,):
        advance(problem, {SLIP: sign} if friction else {}, StepOptions(first=0.5))
        found += [*body(problem), *pressure(contact), carried(contact, friction, force)]
        depths.append(depth[0])
        if friction:
            found.append(near("friction's heat", friction.heat(1.0), mu * contact.profile().load.sum(), 1e-9))
    if friction:
        found.append(near("indentation turned round", depths[1], depths[0], 1e-3))
    else:
        found.append(near("indentation", depth[0], P1A["indentation"], 2e-3))
        found.append(near("peak pressure", contact.profile().pressure.max(), P1A["pressure under force"], 4e-3))
    return found


def stuck_and_slid(mu, force) -> list[Finding]:
    """Stick and slip: partial slip, full sliding, reversal to full sliding the other way."""
    problem, contact, friction = sheet(mu=mu, law=StickSlip, patch=0.1)
    advance(problem, {PRESS: force}, GENTLY)
    found, forces = [], []
    for travel in (0.02, 1.0, 0.96, -1.0):
        advance(problem, {TRAVEL: travel}, StepOptions(first=0.25))
        used = np.abs(contact._sample(problem.fields[friction.tractions[0]])[:, 0])
        limit = mu * np.maximum(contact.end_pressures().mean(axis=1), 0.0)
        excess = (used - limit).max() / limit.max()
        found += [*body(problem), *pressure(contact), carried(contact, friction, force)]
        found.append(Finding("over the limit", excess, 1e-6))
        forces.append(friction.force()[0])
    other, _, slides = sheet(mu=mu, patch=0.1)
    other.set_loads({SLIP: 0.0})
    advance(other, {PRESS: force}, GENTLY)
    for sign, k in ((1.0, 1), (-1.0, 3)):
        advance(other, {SLIP: sign}, StepOptions(first=0.5))
        found.append(near("force of full sliding", forces[k], slides.force()[0], 5e-3))
    found.append(Finding("partial slip over full", abs(forces[0] / forces[1]), 0.95))
    found.append(Finding("turned slip over full", abs(forces[2] / forces[1]), 0.95))
    return found


def indented(mu) -> list[Finding]:
    """Full sliding at a given indentation."""
    problem, contact, _ = sheet(mu=mu, forced=False)
    advance(problem, {APPROACH: DEPTH} | ({SLIP: 1.0} if mu else {}), GENTLY)
    found = [*body(problem), *pressure(contact)]
    if not mu:
        found.append(near("force", -contact.force()[1], P1A["force"], 1e-3))
    return found


def pressed_far(mu, times) -> list[Finding]:
    """Pressed until p/G would be ``times`` (a flat punch's mean over the width of P1a's contact)."""
    problem, contact, _ = sheet(mu=mu)
    advance(problem, {PRESS: times * 1.5 * 3.1, SLIP: 1.0}, GENTLY)
    return [*body(problem), *pressure(contact)]


def stiff_in_volume(ratio) -> list[Finding]:
    """The sheet with K/G, rubbed with mu = 0.3; and Lamé's ring with it, where a mesh that locks errs with K/G."""
    problem, contact, friction = sheet(mu=0.3, bulk=1.5 * ratio)
    problem.set_loads({SLIP: 1.0})
    advance(problem, {PRESS: FORCE}, GENTLY)
    ring = Finding("error of Lamé's ring", displacement_error(ratio), 1e-3)
    return [*body(problem), *pressure(contact), carried(contact, friction), ring]


def meshed_with(patch) -> list[Finding]:
    """Element edges below 0.05 mm in the middle and at both ends: force and peak have their limits on every mesh."""
    problem, contact, _ = sheet(forced=False, patch=max(patch, 0.05), finest=patch)
    advance(problem, {APPROACH: DEPTH}, StepOptions(first=0.25))
    force = near("force", -contact.force()[1], P1A["force"], 2e-3)
    peak = near("peak pressure", contact.profile().pressure.max(), P1A["pressure"], 5e-3)
    return [*body(problem), *pressure(contact), force, peak]


def in_units(length, modulus) -> list[Finding]:
    """The same part in other units: every number is the same multiple, to the mesh's error where lengths change.

    The mesher's own tolerances are absolute: other units of length make another mesh.
    """
    found, seen = [], []
    for mm, mpa in ((1.0, 1.0), (length, modulus)):
        problem, contact, friction = sheet(mu=0.5, patch=0.1, length=mm, modulus=mpa)
        advance(problem, {PRESS: FORCE * mm * mpa, SLIP: 1.0}, GENTLY)
        found += [*body(problem), *pressure(contact), carried(contact, friction, FORCE * mm * mpa)]
        depth = problem.fields[contact.travel_name].vec[0]
        seen.append((depth / mm, contact.profile().pressure.max() / mpa, friction.force()[0] / (mm * mpa)))
    for what, one, other in zip(("indentation", "peak pressure", "friction"), *seen, strict=True):
        found.append(near(f"{what} in other units", other, one, 1e-9 if length == 1 else 2e-3))
    return found


def let_go(mu, law) -> list[Finding]:
    """Pressed, released in one step to a gap of 1 mm, pressed again in one step."""
    problem, contact, _ = sheet(mu=mu, law=law, forced=False, patch=0.1)
    if law is FullSliding and mu:
        problem.set_loads({SLIP: 1.0})
    found, forces = [], []
    for depth in (DEPTH * 0.8, -1.0, DEPTH * 0.8):
        advance(problem, {APPROACH: depth}, StepOptions(first=1.0))
        forces.append(contact.force())
        if depth > 0:
            found += [*body(problem), *pressure(contact)]
        else:
            u = problem.state.vec.FV().NumPy()[problem.part(DISPLACEMENT)]
            found.append(Finding("displacement left", float(np.abs(u).max()), 1e-9))
            found.append(Finding("force left", float(np.abs(forces[-1]).max()), 1e-9))
    across = [f[1] for f in forces]
    # A path of one load step and one of several stick differently.
    found.append(near("force pressed again", across[2], across[0], 0.02 if law is StickSlip else 1e-6))
    return found


def _friction() -> list[Case]:
    family = "full sliding, forward and turned round"
    cases = [Case(family, f"mu {mu:g}, p/G 1.2", partial(slid, mu, FORCE)) for mu in (0.0, 0.3, 0.7)]
    cases += [
        Case(family, f"mu {mu:g}, F {force:g} N/mm", partial(slid, mu, force))
        for mu, force in ((1.0, 1.5), (1.5, 0.3), (1.0, FORCE))
    ]
    cases.append(Case(family, "mu 1.5, F 4 N/mm", partial(slid, 1.5, FORCE), WAVES))
    family = "stick, slip and reversal"
    pairs = ((0.3, FORCE), (0.7, FORCE), (1.0, 0.8), (1.5, 0.3), (1.0, 1.5))
    cases += [Case(family, f"mu {mu:g}, F {f:g} N/mm", partial(stuck_and_slid, mu, f)) for mu, f in pairs]
    family = "friction at a given indentation"
    cases += [Case(family, f"mu {mu:g}", partial(indented, mu)) for mu in (0.0, 0.3, 0.5, 0.7)]
    cases += [Case(family, f"mu {mu:g}", partial(indented, mu), WAVES) for mu in (1.0, 1.5)]
    family = "beyond the surface's stability"
    cases += [
        Case(family, f"mu {mu:g}, p/G {times:g}", partial(pressed_far, mu, times), WAVES)
        for mu, times in ((1.0, 3.0), (1.5, 3.0), (1.0, 10.0))
    ]
    return cases


def cases() -> list[Case]:
    """Every case of this file."""
    found = _friction()
    found += [
        Case("nearly incompressible", f"K/G {r:.0e}", partial(stiff_in_volume, r)) for r in (1e2, 1e3, 1e4, 1e5, 1e6)
    ]
    edges = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002)
    found += [Case("element edge", f"{h:g} mm", partial(meshed_with, h)) for h in edges]
    units = ((1e3, 1.0), (1e-3, 1.0), (1.0, 1e3), (1.0, 1e-3), (1e3, 1e-3))
    found += [Case("units", f"mm x {a:g}, MPa x {b:g}", partial(in_units, a, b)) for a, b in units]
    laws = ((0.0, FullSliding, "frictionless"), (0.5, FullSliding, "mu 0.5"), (0.5, StickSlip, "mu 0.5, sticking"))
    found += [Case("release and re-contact", name, partial(let_go, mu, law)) for mu, law, name in laws]
    return found
