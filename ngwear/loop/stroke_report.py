"""Report of a stroke's equilibrium: contacts, forces, friction, fluid, and what a reader must know of the solve."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ngwear.loop.section_snapshot import section_snapshot
from ngwear.loop.solution_checks import findings
from ngwear.loop.state import State, StrokeReport
from ngwear.scene.scene import Scene
from ngwear.wear.sliding_distance import Strokes

Forces = dict[str, NDArray[np.float64]]  # resultants on the part in a stroke, as of ``Stage.forces``


def stroke_report(
    scene: Scene,
    state: State,
    index: int,
    sliding: Strokes,
    *,
    iterations: int,
    loaded: dict[str, NDArray[np.float64]],
) -> StrokeReport:
    """Report of the present equilibrium, that of stroke ``index`` of the cycle, before its wear over ``sliding``.

    ``loaded``: displacement and stresses of the outline's points, if elements may be lost.
    """
    stage = state.stage
    kept = sliding.repeats == 0 or state.strokes + sliding.repeats in scene.kept
    profiles = {spec.name: stage.contacts[spec.name].profile() for spec in scene.followed}
    forces, worn = stage.forces(), sliding.repeats > 0 or state.ledger.worn > 0
    return StrokeReport(
        phase=index,
        last_stroke=state.strokes,
        repeats=0,
        iterations=iterations,
        contacts=profiles,
        forces=forces,
        heats={name: friction.heat(sliding.travel) for name, friction in stage.frictions.items()},
        margins=stage.margins(),
        coefficients={name: friction.mean() for name, friction in stage.frictions.items() if friction.varies},
        wear_rates={c.name: sliding.wear_rate(c.wear_rate) for c in scene.contacts if c.wear_rate.varies},
        counters=state.counters,
        leaks=any(fluid.leaks for fluid in stage.fluids.values()),
        leak_pressure=stage.leak_pressure(),
        blow_by=stage.blow_by(),
        comes_further=stage.fluid_may_come_further(),
        contour=state.contour,
        ledger=state.ledger.copy(),
        cells=state.cells,
        loaded=loaded,
        section=section_snapshot(stage) if kept else {},
        turned=stage.problem.turned() if stage.floats else 0.0,
        trapped=None if stage.trapped is None else float(stage.trapped.pressures.max()),
        findings=findings(stage, profiles, forces, scene.program.cycle[index], worn=worn),
    )
