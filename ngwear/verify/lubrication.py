"""A block on a plane that starves of lubricant: what friction and wear by the distance must add up to.

Plane strain block of 1.6 x 1 mm (E = 1 MPa, nu = 0.4995), bottom bonded, pressed on a rigid plane with F = 1.6e-4 N/mm:
strains near 1e-4, so that the normal force is F whatever the friction does. Cycles of 75 mm forth and 25 mm back are
jumped; friction and wear follow tables over 15 m with four phases and with five rows.

References: friction over load is the table's mu in the middle of what each solve stands for; the friction's heat is
``F int mu ds`` and the worn area ``k F s`` becomes ``F int k ds``, both in closed form. The heat may be off by the
hundredth that a jump's friction may lag behind its mean; the area is exact, since ``int k ds`` of each step is.

Order: with mu rising as the square of the distance and all jumps alike, the heat's error shall fall with the square of
the jump. The most that a jump may change a law by, five times ``wear_error``, is a tenth of its highest value here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ngwear.geometry.outline import Outline
from ngwear.laws import FrictionLaw, Lubrication, WearRate
from ngwear.loop.run import run as run_scene
from ngwear.materials import NeoHooke
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Support
from ngwear.scene.contact import Contact
from ngwear.scene.options import Wear
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Plane
from ngwear.verify.base import Check, Stopwatch

CASE = "lubrication"
HALF, HEIGHT, PATCH, FORCE = 0.8, 1.0, 0.1, 1.6e-4
CYCLE = (Stroke(name="forth", travel=75.0), Stroke(name="back", travel=25.0, direction=-1.0))
END = 15000.0
PHASES = Lubrication.four_phases(film=0.06, boundary=0.35, dry=1.1, ends=(3010.0, 6030.0, 9950.0))
RATES = WearRate(distance=(0.0, 3010.0, 6030.0, 9950.0, 12000.0), rate=(0.0, 1e-4, 2e-4, 1e-3, 5e-4))
JUMPS = (8, 4, 2)


@dataclass(frozen=True)
class Square(FrictionLaw):
    """``mu = 0.5 + rise (s / END)^2``."""

    rise: float = 0.04

    def held(self, distance: float, speed: float | None) -> tuple[float, ...]:
        return (0.5 + self.rise * (distance / END) ** 2,)

    @property
    def words(self) -> str:
        return "by the square of the distance"


def scene(friction: FrictionLaw, rate: WearRate | float) -> Scene:
    """The block with its laws; jumps as long as the laws allow."""
    counter = Plane(point=(0.0, HEIGHT), normal_vector=(0.0, -1.0))
    plane = Contact(
        name="plane", edges=("top",), surface=counter, force=FORCE, friction=friction, specific_wear_rate=rate
    )
    return Scene(
        name=CASE,
        part=Part(Outline.rectangle((-HALF, HALF), (0.0, HEIGHT)), material=NeoHooke.from_young(1.0, 0.4995)),
        contacts=(plane,),
        supports=(Support(edges=("bottom",)),),
        program=Program(cycle=CYCLE, strokes=round(2 * END / 100)),
        accuracy=Accuracy(patch=PATCH, coarse=0.3, mounting=PATCH, wear_error=0.02, longest_jump=1.0),
        axisymmetric=False,
    )


def heat(rows: list[dict[str, Any]]) -> float:
    """Friction's heat of all strokes [mJ/mm]."""
    return sum(row["strokes in one solve [-]"] * row["plane friction heat of the stroke [mJ/mm]"] for row in rows)


def middle(row: dict[str, Any]) -> float:
    """Sliding distance in the middle of the strokes that a solve stands for, counted by hand [mm]."""
    repeats, back = row["strokes in one solve [-]"], row["kind [-]"] == "back"
    before = row["stroke [-]"] - repeats - (repeats if back else 0)
    start = 50.0 * before + (75.0 if back else 0.0)
    return start + 0.5 * (100.0 * (repeats - 1) + (25.0 if back else 75.0))


def run() -> list[Check]:
    """Coefficient, heat and worn area under tables; the largest change in a jump; order of the heat."""
    clock, checks = Stopwatch(), []

    def add(quantity: str, value: float, reference: float, tolerance: float, **options: Any) -> None:
        checks.append(Check(CASE, quantity, value, reference, tolerance, clock.seconds, **options))

    result = run_scene(scene(PHASES, RATES), figures=False)
    rows = [row for row in result.records.rows if row["strokes in one solve [-]"] > 0]
    off = [
        abs(row["plane friction force x [N/mm]"] / row["plane force y [N/mm]"]) - PHASES.mu(middle(row)) for row in rows
    ]
    add("friction force over load against the table, largest difference [-]", float(np.abs(off).max()), 0.0, 1e-9)
    forth = [row["plane friction coefficient [-]"] for row in rows if row["kind [-]"] == "forth"]
    highest = PHASES.curve().extremes(0.0, END)[1]
    add(
        "largest change of friction between two solves over its highest value [-]",
        float(np.abs(np.diff(forth)).max()) / highest,
        0.1,
        math.nan,
        bound="below",
    )
    add("friction heat over F int mu ds [-]", heat(rows) / (FORCE * PHASES.curve().mean(0.0, END) * END), 1.0, 1e-2)
    worn = FORCE * RATES.curve.mean(0.0, END) * END
    add("worn area over F int k ds [-]", result.summary["worn area [mm^2]"] / worn, 1.0, 1e-4)
    add("strokes over solves [-]", result.summary["strokes"] / result.summary["solves"], 3.0, math.nan, bound="above")

    law, last = Square(), math.nan
    exact = FORCE * END * (0.5 + law.rise / 3)
    for jump in JUMPS:
        clock.start()
        jumping = replace(scene(law, 0.0), wear=Wear(max_jump=jump))
        error = abs(heat(run_scene(jumping, figures=False).records.rows) / exact - 1)
        if not math.isnan(last):
            add(
                f"order of the heat's error, jumps of {2 * jump} to {jump} cycles [-]",
                math.log2(last / error),
                1.9,
                0.0,
                bound="above",
            )
        last = error
    return checks
