"""Newton iterations a solve, and time over unknowns, as the element edge in the contact is halved: the rod seal.

Mounting, refinement and four strokes, each solved. Iterations should not feel the mesh; a direct solver in two
dimensions takes a time proportional to n log n and more.

Usage: python tests/benchmarks/newton_and_mesh.py [EDGE ...]     (mm; default 0.02 0.01 0.005 0.0025)
"""

import math
import sys
import time
from dataclasses import replace

from ngwear.loop.stepper import Stepper
from ngwear.scene.accuracy import Accuracy
from ngwear.verify.rod_seal import shipped_scene

EDGES = (0.02, 0.01, 0.005, 0.0025)
STROKES = 4


def main() -> None:
    """Print a row as soon as it is known."""
    seal = shipped_scene()
    seal = replace(seal, wear=replace(seal.wear, step="each"), program=replace(seal.program, strokes=STROKES))
    before: tuple[int, float] | None = None
    sys.stdout.write("edge [mm]  unknowns  solves  iterations a solve  CPU [s]  exponent\n")
    for edge in [float(word) for word in sys.argv[1:]] or EDGES:
        start = time.process_time()
        stepper = Stepper(replace(seal, accuracy=Accuracy(patch=edge)))
        state = stepper.start()
        while not stepper.finished(state):
            state = stepper.advance(state)
        seconds, unknowns, work = time.process_time() - start, state.stage.problem.space.ndof, state.work
        power = "" if before is None else f"{math.log(seconds / before[1]) / math.log(unknowns / before[0]):.2f}"
        row = f"{edge:9g}  {unknowns:8d}  {work.solves:6d}  {work.iterations / work.solves:18.2f}"
        sys.stdout.write(f"{row}  {seconds:7.1f}  {power:>8s}\n")
        sys.stdout.flush()
        before = unknowns, seconds


if __name__ == "__main__":
    main()
