"""Loss of elements under pull: bars of unequal length between two grips, and a crack that runs from a notch.

Plane strain, neo-Hooke, G = 1 MPa, K = 50 MPa. Four bars, one quadrilateral each, stand side by side on a skin of
triangles 1e-4 mm thick, which does nothing but connect them; their ends are held along y and free along x, so that
each is in uniaxial tension with the stretch 1 + u / L. By hand, apart from the package's loop and its meshes: the
lateral stretch at which sigma_xx of ``G/2 (I1_bar - 3) + K/2 (J - 1)^2`` vanishes, sigma_yy there, and each bar's
force ``w P``.

- Pulled by a displacement in steps: a bar is lost in the first step in which sigma_yy reaches the critical stress, on
  its own account, shortest first.
- Pulled by a force in steps: bars that are left take the force of a lost one; those that cannot are lost in the same
  step, one solve later. The order of losses and of their solves has to be that by hand.

The notched strip of 33 x 11 quadrilaterals, notched in its middle row to 30 % of its width: the element at the tip
has to be lost first, then one after the other straight to the far side, until the last one would cut the strip in two.
After each loss the forces at both ends balance. The bars' stresses differ from those by hand by the skin, about 1e-4.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy.optimize import brentq

from ngwear.errors import GeometryError
from ngwear.geometry.cells import Cells, Fate
from ngwear.geometry.element_body import elements
from ngwear.geometry.outline import Array
from ngwear.laws.damage import MaximumPrincipalStress, TensileNormalStress
from ngwear.loop.lost_elements import exhaustion, tear
from ngwear.loop.state import State
from ngwear.materials import NeoHooke
from ngwear.scene.boundary import Support
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.cell_blocks import grid, held, named, pull, reaction

RUBBER = NeoHooke(shear=1.0, bulk_modulus=50.0)
LENGTHS, WIDTHS = (1.0, 1.3, 1.7, 2.0), (0.1, 0.5, 0.2, 0.6)  # of the bars [mm]
SKIN, GAP = 1e-4, 0.2  # mm
CRITICAL, EVERY_MM, EVERY_N = 1.5, 0.01, 0.02  # MPa, and steps of displacement [mm] and force [N/mm]
CLOSE = 5e-4
NX, NY, TIP = 33, 11, 10  # the strip's elements, and the first one that the notch leaves in the middle row
Event = tuple[int, int, int]  # step, solve in it, bar


def uniaxial(stretch: float) -> tuple[float, float]:
    """Cauchy and nominal stress of plane-strain uniaxial tension [MPa]."""
    g, k = RUBBER.shear, RUBBER.bulk_modulus

    def cauchy(along: float, across: float) -> float:
        j = along * across
        mean = (along**2 + across**2 + 1) / 3
        return g * j ** (-5 / 3) * (along**2 - mean) + k * (j - 1)

    lateral = brentq(lambda x: cauchy(x, stretch), 0.5 / stretch, 2 / stretch, xtol=1e-14)
    return cauchy(stretch, lateral), cauchy(stretch, lateral) * lateral


def force(u: float, bars: list[int]) -> float:
    """Force of the bars that are left at a displacement of their ends [N/mm]."""
    return sum(WIDTHS[b] * uniaxial(1 + u / LENGTHS[b])[1] for b in bars)


def stretched_by(wanted: float, bars: list[int]) -> float:
    """Displacement at which they bear a force [mm]."""
    return float(brentq(lambda u: force(u, bars) - wanted, 0.0, 5.0, xtol=1e-13))


def by_hand(*, force_controlled: bool) -> list[Event]:
    """Losses in their order."""
    events, left, step = [], list(range(len(LENGTHS))), 0
    while left:
        step, solves, torn = step + 1, 0, left
        while left and torn:
            u = step * EVERY_MM
            if force_controlled:
                u = stretched_by(step * EVERY_N, left)
            torn = [b for b in left if uniaxial(1 + u / LENGTHS[b])[0] >= CRITICAL]
            solves += 1
            events += [(step, solves, b) for b in torn]
            left = [b for b in left if b not in torn]
    return events


def comb() -> Cells:
    """The bars, elements 0 to 3, and the skin below them."""
    points: list[tuple[float, float]] = []
    quads, triangles, x = [], [], 0.0
    for width, length in zip(WIDTHS, LENGTHS, strict=True):
        k = len(points)
        points += [(a, y) for a in (x, x + width) for y in (0.0, SKIN, SKIN + length)]
        quads.append((k + 1, k + 4, k + 5, k + 2))
        triangles += [(k, k + 3, k + 4), (k, k + 4, k + 1)]
        if k:
            triangles += [(k - 3, k, k + 1), (k - 3, k + 1, k - 2)]
        x += width + GAP
    place = np.array(points)

    def name(ends: Array) -> str:
        across = ends[1] - ends[0]
        if across[0] == 0:
            return "left" if across[1] < 0 else "right"
        low, high = ends[:, 1].min(), ends[:, 1].max()
        return "bottom" if high == 0 else "skin" if low < 2 * SKIN else "top"

    return named(place, [*quads, *triangles], name, np.full(len(place), -1))


def bars_of(state: State) -> list[int]:
    """Bars that are left."""
    return [b for b in range(len(LENGTHS)) if elements(state.stage.body).cells.living[b]]


def pull_by_force(state: State, wanted: float) -> float:
    """Displacement at which the reaction is the wanted force, by secants [mm]."""
    u = stretched_by(wanted, bars_of(state))  # near to it; the reaction decides
    pull(state, "top", u)
    for _ in range(5):
        off = reaction(state, "top") - wanted
        if abs(off) < 1e-10 * wanted:
            break
        slope = (force(1.001 * u, bars_of(state)) - force(u, bars_of(state))) / (0.001 * u)
        u -= off / slope
        pull(state, "top", u)
    return u


def pulled_comb(*, force_controlled: bool) -> tuple[list[Event], float, float, float]:
    """Losses; worst errors of the forces' balance, of the stress and of the force against those by hand."""
    supports = (Support(edges=("bottom", "top"), x=False), Support(edges=("left",), y=False))
    criterion = TensileNormalStress if force_controlled else MaximumPrincipalStress
    state = held(comb(), RUBBER, supports, criterion(critical=CRITICAL))
    events: list[Event] = []
    step, balance, stress, forces = 0, 0.0, 0.0, 0.0
    while left := bars_of(state):
        step, solves, torn = step + 1, 0, True
        while torn and (left := bars_of(state)):
            u = step * EVERY_MM
            if force_controlled:
                u = pull_by_force(state, step * EVERY_N)
            else:
                pull(state, "top", u)
            top, hand = reaction(state, "top"), force(u, left)
            balance = max(balance, abs(top + reaction(state, "bottom")) / top)
            forces = max(forces, abs(top / hand - 1))
            cauchy = np.array([uniaxial(1 + u / LENGTHS[b])[0] for b in left])
            stress = max(stress, np.abs(exhaustion(state, 1)[left] * CRITICAL / cauchy - 1).max())
            solves += 1
            try:
                torn = tear(state, state.contour, 1)
            except GeometryError as error:  # nothing is left to pull
                if "nothing of the edges ['top'] is left" not in str(error):
                    raise
                return [*events, *((step, solves, b) for b in left)], balance, stress, forces
            events += [(step, solves, b) for b in left if b not in bars_of(state)]
    return events, balance, stress, forces


def crack() -> Iterator[tuple[list[int], float]]:
    """Pull the notched strip: elements torn in each solve that tears any, and the balance of forces after it."""
    present = np.ones((NY, NX), dtype=bool)
    present[NY // 2, :TIP] = False
    supports = (Support(edges=("bottom", "top")),)
    cells = grid(np.linspace(0, 3, NX + 1), np.linspace(0, 1, NY + 1), present)
    state = held(cells, RUBBER, supports, MaximumPrincipalStress(critical=CRITICAL))
    for step in range(1, 200):
        pull(state, "top", 0.005 * step)
        before = elements(state.stage.body).cells
        while tear(state, state.contour, 1):
            after = elements(state.stage.body).cells
            torn = np.flatnonzero(before.living & (after.fate == Fate.TORN))
            loose = int((after.fate == Fate.LOOSE).sum())
            pull(state, "top", 0.005 * step)
            top, bottom = reaction(state, "top"), reaction(state, "bottom")
            yield [*torn.tolist(), *[-1] * loose], abs(top + bottom) / abs(top)
            before = after


def run() -> list[Check]:
    """Order of losses of the bars and of the crack, forces and stresses."""
    checks, clock = [], Stopwatch()

    def add(quantity: str, value: float, reference: float, tolerance: float) -> None:
        checks.append(Check("notched_strip", quantity, value, reference, tolerance, clock.seconds))

    for controlled, how in ((False, "displacement"), (True, "force")):
        clock.start()
        hand = by_hand(force_controlled=controlled)
        found, balance, stress, forces = pulled_comb(force_controlled=controlled)
        filled = [*found, *[(math.nan, math.nan, math.nan)] * (len(hand) - len(found))]
        for number, (mine, theirs) in enumerate(zip(hand, filled, strict=True), start=1):
            for what, reference, value in zip(("step", "solve in it", "bar"), mine, theirs, strict=True):
                add(f"loss {number} under {how}: {what} [-]", value, reference, 0.0)
        add(f"forces at both ends, worst imbalance under {how} [-]", balance, 0.0, 1e-8)
        add(f"stress of a bar against that by hand, worst error under {how} [-]", stress, 0.0, CLOSE)
        add(f"force against that by hand, worst error under {how} [-]", forces, 0.0, CLOSE)

    clock.start()
    order, balance, cut = [], 0.0, 0.0
    try:
        for torn, off in crack():
            order += torn
            balance = max(balance, off)
    except GeometryError as error:
        cut = float("cut in two" in str(error))
    first = (NY // 2) * NX  # the middle row's first element by number: the row has NX - TIP
    straight = list(range(first, first + NX - TIP))
    same = [a == b for a, b in zip(order, straight, strict=False)]
    add("first element that is lost: that at the notch [-]", order[0] if order else math.nan, first, 0.0)
    add("elements lost in the crack's straight order [-]", sum(same), len(order), 0.0)
    add("elements lost before the strip is cut in two [-]", len(order), NX - TIP - 1, 0.0)
    add("strip cut in two at the end [-]", cut, 1.0, 0.0)
    add("forces at both ends of the strip, worst imbalance [-]", balance, 0.0, 1e-8)
    return checks
