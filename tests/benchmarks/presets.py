"""What so many elements across the contacts err by and take on the shipped scenes that wear by moved nodes.

The presets of ``Accuracy`` are chosen from this: ``draft`` has the fewest that err by less than 5 % of the depth in all
scenes, ``engineering`` the fewest that do by less than 1 %, of the peak pressure, too. Each scene is run with each
number, one after the other, in a process of its own on one thread, without companions or figures. Errors of depth, area
and peak pressure are against the reference preset's, whose own is that against a run with half as many elements across,
as of first order. The peak pressure is the highest of the last solved strokes.

Usage: python presets.py [SCENE ...]
       python presets.py --subject ACROSS SCENE
"""

import sys
import time
from dataclasses import replace
from pathlib import Path

from subjects import SUBJECT, measure, say

GEOMETRIES = Path(__file__).parents[2] / "geometries"
SCENES = ("shaft_on_plate/scene", "starving_lubrication/scene", "rod_seal/scene", "rod_seal/scene_filled")
LADDER = (2.0, 3.0, 4.0, 6.0, 8.0, 12.0)
QUANTITIES = ("maximum depth [mm]", "worn area [mm^2]", "peak pressure [MPa]")


def subject(across, name):
    """One run, as JSON on the last line."""
    begun = time.perf_counter()
    from ngwear.loop.run import run
    from ngwear.scene.accuracy import Accuracy
    from ngwear.scene.read_scene import read_scene

    scene = read_scene(GEOMETRIES / f"{name}.toml")
    scene = replace(scene, accuracy=Accuracy(across=across))
    result = run(scene, figures=False)
    summary = result.summary
    last = {row["kind [-]"]: row for row in result.recorder.rows}
    peak = max(v for row in last.values() for k, v in row.items() if k.endswith("peak pressure [MPa]"))
    found = {name: summary[name] for name in QUANTITIES[:2]} | {QUANTITIES[2]: peak}
    told = {name: summary[name] for name in ("solves", "elements", "peak memory [MB]")}
    say(**found, **told, wall=time.perf_counter() - begun)


def main(scenes):
    """Print a row for each scene and number of elements."""
    from ngwear.scene.accuracy import PRESETS

    presets = {across: preset for preset, across in PRESETS.items()}
    finest = max(presets)
    ladder = sorted({*LADDER, *presets, finest / 2})
    sys.stdout.write("scene, elements across (preset): error of depth, area, peak [%]; CPU s, wall s, MB; solves\n")
    for name in scenes:
        found = {across: measure(__file__, across, name) for across in ladder}
        for across, mine in found.items():
            other = found[finest if across < finest else finest / 2]
            off = ", ".join(f"{100 * abs(mine[q] / other[q] - 1):.2f}" for q in QUANTITIES)
            sys.stdout.write(
                f"{name}, {across:g} ({presets.get(across, '-')}): {off}; {mine['cpu']:.1f}, {mine['wall']:.1f}, "
                f"{mine['peak memory [MB]']:.0f}; {mine['solves']}\n"
            )
            sys.stdout.flush()


if __name__ == "__main__":
    if sys.argv[1:2] == [SUBJECT]:
        subject(float(sys.argv[2]), sys.argv[3])
    else:
        unknown = set(sys.argv[1:]) - set(SCENES)
        if unknown:
            sys.exit(f"no scenes: {sorted(unknown)}; known are {list(SCENES)}")
        main(sys.argv[1:] or SCENES)
