"""The errors that runs state of themselves against true ones: the shipped scenes of wear by moved nodes.

A run states what it differs by from a companion that is twice as coarse (``ngwear.companion``). True is what it
differs by from a run with elements of half the edge and jumps that may err by half as much; where errors are of first
order that is half of the whole error, and an exact estimate would have an effectivity of 2. Wanted is 0.5 to 3. Below
0.1 % neither of them can be told from the chance of where a new mesh falls: both count as at least that.

Two miss the band, on the safe side: the shaft's peak pressure and the contact width under starving lubrication, where a
companion of so few elements across the contact errs by more than a first order would.

Takes some minutes.
"""

from __future__ import annotations

from ngwear.companion import COARSER, coarser, estimates, reading, scaled
from ngwear.run import run as run_scene
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.rod_seal import shipped_scene

CASE = "error_estimates"
FOLDERS = ("shaft_on_plate", "starving_lubrication", "rod_seal")
LEAST = 1e-3  # relative error that can be told from chance
BAND = (0.5, 3.0)


def run() -> list[Check]:
    """Run the case."""
    checks = []
    for folder in FOLDERS:
        watch, scene = Stopwatch(), shipped_scene(folder=folder)
        results = [run_scene(s, figures=False) for s in (coarser(scene), scene, scaled(scene, 1 / COARSER))]
        coarse, mine, fine = (reading(r.summary, r.recorder.rows) for r in results)
        stated, true = estimates(mine, coarse), estimates(mine, fine)
        for name in stated:
            ratio = max(stated[name], LEAST) / max(true[name], LEAST)
            words = f"{folder}: stated over true error of the {name[:-4]}"
            for limit, bound in zip(BAND, ("above", "below"), strict=True):
                checks.append(
                    Check(CASE, f"{words}, {bound} {limit:g} [-]", ratio, limit, 0.0, watch.seconds, bound=bound)
                )
    return checks
