"""Wear the sheet explicitly and implicitly, 5 s a step, on three meshes, and draw both: ``schemes.png``.

Takes some minutes: ``python geometries/shaft_on_plate/make_figure.py OUT`` with a folder for the runs.
"""

import sys
import warnings
from dataclasses import replace
from pathlib import Path

from ngwear.loop.run import run
from ngwear.plots.schemes import draw_schemes
from ngwear.scene.read_scene import read_scene

HERE = Path(__file__).parent
MESHES = (0.1, 0.05, 0.025)


def main(out: Path) -> None:
    """Run what is not there yet, and draw."""
    shipped = read_scene(HERE / "scene_explicit.toml")
    warnings.simplefilter("ignore", RuntimeWarning)  # the explicit scheme says itself that it is unstable
    runs = {}
    for scheme in ("explicit", "implicit"):
        runs[scheme] = {f"{patch} mm": out / f"{scheme}_{patch}" for patch in MESHES}
        for patch, folder in zip(MESHES, runs[scheme].values(), strict=True):
            scene = replace(
                shipped,
                accuracy=replace(shipped.accuracy, patch=patch),
                wear=replace(shipped.wear, scheme=scheme),
            )
            run(scene, out=folder, resume=True, throw=False)
    draw_schemes(runs, shipped.program.strokes, HERE / "schemes.png")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
