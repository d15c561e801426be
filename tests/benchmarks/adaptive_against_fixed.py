"""What the run's own choices save: levels of ``Accuracy(error=...)`` against fixed settings, at equal error of depth.

A fixed setting is an element edge and a number of strokes in a jump, for the whole run, of two kinds: with a mesh that
is as fine along all worn edges, as one draws it who does not know where the contact will be (``edges``), and with one
that is fine where the wear may take the contact (``contact``, ``wear.remesh = "limit"``). All else is the same: solver,
wear step, outline. The error is that of the maximum depth against a run of twice as many elements across as the finest.
For each adaptive run the cheapest fixed one is sought that errs no more.

Usage: python adaptive_against_fixed.py [SCENE ...]
       python adaptive_against_fixed.py --subject KIND SETTING JUMP SCENE
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from subjects import SUBJECT, measure, say

GEOMETRIES = Path(__file__).parents[2] / "geometries"
DEPTH = "maximum depth [mm]"
CASES = {  # of each scene: elements across, edges [mm], cycles in a jump
    "shaft_on_plate": ((3.0, 6.0, 12.0, 24.0), (0.4, 0.2, 0.1, 0.05), (50, 25, 10)),
    "rod_seal": ((2.0, 4.0, 8.0, 12.0), (0.08, 0.04, 0.02, 0.01), (25, 10, 5, 2)),
}


def fine_along_the_edges(edge):
    """Let meshes be fine along all worn edges, for the whole run."""
    from ngwear import mounting, refinement, remesh
    from ngwear.geometry.sizing import SizeField, fitted

    def field(scene):
        contour, accuracy = scene.contour, scene.accuracy
        everywhere = SizeField(contour.points, np.full(len(contour), edge), edge)
        dense = fitted(contour, everywhere)
        on = dense.on(scene.worn_edges)
        seeds = dense.points[on | np.roll(on, 1)]
        return SizeField(seeds, np.full(len(seeds), edge), accuracy.coarse, accuracy.grading)

    def wanted(stage, phases, **_):
        return field(stage.scene)

    mounting.mounting_field = field
    for module in (refinement, remesh):
        module.wanted_size = wanted


def subject(kind, setting, jump, name):
    """One run, as JSON on the last line."""
    from ngwear.adaptive import at_level
    from ngwear.run import run
    from ngwear.scenefile import read_scene

    scene = read_scene(GEOMETRIES / name / "scene.toml")
    scene = replace(scene, save=replace(scene.save, strokes=()))
    if kind == "adaptive":
        scene = at_level(scene, setting)
    else:
        own = scene.accuracy
        lengths = {"patch": setting, "mounting": max(setting, own.mounting), "coarse": max(setting, own.coarse)}
        if kind == "edges":
            lengths["mounting"] = setting
            fine_along_the_edges(setting)
        scene = replace(
            scene,
            accuracy=replace(own, stress_error=1.0, **lengths),
            wear=replace(scene.wear, step="fixed", max_jump=jump, remesh="limit"),
        )
    summary = run(scene, figures=False).summary
    say(depth=summary[DEPTH], **{name: summary[name] for name in ("solves", "elements")})


def main(names):
    """Print each run, then what the adaptive ones save."""
    for name in names:
        across, edges, jumps = CASES[name]
        exact = measure(__file__, "adaptive", 2 * max(across), 0, name)["depth"]
        runs = [("adaptive", a, 0) for a in across]
        runs += [(kind, edge, jump) for kind in ("contact", "edges") for edge in edges for jump in jumps]
        found = {}
        for run in runs:
            result = measure(__file__, *run, name)
            if result is None:
                sys.stdout.write(f"{name} {run}: gave up\n")
                continue
            found[run] = error, cpu = abs(result["depth"] / exact - 1), result["cpu"]
            told = f"{100 * error:.2f} %, {cpu:.1f} CPU s, {result['solves']} solves, {result['elements']} elements"
            sys.stdout.write(f"{name} {run}: {told}\n")
            sys.stdout.flush()
        for run in runs[: len(across)]:
            for kind in ("contact", "edges"):
                equal = [cpu for other, (error, cpu) in found.items() if other[0] == kind and error <= found[run][0]]
                saved = f"{min(equal) / found[run][1]:.2f}" if equal else "none is as accurate"
                sys.stdout.write(
                    f"{name}: {run[1]:g} across, {100 * found[run][0]:.2f} %: fixed {kind} over it {saved}\n"
                )


if __name__ == "__main__":
    if sys.argv[1:2] == [SUBJECT]:
        subject(sys.argv[2], float(sys.argv[3]), int(sys.argv[4]), sys.argv[5])
    else:
        main(sys.argv[1:] or CASES)
