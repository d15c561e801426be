"""One asperity: a rigid cylinder slides without surface friction over viscoelastic rubber (case C1)."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.steady_memory import SteadyMemory
from ngwear.equilibrium.state_transfer import transfer
from ngwear.equilibrium.steady_sliding import SteadyOptions, solve_steady
from ngwear.equilibrium.stepping import Work, relax
from ngwear.errors import SceneError
from ngwear.fields.streamlines import StreamGrid
from ngwear.geometry.sizing import SizeField
from ngwear.materials import Hyperelastic, PronySeries
from ngwear.sliding.block import Block, march, meshed_block

Array = NDArray[np.float64]
# These, and the factors in ``slide`` and ``_block``, were settled on the cases ``hunter`` and ``three_arms``.
WAKES = 4.0  # depth of a block over the length of its wake; a thinner one reads 6 % low and more
LONGEST_WAKE = 100.0  # half lengths: what recovers more slowly is too shallow to matter
ROUGH, COARSE = 1e-2, 4  # tolerance and fineness of the solve that only looks for the contact's ends
NEAR, FAR = 0.25, 0.5  # steepest growth of the elements around the contact, and beyond
AROUND = 8.0  # the contact: half lengths
GRID = 0.48  # growth of the columns and rows along which the material flows, over that of the elements near by
WIDE = 8.0  # times the least depth: the block behaves like a half-plane, to 0.5 % of the friction


@dataclass(frozen=True, kw_only=True)
class Asperity:
    """A cylinder on a block in plane strain; the bottom is bonded, the sides slide.

    Parameters
    ----------
    material : Hyperelastic
        Long-term behaviour.
    series : PronySeries
        Arms at the block's temperature.
    radius : float
        [mm].
    load : float
        Force per thickness [N/mm].
    depth : float or None
        Of the block [mm], half its width; by default deep enough for a half-plane.

    Raises
    ------
    SceneError
        For a radius or load that is not positive.
    """

    material: Hyperelastic
    series: PronySeries
    radius: float
    load: float
    depth: float | None = None

    def __post_init__(self) -> None:
        for name, value in (("radius", self.radius), ("load", self.load), ("depth", self.depth)):
            if value is not None and not 0 < value < np.inf:
                raise SceneError(f"asperity.{name}", value, "must be finite and greater than 0")

    def half_length(self, speed: float) -> float:
        """Hertz's half length with the modulus |G*| at the rate speed / half length [mm]."""
        modulus = 4 * self.material.shear_modulus
        half = np.sqrt(4 * self.load * self.radius / (np.pi * modulus))
        for _ in range(30):
            f = speed / half / (2 * np.pi)
            stiff = modulus * float(np.hypot(self.series.storage(f), self.series.loss(f)))
            half = 0.5 * (half + np.sqrt(4 * self.load * self.radius / (np.pi * stiff)))
        return float(half)

    def wake(self, speed: float) -> float:
        """Length over which the track recovers: V tau G_0 / G_inf, tau weighted by the arms' loss [mm].

        At most 100 half lengths: slower recovery has too small an amplitude to matter.
        """
        length = speed * self.loss_time(speed) * self.series.instantaneous
        return min(length, LONGEST_WAKE * self.half_length(speed))

    def least_depth(self, speed: float) -> float:
        """Four wakes, or thirty half lengths [mm]."""
        return max(WAKES * self.wake(speed), 30 * self.half_length(speed))

    def block_depth(self, speed: float) -> float:
        """Depth of the block for a speed [mm]: the one given, or deep enough for a half-plane.

        Raises
        ------
        SceneError
            For a speed that is not positive, or a block too small for its wake.
        """
        if not 0 < speed < np.inf:
            raise SceneError("speed", speed, "sliding needs a speed above 0 mm/s; at rest solve the equilibrium")
        least = self.least_depth(speed)
        depth = WIDE * least if self.depth is None else self.depth
        if depth < least:
            wake = f"the wake of {self.wake(speed):.4g} mm at {speed:.4g} mm/s"
            raise SceneError("asperity.depth", depth, f"too small for {wake}: take {least:.4g} mm or more")
        return depth

    def loss_time(self, speed: float) -> float:
        """Mean relaxation time of the arms, weighted by their loss at this speed [s]."""
        times = np.array(self.series.times)
        x = speed / self.half_length(speed) * times
        loss = np.array(self.series.ratios) * x / (1 + x * x)
        return float(loss @ times / loss.sum())


@dataclass(frozen=True)
class Slide:
    """Steady sliding at one speed.

    Attributes
    ----------
    speed : float
        [mm/s].
    friction : float
        Horizontal over vertical force: the internal friction of the rubber alone [-].
    dissipation : float
        Dissipation of the rubber over load and track: the same friction coefficient from energy [-].
    start, end : float
        Contact from the axis, the slider moving towards +x [mm].
    indentation : float
        [mm].
    peak : float
        Highest Cauchy pressure [MPa].
    place, pressure : array
        Contact nodes and pressures [mm], [MPa].
    work : Work
    cpu_seconds : float
    """

    speed: float
    friction: float
    dissipation: float
    start: float
    end: float
    indentation: float
    peak: float
    place: Array
    pressure: Array
    work: Work
    cpu_seconds: float

    @property
    def half_length(self) -> float:
        """Half the contact's length [mm]."""
        return (self.end - self.start) / 2

    @property
    def centre(self) -> float:
        """Middle of the contact ahead of the axis [mm]."""
        return (self.end + self.start) / 2

    @property
    def frequency(self) -> float:
        """Exciting frequency [Hz]: the contact's length is half a wave."""
        return self.speed / (2 * (self.end - self.start))


def slide(asperity: Asperity, speed: float, *, fineness: float = 12, options: SteadyOptions | None = None) -> Slide:
    """Steady sliding: a first solve on a uniform coarse mesh finds the contact's ends, a second one is refined there.

    Dissipation occurs within V tau of the ends: elements of ``4 V tau / fineness`` there, with the half length l
    between ``l / 40`` and ``l / 8`` over fineness, and ``l / fineness`` elsewhere in the contact. Below it they grow
    by ``2 / fineness`` of the distance, at most a quarter near the contact and a half beyond: at V tau = l / 100 a
    quarter leaves the dissipation 3 % off.

    Raises
    ------
    SceneError
        For a speed that is not positive, or a block too small for its wake, with the depth that it should have.
    ConvergenceError
        If no steady state is found.
    """
    clock = time.process_time()
    depth = asperity.block_depth(speed)
    half = asperity.half_length(speed)
    options = options or SteadyOptions()
    even = half / COARSE
    block, memory = _block(asperity, depth, np.array([-half, half]), even, even, FAR, FAR)
    block.indent(half**2 / (4 * asperity.radius))
    work = relax(block.problem)
    memory.set_speed(speed, half)
    work.add(solve_steady(block.problem, memory, replace(options, tolerance=max(options.tolerance, ROUGH))))
    half = 0.5 * float(np.ptp(block.ends))
    finest = float(np.clip(4 * speed * asperity.loss_time(speed), half / 40, half / 8)) / fineness
    near, far = np.minimum(2 / fineness, (NEAR, FAR))
    fine, memory = _block(asperity, depth, block.ends, half / fineness, finest, near, far)
    (state,) = transfer(block.problem, [block.problem.state.vec.FV().NumPy()], fine.problem)
    fine.problem.state.vec.FV().NumPy()[:] = state
    memory.set_speed(speed, half)
    work.add(solve_steady(fine.problem, memory, options))
    start, end = fine.ends
    profile = fine.contact.profile()
    return Slide(
        speed=speed,
        friction=fine.friction,
        dissipation=memory.drag() / asperity.load,
        start=float(start),
        end=float(end),
        indentation=fine.indentation,
        peak=float(profile.pressure.max()),
        place=profile.place[:, 0],
        pressure=profile.pressure,
        work=work,
        cpu_seconds=time.process_time() - clock,
    )


def _block(
    asperity: Asperity, depth: float, ends: Array, middle: float, finest: float, near: float, far: float
) -> tuple[Block, SteadyMemory]:
    """Elements of ``finest`` at the contact's ends and ``middle`` in it, growing by ``near`` around, ``far`` beyond."""
    half, centre = 0.5 * np.ptp(ends), float(ends.mean())
    left, right = centre - 1.8 * half, centre + 1.8 * half

    def patch(x: float) -> float:
        return float(np.clip(0.2 * (np.abs(ends - x).min() - 6 * finest), finest, middle))

    growth = GRID * near
    seeds = march(left, right, patch)
    behind = -march(-left, depth, lambda x: max(middle, growth * (x + left)))[:0:-1]
    ahead = march(right, depth, lambda x: max(middle, growth * (x - right)))[1:]
    columns = np.concatenate([behind, seeds, ahead])
    rows = depth - march(0.0, depth, lambda y: max(finest / 2, growth * y))[::-1]
    places = np.column_stack([seeds, np.full(len(seeds), depth)])
    size = SizeField(places, np.array([patch(x) for x in seeds]), depth, grading=near)
    if far > near:
        places = np.vstack([places, *(_rings(x, depth, finest, AROUND * half) for x in ends)])
    body = meshed_block((-depth, depth), depth, places, size(places), grading=far)
    memory = SteadyMemory(asperity.material, asperity.series, StreamGrid(columns, (rows,)))
    return Block.under(body, asperity.material, memory, radius=asperity.radius, load=asperity.load), memory


def _rings(x: float, y: float, first: float, last: float) -> Array:
    """Places on half circles below a point, from radius first to last [mm], shape (n, 2)."""
    radii = np.geomspace(first, last, round(np.log(last / first) / 0.4))[:, None]
    angles = np.pi * np.arange(0.5, 8) / 8
    return np.stack([x + radii * np.cos(angles), y - radii * np.sin(angles)], axis=-1).reshape(-1, 2)
