"""The rod seal with cycle jumps against the same with each of its 200 strokes solved.

Both runs share mesh settings and scene, so that only the wear step differs. The error that the jump run
reports of itself, from the embedded pair of backward differences and the trapezoidal rule, shall be at least half
of the true one. With tolerances and element edges twice as large the steps err by more than a percent of the depth, and
the estimate shall lie within 0.5 and 3 of that: it has the errors of all steps, as contacts even them out since.

Even jumps of two cycles over the first 48 strokes against single ones, on coarser elements: steps of second order
differ little there. An outline that loses depths instead of areas is of first order at a sharp lip, whose points come
closer. With 6, 8, 12 and 16 elements across (``ACROSS``) they differ by 0.09, 0.18, 0.21 and 0.15 %. Takes a few
minutes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from ngwear.error_estimates.coarser_runs import coarser_scene
from ngwear.loop.run import run as run_scene
from ngwear.scene.scene import Scene
from ngwear.verify.base import BAND, Check, Stopwatch
from ngwear.verify.rod_seal import shipped_scene

CASE = "rod_seal_jumps"
BEGINNING = 48  # strokes
ACROSS = 6.0  # elements


def run() -> Iterator[Check]:
    """Run the case."""
    watch = Stopwatch()
    scene = shipped_scene()
    jumps = run_scene(scene).summary
    each = run_scene(replace(scene, wear=replace(scene.wear, step="each"))).summary
    seconds = watch.seconds
    checks = []
    for quantity, estimate in (("lip depth [mm]", "maximum depth [-]"), ("worn area [mm^2]", "worn area [-]")):
        checks.append(Check(CASE, quantity, jumps[quantity], each[quantity], 0.01, seconds))
        true = abs(jumps[quantity] - each[quantity]) / each[quantity]
        name = f"reported over true error of {quantity[: quantity.index(' [')]} [-]"
        reported = jumps["error estimates"][estimate]
        checks.append(Check(CASE, name, reported / max(true, 1e-12), 0.5, 0.0, seconds, bound="above"))
    yield from checks
    watch.start()
    loose = coarser_scene(scene)
    jumps, each = (run_scene(s).summary for s in (loose, replace(loose, wear=replace(loose.wear, step="each"))))
    true = abs(jumps["lip depth [mm]"] / each["lip depth [mm]"] - 1.0)
    ratio = jumps["error estimates"]["maximum depth [-]"] / true
    for limit, bound in BAND:
        name = f"the same of the depth with tolerances twice as large, {bound} {limit:g} [-]"
        yield Check(CASE, name, ratio, limit, 0.0, watch.seconds, bound=bound)
    watch.start()
    pairs, single = (run_scene(even(scene, cycles)).summary["lip depth [mm]"] for cycles in (2, 1))
    name = "lip depth in jumps of two cycles over that in single ones [-]"
    yield Check(CASE, name, pairs / single, 1.0, 0.002, watch.seconds)


def even(scene: Scene, cycles: int) -> Scene:
    """The beginning of the scene in jumps of so many cycles, on coarser elements."""
    program = replace(scene.program, strokes=BEGINNING)
    longest = cycles * len(program.cycle) / BEGINNING
    accuracy = scene.accuracy.with_across(ACROSS, wear_error=0.05, longest_jump=longest, depth_error=1.0)
    return replace(scene, program=program, accuracy=accuracy, save=replace(scene.save, strokes=()))
