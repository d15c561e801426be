"""Rubber that remembers: steps far below and above its times, sliding far slower and faster, wear with a memory."""

from functools import partial

import numpy as np
import pressing
from case import Case
from physics import Finding, body, near, pressure

from ngwear.effects.viscosity import Viscosity
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.materials import PronySeries
from ngwear.scene.pin_scene import Pin, PinMesh
from ngwear.sliding.pin import PinStage
from ngwear.verify import hunter, indentation, memory

ARM = PronySeries((2.0,), (1.0,))


def settled(problem) -> list[Finding]:
    """Equilibrium of a step that has been committed: with no time passing, the stress is that of its end."""
    problem.set_time_step(memory.AT_ONCE)
    return body(problem)


def relaxed(ratio) -> list[Finding]:
    """20 % of strain at once, then one step of dt/tau: the stress is G(dt)."""
    problem, lid = memory.block(ARM, force_controlled=False)
    held = {"lid approach [mm]": memory.LARGE}
    advance(problem, held, StepOptions(first=0.25), duration=memory.AT_ONCE)
    first = float(lid.force()[1])
    advance(problem, held, duration=ratio)
    fall = float(lid.force()[1]) / first
    return [
        *settled(problem),
        *pressure(lid),
        near("relaxed force", fall, float(ARM.relaxation([ratio])[0]) / 3.0, 1e-6),
    ]


def ramped(ratio) -> list[Finding]:
    """A small strain that grows evenly over one step of dt/tau: G_inf (1 + gamma (1 - exp(-x)) / x)."""
    problem, lid = memory.block(ARM, force_controlled=False)
    target = {"lid approach [mm]": 1e-6}
    advance(problem, target, duration=ratio)
    found, force = [*settled(problem), *pressure(lid)], float(lid.force()[1])
    advance(problem, target)  # for ever
    rise = force / float(lid.force()[1])
    return [*found, near("ramped force", rise, 1 + 2.0 * -np.expm1(-ratio) / ratio, 1e-5)]


def rolled(ratio, mu) -> list[Finding]:
    """P1a's roller pressed, rubbed, let go and pressed again in steps of dt/tau."""
    plain, contact, friction = pressing.sheet(mu=mu, forced=False, patch=0.1)
    elasticity, *others = plain.terms
    rubber = Viscosity(elasticity.material, ARM)
    problem = Problem(plain.body, plain.kinematics, [elasticity, rubber, *others], supports=[FixedEdges(("bottom",))])
    if friction:
        problem.set_loads({pressing.SLIP: 1.0})
    found, forces = [], []
    for depth in (0.15, 0.15, -0.5, 0.15):
        advance(problem, {pressing.APPROACH: depth}, StepOptions(first=0.5), duration=ratio)
        forces.append(-float(contact.force()[1]))
        if depth > 0:
            found += [*settled(problem), *pressure(contact)]
    found.append(Finding("held force over the first", forces[1] / forces[0], 1.0 + 1e-6))
    found.append(Finding("force left", abs(forces[2]), 1e-9))
    if ratio < 1e-3 or ratio > 1e3:  # glassy, or relaxed: elastic with one modulus or the other
        found.append(near("force again", forces[3], forces[0], 1e-2))
    return found


def asperity(speed) -> list[Finding]:
    """Hunter's cylinder: friction, half length and energy against the closed form, over the maximum of friction."""
    found, expected = hunter.steady(speed), hunter.closed_form(speed)
    highest = hunter.closed_form(32.1)["friction"]
    off = abs(found["friction"] - expected["friction"]) / highest
    lost = abs(found["dissipation"] - found["friction"]) / highest
    length = near("half length", found["half_length"], expected["half_length"], 0.02)
    return [Finding("error of the friction over its maximum", off, 0.01), Finding("energy missed", lost, 0.01), length]


def ball(mu) -> list[Finding]:
    """A ball 40 % deep in a bonded sheet, three dimensions."""
    pin = Pin(material=indentation.RUBBER, series=None, friction=mu)
    stage = PinStage(pin, PinMesh(patch=0.9, coarse=2.0, reach=2.5, beside=2.5), (0.0, 0.0, 3.0))
    stage.press()
    normal = near("force across", -stage.contact.force()[2], pin.load, 1e-3)
    lowest = stage.problem.fields[stage.contact.pressure_name].vec.FV().NumPy()
    suction = Finding("suction", float(max(0.0, -lowest.min()) / lowest.max()), 1e-9)
    return [*body(stage.problem), suction, normal, near("penetration", stage.depth, indentation.DEPTH, 0.02)]


def cases() -> list[Case]:
    """Every case of this file."""
    ratios = (1e-6, 1e-3, 1.0, 1e3, 1e6)
    found = [Case("time step, relaxation at 20 %", f"dt/tau {x:g}", partial(relaxed, x)) for x in ratios]
    found += [Case("time step, ramp", f"dt/tau {x:g}", partial(ramped, x)) for x in ratios]
    found += [
        Case("rubber with memory let go", f"dt/tau {x:g}, mu {mu:g}", partial(rolled, x, mu))
        for x, mu in ((1e-6, 0.0), (1.0, 0.5), (1e6, 0.5))
    ]
    speeds = (1e-2, 1.0, 1e3, 1e5)
    found += [Case("asperity", f"{v:g} mm/s", partial(asperity, v)) for v in speeds]
    found += [Case("ball in three dimensions", f"mu {mu:g}", partial(ball, mu)) for mu in (0.0, 0.06)]
    return found
