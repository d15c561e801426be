"""One asperity sliding in time: pressed on, then moved over the block until its friction no longer changes."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.viscosity import Viscosity
from ngwear.equilibrium.newton import NewtonOptions
from ngwear.equilibrium.stepping import StepOptions, Work, advance, relax
from ngwear.errors import ConvergenceError, SceneError
from ngwear.sliding.asperity import Asperity
from ngwear.sliding.block import SLIDE, Block, march, meshed_block

Array = NDArray[np.float64]
# These, and the factors in ``slide_in_time``, were settled on the case ``hunter_transient``: friction within 1.3 %.
GROWTH = 0.15  # of elements and steps with the distance from where they shall be finest
COARSEST = 1.0  # elements a half length far from the end of the track
STEADY = 0.02  # largest change of the friction from one window to the next: beyond, it is not steady, and says so
NEWTON = NewtonOptions(tolerance=1e-8)  # of a block that is some hundred times as wide as the contact


@dataclass(frozen=True)
class Passage:
    """Sliding over a track.

    Attributes
    ----------
    speed : float
        [mm/s].
    travel, friction, indentation : array, shape (n,)
        After each step: way of the cylinder [mm], horizontal over vertical force [-], and its depth [mm].
    window : float
        Way at the end over which the steady friction is averaged [mm].
    work : Work
    cpu_seconds : float
    """

    speed: float
    travel: Array
    friction: Array
    indentation: Array
    window: float
    work: Work
    cpu_seconds: float

    @property
    def steady(self) -> float:
        """Friction at the end [-], averaged over ``window``: it oscillates as nodes come into contact."""
        return self._mean(0)

    @property
    def drift(self) -> float:
        """Change of the friction from the last window but one to the last, over the latter [-]."""
        return abs(1 - self._mean(1) / self._mean(0))

    def _mean(self, back: int) -> float:
        end = self.travel[-1] - back * self.window
        places = np.linspace(end - self.window, end, 401)
        return float(np.trapezoid(np.interp(places, self.travel, self.friction), places) / self.window)


def slide_in_time(asperity: Asperity, speed: float, *, fineness: float = 12, wakes: float = 4.0) -> Passage:
    """Press the cylinder on in the time in which it later passes over its contact, then slide it at constant speed.

    The block is at rest in its own frame, so that mesh nodes pass through the contact. The track is as long as
    ``wakes`` of ``Asperity.wake``, and the mesh is fine at its end, where the friction is evaluated: elements and steps
    of ``1 / fineness`` of the half length, or of ``4 V tau / fineness`` around the ends of the contact if that is less.

    Raises
    ------
    SceneError
        For a speed or track length that is not positive, or a block too small for its wake.
    ConvergenceError
        If a step fails, or the friction still changes at the end of the track.
    """
    clock = time.process_time()
    depth = asperity.block_depth(speed)
    if not 0 < wakes < np.inf:
        raise SceneError("wakes", wakes, "must be finite and greater than 0")
    half, relaxation = asperity.half_length(speed), speed * asperity.loss_time(speed)
    finest = min(4 * relaxation, half) / fineness
    window = max(4 * finest, min(half, relaxation))
    track = wakes * asperity.wake(speed) + half / 4 + window
    if finest < half / fineness:
        fine = [np.array([e - window - 0.15 * half, e + 0.15 * half]) + track for e in (-half, half)]
    else:
        fine = [np.array([track - window - 1.5 * half, track + 1.5 * half])]

    def element(x: float) -> float:
        away = min(max(low - x, x - high, 0.0) for low, high in fine)
        behind = max(track - window - 2 * half - x, 0.0)
        return min(finest + GROWTH * away, half / fineness + GROWTH * behind, half / COARSEST)

    def step(x: float) -> float:
        return min(finest + GROWTH * max(track - window - x, 0.0), half / COARSEST)

    seeds = march(-1.8 * half, track + 1.8 * half, element)
    top, sizes = np.column_stack([seeds, np.full(len(seeds), depth)]), np.array([element(x) for x in seeds])
    body = meshed_block((-depth, depth + track), depth, top, sizes, grading=0.25)
    memory = Viscosity(asperity.material, asperity.series)
    block = Block.under(body, asperity.material, memory, radius=asperity.radius, load=asperity.load, slides=True)
    block.indent(half**2 / (4 * asperity.radius))
    options = StepOptions(newton=NEWTON)
    work = relax(block.problem, options, duration=2 * half / speed)
    travel = march(0.0, track, step)
    found = [(block.friction, block.indentation)]
    for x, way in zip(travel[1:], np.diff(travel), strict=True):
        work.add(advance(block.problem, {SLIDE: float(x)}, options, duration=way / speed))
        found.append((block.friction, block.indentation))
    friction, indentation = np.array(found).T
    passage = Passage(speed, travel, friction, indentation, window, work, time.process_time() - clock)
    if passage.drift > STEADY:
        raise ConvergenceError(
            f"after {track:.4g} mm at {speed:.4g} mm/s the friction still changes by {passage.drift:.1%} over "
            f"{window:.4g} mm: slide more than {wakes:g} wakes"
        )
    return passage
