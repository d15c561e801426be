"""Number of cycles of the next step."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

GROWTH = 2.0  # with STRETCH below 1 + sqrt 2, up to which backward differences of second order are stable
SAFETY = 0.9  # usual in step control: 1 would have every other step taken back
STRETCH = 1.2  # how much longer a step may become so that one less remains; 1.25 with growth of 3 was unstable


@dataclass
class JumpControl:
    """Choose the jump from an embedded pair: ``wear.backward_differences`` and the trapezoidal rule.

    Their difference over a step is measured as an area (L1 norm over the outline: in the maximum norm a point that has
    just come into contact would keep the step small for ever), relative to the area that the step removes. That ratio
    is of second order in the jump, so

        n_new = 0.9 n sqrt(tolerance / ratio),   growth at most 2.

    The same rule holds for the error of the greatest depth, each step's error over its share of the program, with the
    tolerance ``depth``: the sum of these errors is then about ``depth`` at most. A step with a larger error of depth is
    accepted, and shorter steps follow.

    Parameters
    ----------
    tolerance : float
        Relative error of worn area [-].
    cycles : int
        Cycles of the next step.
    longest : int
    depth : float
        Relative error of the greatest depth that all steps together aim at [-]; 1 for no limit.
    """

    tolerance: float
    cycles: int = 1
    longest: int = 1000
    depth: float = 1.0

    def share(self, left: int) -> int:
        """Cycles of the next step when ``left`` cycles remain to the next mark, so that steps have similar lengths."""
        steps = max(1, math.ceil(left / (STRETCH * self.cycles) - 1e-9))
        return math.ceil(left / steps) if steps <= 2 else min(self.cycles, left)

    def accepts(self, ratio: float, cycles: int) -> bool:
        """Whether a step with this error ratio is accepted; single cycles always are."""
        return cycles == 1 or not ratio > 2 * self.tolerance  # taking it back costs a solve; the estimate is safe

    def update(self, ratio: float, cycles: int, depth: float = 0.0) -> None:
        """Set the next number of cycles after a step of ``cycles``.

        ``ratio`` and ``depth`` are its errors of area and depth [-], the first one nan if it is not known yet.
        """
        off = max(ratio / self.tolerance, depth / self.depth if self.depth < 1 else 0.0)
        if math.isnan(ratio):
            factor = 1.0
        elif off == 0:
            factor = GROWTH
        else:
            factor = min(GROWTH, max(0.3, SAFETY / math.sqrt(off)))  # far off, the square law says little
        self.cycles = int(min(self.longest, max(1, math.floor(factor * cycles + 1e-9))))

    def cut(self, cycles: int, *, to_one: bool = False) -> int:
        """Halve the step after a failure, or cut it to one cycle; return the cycles of the next one."""
        self.cycles = 1 if to_one else max(1, cycles // 2)
        return self.cycles
