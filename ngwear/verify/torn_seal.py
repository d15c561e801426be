"""The shipped section that loses elements (case C5): what it loses in 60 min, and how far that depends on its settings.

- The scene as shipped: it ends; wear takes at least ten elements' sides off, layer after layer; friction tears elements
  out; the lip and the ridges beside it are worn most; what each cause takes adds up to the section's loss.
- The same hour with two and with eight evaluations a cycle instead of four, and with half the error that a jump may
  make: area lost in all and greatest depth over those of the scene as shipped, and the share of the torn area. With
  elements of half the side, both meshes with two evaluations a cycle, which halves the time that this takes. Only the
  area on the finer mesh has a bound that was asked for (10 %). For the rest nobody has derived a reference: the bounds
  are above what was measured, and say what the scene's choices are worth.
- What the hour states of its own errors (``error_estimates``), over what it differs by from the finer elements. What is
  torn grows with every finer mesh, and no coarser one tells: all of it counts as error of the area lost, and of the
  depth as far as that grows with the area.
  The outward peak stands at the end of the worn flat, over few elements, and grows with every finer mesh.

Units: mm, N, MPa. Its runs go two at a time on two cores and take 4,000 to 10,400 CPU s together, half of them the
finer mesh: with a folder, a verification that was stopped goes on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from ngwear.errors import NgwearError
from ngwear.loop.result import Result
from ngwear.loop.run import run as run_scene
from ngwear.parallel.sweep import Outcome, sweep
from ngwear.results.quantities_of_interest import quantities
from ngwear.results.recorder import LOST_AREAS
from ngwear.results.richardson import relative_errors
from ngwear.scene.program import Stroke
from ngwear.scene.scene import Scene
from ngwear.verify.base import Bound, Check, Stopwatch
from ngwear.verify.error_estimates import effectivities, stated_of
from ngwear.verify.rod_seal import shipped_scene

CASE = "torn_seal"
FINER_DEPTH = 0.34  # mm, of the finer layers: the hour wears 0.26
SHIPPED = "as shipped"


def finer(scene: Scene) -> Scene:
    """The scene with elements of half the side."""
    accuracy = replace(scene.accuracy, patch=scene.accuracy.lengths.patch / 2)
    deactivation = scene.deactivation and replace(scene.deactivation, depth=FINER_DEPTH)
    return replace(scene, accuracy=accuracy, deactivation=deactivation)


def careful(scene: Scene) -> Scene:
    """The scene with jumps that may err by half as much."""
    return replace(scene, accuracy=replace(scene.accuracy, wear_error=scene.accuracy.tolerances.wear_error / 2))


def evaluated(scene: Scene, evaluations: int) -> Scene:
    """The scene with so many evaluations a cycle, an even number, over the same way in the same time."""
    program = scene.program
    half, way = evaluations // 2, sum(stroke.travel for stroke in program.cycle) / evaluations
    speed = program.cycle[0].speed
    cycle = tuple(
        Stroke(name=f"{name} {k + 1}", direction=direction, travel=way, speed=speed)
        for name, direction in (("outward", -1.0), ("inward", 1.0))
        for k in range(half)
    )
    cycles = program.strokes // len(program.cycle)
    return replace(scene, program=replace(program, cycle=cycle, strokes=cycles * evaluations))


TWO = "two evaluations a cycle"
VARIANTS: dict[str, tuple[str, Callable[[Scene], Scene], float, float]] = {
    TWO: (SHIPPED, lambda scene: evaluated(scene, 2), 0.01, 0.01),
    "eight evaluations a cycle": (SHIPPED, lambda scene: evaluated(scene, 8), 0.01, 0.01),
    "half the error of a jump": (SHIPPED, careful, 0.01, 0.01),
    "elements of half the side": (TWO, lambda scene: finer(evaluated(scene, 2)), 0.10, 0.01),
}


def run(folder: Path | None = None) -> Iterator[Check]:
    """Run the case, going on with what there is in a folder."""
    scene, longest_first = _scene(SHIPPED), [*reversed(VARIANTS), SHIPPED]
    results = {outcome.point: _found(outcome) for outcome in sweep(partial(_hour, folder), longest_first)}
    yield from whole(scene, results[SHIPPED])
    yield _check("torn share of the area lost [-]", _torn(results[SHIPPED]), 0.0, _seconds(results[SHIPPED]), "above")
    for name, (of, _, area, depth) in VARIANTS.items():
        seconds = _seconds(results[name])
        for quantity, tolerance in (("area lost in all [mm^2]", area), ("maximum depth [mm]", depth)):
            label = f"{quantity[: quantity.index(' [')]} over that {of}, {name} [-]"
            ratio = results[name].summary[quantity] / results[of].summary[quantity]
            yield Check(CASE, label, ratio, 1.0, tolerance, seconds)
        torn = _torn(results[name])
        yield _check(f"torn share of the area lost, {name} [-]", torn, 0.0, seconds, "above")
    watch, mine = Stopwatch(), results[TWO]
    pair = (mine, results["elements of half the side"])
    true = relative_errors(*(quantities(result.records.rows) for result in pair))
    said = stated_of(mine, _scene(TWO))
    yield from effectivities(CASE, scene.name, said, true, watch.seconds)


def _scene(name: str) -> Scene:
    """The shipped scene, or one of its variants, which keep nothing."""
    scene = shipped_scene(folder="torn_seal")
    return scene if name == SHIPPED else VARIANTS[name][1](replace(scene, save=replace(scene.save, strokes=())))


def _hour(folder: Path | None, name: str) -> Result:
    """What one of them finds, as it can be sent from one process to another; gone on with in its part of a folder."""
    out = None if folder is None else folder / name.replace(" ", "_")
    return replace(run_scene(_scene(name), out=out, resume=out is not None, figures=False), state=None)


def _found(outcome: Outcome) -> Result:
    if outcome.failure is not None:
        raise NgwearError(f"{CASE}, {outcome.point}: {outcome.failure.traceback}")
    return outcome.result


def _seconds(result: Result) -> float:
    return result.summary["CPU time [s]"]


def whole(scene: Scene, result: Result) -> list[Check]:
    """Sixty minutes as shipped."""
    summary, seconds = result.summary, _seconds(result)
    side = scene.accuracy.lengths.patch
    lost = summary["area lost in all [mm^2]"]
    booked = sum(summary[f"area lost by {cause} [mm^2]"] for cause in LOST_AREAS.values()) + summary["worn area [mm^2]"]
    ranked = [summary[f"{edge} depth [mm]"] for edge in ("lip", "left ridges", "heel")]
    return [
        _check("time that is done [min]", scene.program.elapsed(summary["strokes"]) / 60.0, 60.0, seconds, "above"),
        _check("depth over the elements' side [-]", summary["maximum depth [mm]"] / side, 10.0, seconds, "above"),
        _check("area lost by tearing [mm^2]", summary["area lost by tearing [mm^2]"], 1e-3, seconds, "above"),
        _check("depth of the ridges over the lip's [-]", ranked[1] / ranked[0], 1.0, seconds, "below"),
        _check("depth of the heel over the ridges' [-]", ranked[2] / ranked[1], 1.0, seconds, "below"),
        Check(CASE, "area lost by all causes over the section's loss [-]", booked / lost, 1.0, 1e-9, seconds),
    ]


def _check(quantity: str, value: float, reference: float, seconds: float, bound: Bound) -> Check:
    return Check(CASE, quantity, value, reference, 0.0, seconds, bound=bound)


def _torn(result: Result) -> float:
    summary = result.summary
    return float(np.divide(summary["area lost by tearing [mm^2]"], summary["area lost in all [mm^2]"]))
