"""Laws of wear that are not linear in the pressure: ways to wear, steps and outlines.

**Column.** A block of height h under a flat surface in a fixed place, sides held, no friction: the pressure is uniform,
``p = M (d - w) / h`` with the indentation d = 1e-4 h and M = K + 4 G / 3 (strains of 1e-4 are what the closed forms
neglect). The wear ``dw/ds = k p phi(p)`` makes of q = p/p(0) and x = s k M / h

    dq/dx = -q phi:    power 2  q = 1 / (1 + x)              power 0.5   q = (1 - x/2)^2
                       threshold  q = q_0 + (1 - q_0) exp(-x)    saturating  q + ln q = 1 - x, so q = W(exp(1 - x))

(W is Lambert's; p_ref = p_s = p(0), q_0 = 0.4; elementary integrals.) At x = 1, in 10, 20 and 40 strokes, each solved:
the implicit scheme, backward differences after two steps of backward Euler, is of second order in the step; plain
backward Euler with the depth in the gap, and the explicit scheme, are of first. One step of x = 100, a hundred times
what halves Archard's pressure, must still solve ``q_1 + x q_1 phi(q_1) = 1``.

**Equal laws.** The power m = 1 is Archard's; frictional energy with a number for mu is Archard's with k mu; with
Thirion's mu = mu_0 / (1 + p/p_s) it is the saturating law with k mu_0. Each pair is run with the same friction.

**Ripples.** The block of ``stability_pair``, strokes of 10 critical steps of the law's slope at the mean pressure.

**Cylinder.** That of ``worn_cylinder`` with m = 2. Once worn the pressure is uniform, P'/(2a), and the depth a^2/(2R):
``a^(m+2) = a_H^(m+2) + (m + 2) R k p_ref^(1-m) (P'/2)^m s``, which is Archard's a^3 = a_H^3 + 1.5 k R P' s for m = 1.
Both with new meshes as they are due and with moved nodes alone.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from ngwear.laws import ByPressure, FrictionalEnergyWear, PowerWear, SaturatingWear, ThresholdWear, WearLaw
from ngwear.scene.scene import Scene
from ngwear.verify import stability_pair, worn_cylinder
from ngwear.verify.base import Bound, Check, Stopwatch
from ngwear.verify.wear_runs import CONTACT, depth_at, middle_pressure, steps
from ngwear.verify.worn_column import FIRST, LAWS, WEAR_RATE, by_backward_euler, depth, euler_step, pressures, scene

COUNTS, WAY, HUGE = (10, 20, 40), 1.0, 100.0
SECOND, ORDER, STEP, SAME = 1.9, 0.9, 2e-4, 1e-9
MU, HALF_WIDTH, EXPONENT, OFF = 0.3, 0.7, 2.0, 0.01
MEAN = stability_pair.MEAN
RIPPLED = {
    "power 2": PowerWear(exponent=2.0, reference_pressure=MEAN),
    "power 0.5": PowerWear(exponent=0.5, reference_pressure=MEAN),
    "threshold": ThresholdWear(pressure=0.5 * MEAN),
    "saturating": SaturatingWear(pressure=MEAN),
}


def _check(
    quantity: str, value: float, reference: float, tolerance: float, seconds: float, bound: Bound = "near"
) -> Check:
    return Check("wear_laws", quantity, value, reference, tolerance, seconds, bound=bound)


def _order(errors: list[float]) -> float:
    """Observed order where the steps are halved last."""
    return math.log2(abs(errors[-2] / errors[-1]))


def column() -> list[Check]:
    """Values, orders and one huge step for each law."""
    checks = []
    for name, (law, exact) in LAWS.items():
        clock, end = Stopwatch(), exact(WAY)
        off = [pressures(scene(law, WAY, n))[-1] - end for n in COUNTS]
        plain = [by_backward_euler(law, WAY, n) - end for n in COUNTS]
        explicit = [depth(scene(law, WAY, n, scheme="explicit")) - (1 - end) for n in COUNTS]
        step = float(pressures(scene(law, HUGE, 1))[-1])
        seconds, wanted = clock.seconds, euler_step(law, 1.0, HUGE)
        checks += [
            _check(f"p / p(0) after {COUNTS[-1]} strokes, {name} [-]", end + off[-1], end, 2e-3, seconds),
            _check(f"order of the implicit scheme, {name} [-]", _order(off), SECOND, math.nan, seconds, "above"),
            _check(f"order of backward Euler, {name} [-]", _order(plain), ORDER, math.nan, seconds, "above"),
            _check(f"order of the explicit scheme, {name} [-]", _order(explicit), ORDER, math.nan, seconds, "above"),
            _check(f"p / p(0) after one step of x = {HUGE:g}, {name} [-]", step, wanted, STEP, seconds),
        ]
    return checks


def equal_laws() -> list[Check]:
    """Depths of laws that must be the same."""
    thirion = ByPressure(light=MU, pressure=FIRST)
    power, saturating = PowerWear(exponent=1.0, reference_pressure=FIRST), SaturatingWear(pressure=FIRST)
    energy, less = FrictionalEnergyWear(), MU * WEAR_RATE
    pairs: dict[str, tuple[tuple[WearLaw, dict[str, Any]], tuple[WearLaw | None, dict[str, Any]]]] = {
        "power 1 over Archard": ((power, {}), (None, {})),
        "energy over Archard with k mu": ((energy, {"friction": MU}), (None, {"friction": MU} | _rate(less))),
        "energy by Thirion's mu over saturating": (
            (energy, {"friction": thirion}),
            (saturating, {"friction": thirion} | _rate(less)),
        ),
    }
    checks = []
    for name, both in pairs.items():
        clock = Stopwatch()
        one, other = (depth(scene(law, WAY, 5, **contact)) for law, contact in both)
        checks.append(_check(f"depth, {name} [-]", one / other, 1.0, SAME, clock.seconds))
    return checks


def _rate(rate: float) -> dict[str, Any]:
    return {"specific_wear_rate": rate}


def _with(run: Scene, wear_law: WearLaw) -> Scene:
    """The scene with another law of its contact."""
    return replace(run, contacts=(replace(run.contacts[0], wear_law=wear_law),))


def ripples() -> list[Check]:
    """Roughness of the pressure after long steps."""
    checks = []
    for name, law in RIPPLED.items():
        clock = Stopwatch()
        run = _with(stability_pair.scene("implicit", 10.0 / float(law.slope(MEAN))), wear_law=law)
        *_, state = steps(run)
        rough = stability_pair.roughness(state.reports[-1].contacts["plane"])
        quantity = f"p_max / p_mean, implicit, 10 critical steps, {name} [-]"
        checks.append(_check(quantity, rough, 1.05, math.nan, clock.seconds, "below"))
    return checks


def cylinder() -> list[Check]:
    """Depth and pressure under the cylinder with each way to follow the outline."""
    checks, m, load, radius = [], EXPONENT, worn_cylinder.LOAD, worn_cylinder.RADIUS
    block = replace(worn_cylinder.BLOCK, patch=0.025, travel=500.0)
    law = PowerWear(exponent=m, reference_pressure=load / (2 * HALF_WIDTH))
    growth = (m + 2) * radius * block.wear_rate * law.reference_pressure ** (1 - m) * (load / 2) ** m * block.travel
    count = round((HALF_WIDTH ** (m + 2) - worn_cylinder.HERTZ ** (m + 2)) / growth)
    a = (worn_cylinder.HERTZ ** (m + 2) + growth * count) ** (1 / (m + 2))
    for remesh in ("due", "never"):
        clock = Stopwatch()
        run = _with(block.scene("cylinder", (round(worn_cylinder.EVE * count), count)), wear_law=law)
        *_, state = steps(replace(run, wear=replace(run.wear, remesh=remesh)))
        deep = depth_at(state.contour, "top", block.size, 0.0)
        middle = middle_pressure(state.reports[-1].contacts[CONTACT], 0.8 * a)
        removed = (run.part.outline.area - state.contour.area) / state.ledger.worn
        how, seconds = f"cylinder, remesh '{remesh}'", clock.seconds
        checks += [
            _check(f"depth, {how} [mm]", deep, a**2 / (2 * radius), OFF, seconds),
            _check(f"mean pressure within 0.8 a, {how} [MPa]", middle, load / (2 * a), OFF, seconds),
            _check(f"area lost by the outline over the law's, {how} [-]", removed, 1.0, 1e-6, seconds),
        ]
    depths = np.array([c.value for c in checks if c.quantity.startswith("depth")])
    checks.append(_check("depth, moved nodes over new meshes [-]", depths[1] / depths[0], 1.0, 1e-4, clock.seconds))
    return checks


def run() -> list[Check]:
    """All four."""
    return [*column(), *equal_laws(), *ripples(), *cylinder()]
