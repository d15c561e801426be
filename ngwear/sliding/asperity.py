"""One asperity: a rigid cylinder slides without friction over rubber that remembers (case C1)."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact import Contact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.steady_memory import SteadyMemory
from ngwear.equilibrium.problem import Problem, Support
from ngwear.equilibrium.steady import SteadyOptions, solve_steady
from ngwear.equilibrium.stepping import Work, relax
from ngwear.errors import ConvergenceError, SceneError
from ngwear.fields.kinematics import PlaneStrain
from ngwear.fields.stream import StreamGrid
from ngwear.geometry.body import Body
from ngwear.geometry.contour import Contour
from ngwear.geometry.sizing import SizeField
from ngwear.materials import Hyperelastic, PronySeries
from ngwear.surfaces import Cylinder

Array = NDArray[np.float64]
WAKES = 4.0  # depth of a block over the length of its wake; a thinner one reads 6 % low and more
LONGEST_WAKE = 100.0  # half lengths
ROUGH = 1e-2  # tolerance of the solve that only looks for the contact's ends
WIDE = 8.0  # a block that behaves like a half-plane, to 0.5 % of the friction: times the least one


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

        At most 100 half lengths: what recovers more slowly than that is too shallow to matter.
        """
        length = speed * self.loss_time(speed) * self.series.instantaneous
        return min(length, LONGEST_WAKE * self.half_length(speed))

    def least_depth(self, speed: float) -> float:
        """Four wakes, or thirty half lengths [mm]."""
        return max(WAKES * self.wake(speed), 30 * self.half_length(speed))

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
        What the rubber dissipates, over load and track: the same friction coefficient from energy [-].
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
        """Exciting frequency: the contact's length is half a wave [Hz]."""
        return self.speed / (2 * (self.end - self.start))


def slide(asperity: Asperity, speed: float, *, fineness: int = 24, options: SteadyOptions | None = None) -> Slide:
    """Slide steadily: once on an even mesh to find the contact's ends, once refined to them.

    What dissipates sits within V tau of the ends: elements of V tau / 4 there, between 1/120 and 1/600 of the half
    length, and ``1 / fineness`` of it elsewhere in the contact.

    Raises
    ------
    SceneError
        For a speed that is not positive, or a block too small for its wake, with the depth that it should have.
    ConvergenceError
        If no steady state is found.
    """
    clock = time.process_time()
    if not 0 < speed < np.inf:
        raise SceneError("speed", speed, "steady sliding needs a speed above 0 mm/s; at rest solve the equilibrium")
    least = asperity.least_depth(speed)
    depth = WIDE * least if asperity.depth is None else asperity.depth
    if depth < least:
        raise SceneError(
            "asperity.depth",
            depth,
            f"too small for the wake of {asperity.wake(speed):.4g} mm at {speed:.4g} mm/s: take {least:.4g} mm or more",
        )
    half = asperity.half_length(speed)
    work = Work()
    options = options or SteadyOptions()
    first = replace(options, tolerance=max(options.tolerance, ROUGH))
    rough = _solve(asperity, speed, depth, np.array([-half, half]), half / 12, half / 12, first, work)
    half = rough.half_length
    finest = float(np.clip(speed * asperity.loss_time(speed) / 4, half / 600, half / 120))
    ends = np.array([rough.start, rough.end])
    fine = _solve(asperity, speed, depth, ends, half / fineness, finest, options, work)
    return replace(fine, cpu_seconds=time.process_time() - clock)


def _solve(
    asperity: Asperity,
    speed: float,
    depth: float,
    ends: Array,
    middle: float,
    finest: float,
    options: SteadyOptions,
    work: Work,
) -> Slide:
    """One mesh: elements of ``finest`` at the contact's ends, ``middle`` in it."""
    half, centre = 0.5 * np.ptp(ends), float(ends.mean())
    left, right = centre - 1.8 * half, centre + 1.8 * half

    def patch(x: float) -> float:
        return float(np.clip(0.2 * (np.abs(ends - x).min() - 6 * finest), finest, middle))

    seeds = _march(left, right, patch)
    behind = -_march(-left, depth, lambda x: max(middle, 0.08 * (x + left)))[:0:-1]
    ahead = _march(right, depth, lambda x: max(middle, 0.08 * (x - right)))[1:]
    columns = np.concatenate([behind, seeds, ahead])
    rows = depth - _march(0.0, depth, lambda y: max(finest / 2, 0.08 * y))[::-1]
    contour = Contour.rectangle((-depth, depth), (0.0, depth))
    places = np.stack([seeds, np.full(len(seeds), depth)], axis=1)
    body = Body(contour, SizeField(places, np.array([patch(x) for x in seeds]), depth / 4))
    cylinder = Cylinder(centre=(0.0, depth + asperity.radius), radius=asperity.radius)
    material = asperity.material
    contact = Contact("cylinder", ("top",), cylinder, force_controlled=True, modulus=material.shear_modulus)
    memory = SteadyMemory(material, asperity.series, StreamGrid(columns, (rows,)))
    supports = [Support(("bottom",)), Support(("left", "right"), y=False)]
    problem = Problem(body, PlaneStrain(), [Elasticity(material), memory, contact], supports=supports)
    travel = problem.fields[contact.travel_name].vec
    travel[0] = half**2 / (4 * asperity.radius)  # an overlap to start from
    problem.set_loads({"cylinder force [N]": asperity.load})
    work.add(relax(problem))
    memory.set_speed(speed, 4 * half)
    work.add(solve_steady(problem, memory, options))
    along, across = contact.force()
    profile = contact.profile()
    zones = profile.zones()
    if len(zones) != 1:
        raise ConvergenceError(f"the contact has {len(zones)} pieces; a smooth cylinder has one: refine the mesh")
    start, end = sorted((zones[0].start[0], zones[0].end[0]))
    return Slide(
        speed=speed,
        friction=-float(along / across),
        dissipation=memory.drag() / asperity.load,
        start=float(start),
        end=float(end),
        indentation=float(travel[0]),
        peak=zones[0].peak,
        place=profile.place[:, 0],
        pressure=profile.pressure,
        work=work,
        cpu_seconds=0.0,
    )


def _march(start: float, stop: float, size: Callable[[float], float]) -> Array:
    """Places from start to stop, each ``size`` of the last one further."""
    places = [start]
    while places[-1] < stop:
        places.append(places[-1] + size(places[-1]))
    places[-1] = stop
    return np.array(places)
