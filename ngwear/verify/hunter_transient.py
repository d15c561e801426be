"""Hunter's problem in time: the cylinder pressed on a block at rest and slid until its friction no longer changes.

Problem, closed form and scaling as in ``hunter``. ``sliding.passing`` marches over a block that is fixed in space with
the exact integration of the arms, and shares with the direct steady solve only the equilibrium: neither the frame of
the slider, nor the transport along rows, nor the iteration for the history.

Both are timed in this one run (processor time). The direct solve takes the coarsest of six meshes whose friction is at
least as close to the closed form as the march's, so that a ratio of 3 means three times cheaper at equal error or
better. The march is dear where the contact is long against V tau (fine elements, a contact hard to find) or the wake
long against the contact (a long track). In between it needs some twenty steps only. Measured in two runs, from 1
to 2000 mm/s: 17, 5.5 to 6.6, 3.5, 4.2, 4.2 to 5.2, 4.0 and 156 to 211; over all speeds 35, what a curve costs.

Equal is the error of the friction alone. Where the march is off by 1 % (20 to 50 mm/s) the direct solve makes do with
two elements in the middle of the contact and fine ones at its ends, and its half length is 2 to 4 % off.

Missed: at 200 mm/s the march happens to be 0.06 % off, and the direct solve comes no nearer than 0.09 % however fine.
"""

from __future__ import annotations

import numpy as np

from ngwear.materials import PronySeries
from ngwear.sliding.asperity import Asperity, Slide, slide
from ngwear.sliding.passing import slide_in_time
from ngwear.verify.base import Bound, Check
from ngwear.verify.hunter import ARM, LOAD, LONG_TERM, RADIUS, RUBBER, SCALE, SPEEDS, TIME, closed_form

FINENESS = 8.0  # of the march
DIRECT = (1.0, 2.0, 4.0, 6.0, 8.0, 12.0)  # of the direct solve


def at_least_as_close(asperity: Asperity, speed: float, wanted: float, allowed: float) -> tuple[Slide, float]:
    """The direct solve on the coarsest mesh whose friction is off by no more than allowed [-], else on the finest.

    Also its processor time [s], the median of three: one of half a second is noisy.
    """
    for fineness in DIRECT:
        found = slide(asperity, speed, fineness=fineness)
        if abs(found.friction - wanted) <= allowed:
            break
    again = [slide(asperity, speed, fineness=fineness).cpu_seconds for _ in range(2)]
    return found, float(np.median([found.cpu_seconds, *again]))


def run() -> list[Check]:
    """Friction in time at seven speeds, and what it costs over the direct solve."""
    arms = PronySeries.from_moduli([ARM], [TIME], long_term=LONG_TERM)
    asperity = Asperity(material=RUBBER, series=arms, radius=SCALE * RADIUS, load=LOAD / SCALE)
    checks: list[Check] = []

    def check(quantity: str, value: float, wanted: float, tolerance: float, seconds: float, bound: Bound) -> None:
        checks.append(Check("hunter_transient", quantity, value, wanted, tolerance, seconds, bound=bound))

    marched = solved = 0.0
    for speed in SPEEDS:
        exact = closed_form(speed)["friction"] / SCALE
        passage = slide_in_time(asperity, speed, fineness=FINENESS)
        allowed = abs(passage.steady - exact)
        direct, cost = at_least_as_close(asperity, speed, exact, allowed)
        marched, solved = marched + passage.cpu_seconds, solved + cost
        seconds = passage.cpu_seconds + cost
        friction, at = passage.steady * SCALE, f"at {speed:g} mm/s"
        check(f"friction coefficient in time {at} [-]", friction, exact * SCALE, 0.02, passage.cpu_seconds, "near")
        off = abs(direct.friction - exact)
        quantity = f"relative error of the direct solve, at most that in time, {at} [-]"
        check(quantity, off / exact, allowed / exact, 0.0, seconds, "below")
        check(f"CPU seconds in time over direct {at} [-]", passage.cpu_seconds / cost, 3.0, 0.0, seconds, "above")
    check("CPU seconds in time over direct, all speeds [-]", marched / solved, 3.0, 0.0, marched + solved, "above")
    return checks
