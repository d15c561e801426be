"""What the run's own choices save: levels of ``Accuracy(error=...)`` against fixed settings, at equal error of depth.

A fixed setting is an element edge and a number of cycles in a jump, for the whole run, of two kinds: with a mesh that
is as fine along all worn edges, as one draws it who does not know where the contact will be (``edges``), and with one
that is fine where the wear may take the contact (``contact``, ``wear.remesh = "limit"``). All else is the same: solver,
wear step, outline.

The error is that of the maximum depth, over its last value: the largest one along the run, its steps joined by lines as
the history is drawn, and beside it that at the end, where steps that were far too long may have made up for each other.
The reference has twice as many elements across as the finest level, and steps of a hundredth of the program. For each
level the cheapest fixed setting is sought that errs no more, by processor time of the run, after a short one that loads
all packages. Level and setting are then run again, by turns, and the least time of each counts: a shared machine is
slower from one minute to the next.

Usage: python adaptive_against_fixed.py [SCENE ...]
       python adaptive_against_fixed.py --subject KIND SETTING JUMP SCENE
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from subjects import SUBJECT, measure, say

GEOMETRIES = Path(__file__).parents[2] / "geometries"
DEPTH, STROKE, KIND = "maximum depth [mm]", "stroke [-]", "kind [-]"
STEP = 0.01  # of the program: the reference's longest
FEW = 2.0  # elements across
CASES = {  # of each scene: elements across, cycles in a jump, edges in the contact [mm], and along the edges
    "shaft_on_plate": ((3.0, 6.0, 12.0, 24.0), (50, 25, 10, 5, 2), (0.4, 0.2, 0.1, 0.05), (0.4, 0.2, 0.1, 0.05)),
    "rod_seal": ((2.5, 4.0, 8.0, 12.0), (25, 10, 5, 2), (0.08, 0.04, 0.02, 0.01, 0.005), (0.08, 0.04, 0.02, 0.01)),
}
ERRORS = ("along the run", "at the end")
TURNS = 2  # of a level and the setting that it is compared with


def fine_along_the_edges(edge):
    """Let meshes be fine along all worn edges, for the whole run."""
    from ngwear.geometry.sizing import SizeField, fitted
    from ngwear.loop import mounting, refinement, remeshing

    def field(scene, across=None):
        contour, accuracy = scene.part.outline, scene.accuracy
        everywhere = SizeField(contour.points, np.full(len(contour), edge), edge)
        dense = fitted(contour, everywhere)
        on = dense.on(scene.worn_edges)
        seeds = dense.points[on | np.roll(on, 1)]
        return SizeField(seeds, np.full(len(seeds), edge), accuracy.coarse, accuracy.grading)

    def wanted(stage, phases, **_):
        return field(stage.scene)

    mounting.mounting_field = field
    for module in (refinement, remeshing):
        module.required_sizes = wanted


def subject(kind, setting, jump, name):
    """One run, as JSON on the last line."""
    from ngwear.error_estimates.run_to_error import at_level
    from ngwear.loop.run import run
    from ngwear.scene.accuracy import Accuracy
    from ngwear.scene.read_scene import read_scene

    scene = read_scene(GEOMETRIES / name / "scene.toml")
    scene = replace(scene, save=replace(scene.save, strokes=()))
    if kind in ("adaptive", "reference"):
        scene = at_level(scene, setting)
        if kind == "reference":
            scene = replace(scene, accuracy=replace(scene.accuracy, longest_jump=STEP))
    else:
        own = Accuracy() if scene.accuracy.error is not None else scene.accuracy  # the usual lengths
        lengths = {"patch": setting, "mounting": max(setting, own.mounting), "coarse": max(setting, own.coarse)}
        if kind == "edges":
            lengths["mounting"] = setting
            fine_along_the_edges(setting)
        scene = replace(
            scene,
            accuracy=replace(own, stress_error=1.0, **lengths),
            wear=replace(scene.wear, step="fixed", max_jump=jump, remesh="limit"),
        )
    few = replace(scene.program, strokes=2 * len(scene.program.cycle))
    run(replace(at_level(scene, FEW), program=few), figures=False)  # loads all packages
    result = run(scene, figures=False)
    rows = [row for row in result.recorder.rows if row[KIND] == result.recorder.rows[-1][KIND]]
    history = {"strokes": [row[STROKE] for row in rows], "depths": [row[DEPTH] for row in rows]}
    say(seconds=result.summary["CPU time [s]"], **history, **{k: result.summary[k] for k in ("solves", "elements")})


def errors(found, exact):
    """Largest error of the depth along the run, and that at its end, over the last depth [-]."""
    strokes = np.arange(exact["strokes"][-1] + 1)
    mine, true = (np.interp(strokes, run["strokes"], run["depths"]) for run in (found, exact))
    off = np.abs(mine - true) / true[-1]
    return {"along the run": off.max(), "at the end": off[-1]}


def cheapest(found, kind, error, most):
    """The fixed setting of a kind that errs no more at the least seconds; None if none does."""
    equal = {run: seen for run, seen in found.items() if run[0] == kind and seen[error] <= most}
    return min(equal, key=lambda run: equal[run]["seconds"], default=None)


def take_turns(found, pair, name):
    """Run both of a pair again by turns; the least seconds of each are kept."""
    for run in pair * TURNS:
        found[run]["seconds"] = min(found[run]["seconds"], measure(__file__, *run, name)["seconds"])


def main(names):
    """Print each run, then what the levels save."""
    for name in names:
        across, jumps, contact, along = CASES[name]
        exact = measure(__file__, "reference", 2 * max(across), 0, name)
        runs = [("adaptive", a, 0) for a in across]
        kinds = (("contact", contact), ("edges", along))
        runs += [(kind, edge, jump) for kind, edges in kinds for edge in edges for jump in jumps]
        found = {}
        for run in runs:
            result = measure(__file__, *run, name)
            if result is None:
                sys.stdout.write(f"{name} {run}: gave up\n")
                continue
            found[run] = seen = errors(result, exact) | {"seconds": result["seconds"]}
            told = ", ".join(f"{100 * seen[error]:.2f} % {error}" for error in ERRORS)
            told += f", {seen['seconds']:.2f} CPU s, {result['solves']} solves, {result['elements']} elements"
            sys.stdout.write(f"{name} {run}: {told}\n")
            sys.stdout.flush()
        for run in runs[: len(across)]:
            mine = found[run]
            against = {
                (kind, error): cheapest(found, kind, error, mine[error]) for kind, _ in kinds for error in ERRORS
            }
            for best in dict.fromkeys(against.values()):
                if best is not None:
                    take_turns(found, (run, best), name)
            sys.stdout.write(f"{name}: {run[1]:g} across, {mine['seconds']:.2f} CPU s\n")
            for (kind, error), best in against.items():
                told = "none is as accurate"
                if best is not None:
                    told = f"{found[best]['seconds'] / mine['seconds']:.2f} with {best[1]:g} mm, {best[2]} cycles"
                says = f"{run[1]:g} across, {100 * mine[error]:.2f} % {error}: {kind} over it {told}"
                sys.stdout.write(f"{name}: {says}\n")
            sys.stdout.flush()


if __name__ == "__main__":
    if sys.argv[1:2] == [SUBJECT]:
        subject(sys.argv[2], float(sys.argv[3]), int(sys.argv[4]), sys.argv[5])
    else:
        main(sys.argv[1:] or CASES)
