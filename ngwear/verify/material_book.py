"""The book of lost material adds up at every row, and what the number of evaluations a cycle changes.

The block and the cylinder of ``verify.no_loss``.

- Tearing from 0.2 MPa with mu = 0.4, and a filter that already finds triangles with corners below 37 degrees far away
  from the contact: wear, tearing, distortion and fragments that come loose all occur within 6 strokes. At every row of
  the series the areas lost by these causes add up to what the section, its living elements summed here, has lost since
  the start; what is lost in each solve adds up to the whole.
- The same motion, 4 cycles of 60 mm, in 2, 4 and 8 strokes of a cycle, no elements lost, implicit wear: greatest depth
  over that in 8 strokes. Both bounds are measured: the block wears 0.8 % less deep in 2 strokes a cycle and 0.3 % in 4,
  about in proportion to the length of a stroke, as one pressure stands for all of it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ngwear.geometry.cells import Cells
from ngwear.laws.damage import MaximumPrincipalStress
from ngwear.loop.run import run as run_scene
from ngwear.loop.state import State
from ngwear.results.recorder import LOST, LOST_AREAS
from ngwear.scene.deactivation import DistortionFilter
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.no_loss import scene

CAUSES = ("wear", *LOST.values())  # all at work here
BOOKED = ("wear", *LOST_AREAS.values())
CYCLES, WAY = 4, 60.0  # mm, to and fro
BOUND = {2: 1e-2, 4: 4e-3}  # of the depth, by strokes a cycle


def torn_scene() -> Scene:
    """All causes at work; the first stroke has no friction, so that nothing is torn while the block is fitted."""
    cycle = (
        Stroke(name="still", travel=1.0, direction=0.0),
        Stroke(name="forth", travel=10.0),
        Stroke(name="back", travel=10.0, direction=-1.0),
    )
    damage, sieve = MaximumPrincipalStress(critical=0.2), DistortionFilter(corner_cosine=0.8)
    base = scene("implicit", cycle, damage=damage, distortion=sieve)
    (spec,) = base.contacts
    contacts = (replace(spec, friction=0.4, specific_wear_rate=3e-3),)
    return replace(base, contacts=contacts, program=replace(base.program, strokes=6))


def area(cells: Cells) -> float:
    """Area of the living elements by their corners, one by one [mm²]."""
    total = 0.0
    for corners in cells.corners[cells.living].tolist():
        x, y = cells.points[[c for c in corners if c >= 0]].T
        total += 0.5 * float(x @ np.roll(y, -1) - np.roll(x, -1) @ y)
    return total


def deepest(strokes: int) -> float:
    """Greatest depth when the motion of a cycle is split into so many strokes [mm]."""
    half, way = strokes // 2, WAY / strokes
    cycle = [Stroke(name=f"forth {k}", travel=way) for k in range(half)]
    cycle += [Stroke(name=f"back {k}", travel=way, direction=-1.0) for k in range(half)]
    split = scene("implicit", tuple(cycle))
    split = replace(split, program=Program(cycle=tuple(cycle), strokes=strokes * CYCLES))
    return float(run_scene(split).summary["maximum depth [mm]"])


def run() -> list[Check]:
    """The book of the torn block, and depths by strokes a cycle."""
    checks, clock = [], Stopwatch()

    def add(quantity: str, value: float, reference: float, tolerance: float) -> None:
        checks.append(Check("material_book", quantity, value, reference, tolerance, clock.seconds))

    left: list[float] = []

    def look(state: State) -> None:
        left.extend(area(report.cells) for report in state.reports if report.cells is not None)

    rows = run_scene(torn_scene(), on_step=look).records.rows
    table = np.array([[row[f"area lost by {cause} [mm^2]"] for cause in BOOKED] for row in rows])
    solves = np.array([[row[f"area lost by {cause} in this solve [mm^2]"] for cause in BOOKED] for row in rows])
    lost = left[0] - np.array(left)
    for cause, total in zip(CAUSES, table[-1], strict=False):
        checks.append(
            Check("material_book", f"area lost by {cause} [mm²]", total, 1e-3, 0.0, clock.seconds, bound="above")
        )
    add("rows that are compared [-]", len(rows), len(left), 0.0)
    add(
        "area lost by all causes against the section's, worst row [-]",
        np.abs(table.sum(axis=1) - lost).max() / 8,
        0.0,
        1e-9,
    )
    in_all = np.array([row["area lost in all [mm^2]"] for row in rows])
    add(
        "column of the area lost in all against the section's, worst row [-]",
        np.abs(in_all - lost).max() / 8,
        0.0,
        1e-9,
    )
    add("sum over the solves against the whole [-]", np.abs(solves.cumsum(axis=0) - table).max() / 8, 0.0, 1e-9)

    clock.start()
    depth = {strokes: deepest(strokes) for strokes in (2, 4, 8)}
    for strokes, bound in BOUND.items():
        add(f"depth in {strokes} strokes a cycle over that in 8 [-]", depth[strokes] / depth[8], 1.0, bound)
    return checks
