"""A pin on a plate: a ball slides along a circle on a bonded sheet of viscoelastic rubber (case C2)."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from pathlib import Path

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import DISPLACEMENT, VOLUMETRIC_STRESS
from ngwear.effects.contact_patch import Faces, PatchContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.friction import FullSliding
from ngwear.effects.steady_memory import SteadyMemory
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.state_transfer import transfer_solid
from ngwear.equilibrium.steady_sliding import SteadyOptions, solve_steady
from ngwear.equilibrium.stepping import StepOptions, Work, advance, relax
from ngwear.errors import SceneError
from ngwear.fields.kinematics import Solid
from ngwear.fields.streamlines import StreamGrid
from ngwear.geometry.sheet import Sheet
from ngwear.scene.pin_scene import Pin, PinMesh
from ngwear.sliding.patch import Patch, contact_patch
from ngwear.surfaces import Sphere

Array = NDArray[np.float64]
# With the factors in ``_seeds`` and ``_graded`` settled on the shipped pin (``verify pin_on_plate error_estimates``).
COARSER = 1.6  # the coarse mesh: a fourth of the elements
ROUGH = 2e-3  # change of the history in the last round: the jumps of gradient from element to element do not settle


@dataclass(frozen=True)
class PinSlide:
    """Steady sliding at one speed.

    Attributes
    ----------
    speed : float
        [mm/s].
    surface_friction, internal_friction : float
        Parts of the friction coefficient: from the friction on the surface, and from the pressure, which the rubber's
        memory makes uneven [-]. Moments about the track's axis over its radius and the load.
    slip_work : float
        Dissipation of the surface friction over load and track [-]. It is larger than ``surface_friction``, because the
        stretched rubber passes the pin faster than the track; the pressure does the rest of this work.
    dissipation : float
        Dissipation of the rubber over load and track [-]. Its sum with ``slip_work`` is the friction.
    depth : float
        Penetration [mm].
    patch : Patch
        The contact's edge and area.
    faces : Faces
        Pressures.
    elements : int
    work : Work
    cpu_seconds : float
    """

    speed: float
    surface_friction: float
    internal_friction: float
    slip_work: float
    dissipation: float
    depth: float
    patch: Patch
    faces: Faces
    elements: int
    work: Work
    cpu_seconds: float

    @property
    def friction(self) -> float:
        """The whole friction coefficient [-]."""
        return self.surface_friction + self.internal_friction

    @property
    def peak(self) -> float:
        """Highest Cauchy pressure [MPa], smoothed over the faces near the peak."""
        return self.faces.peak


class PinStage:
    """One mesh under the pin, fine in a disc of the sheet's top, and the problem on it; friction first at ``speed``."""

    def __init__(self, pin: Pin, mesh: PinMesh, disc: tuple[float, float, float], *, speed: float = 0.0) -> None:
        self.pin, self.mesh = pin, mesh
        high = pin.thickness
        seeds, sizes = _seeds(disc, mesh.patch, high)
        self.body = Sheet(
            thickness=high,
            track_radius=pin.track_radius,
            reach=mesh.reach * high,
            beside=mesh.beside * high,
            seeds=seeds,
            sizes=sizes,
            coarse=mesh.coarse,
        )
        ball = Sphere(centre=(0.0, 0.0, high + pin.radius), radius=pin.radius, track_radius=pin.track_radius)
        modulus = pin.material.shear_modulus
        self.contact = PatchContact("pin", ("top",), ball, force_controlled=True, modulus=modulus)
        self.elasticity = Elasticity(pin.material)
        terms = [self.elasticity, self.contact]
        law = pin.friction_law
        self.friction = FullSliding(self.contact, law, speed=speed) if law is not None else None
        if self.friction is not None:
            terms.append(self.friction)
        self.memory: SteadyMemory | None = None
        if pin.series is not None:
            self.memory = SteadyMemory(pin.material, pin.series, self._grid(disc))
            terms.append(self.memory)
        self.problem = Problem(self.body, Solid(), terms, supports=[FixedEdges(("bottom",))])

    def _grid(self, disc: tuple[float, float, float]) -> StreamGrid:
        x, y, radius = disc
        body, step = self.body, self.mesh.column
        columns = _graded(-body.reach, body.reach, x - 1.2 * radius, x + 1.2 * radius, step)
        offsets = _graded(-body.beside, body.beside, y - 1.2 * radius, y + 1.2 * radius, step)
        heights = np.linspace(0.0, body.thickness, round(body.thickness / (1.2 * step)) + 1)
        return StreamGrid(columns, (offsets, heights), body.track_radius)

    @property
    def depth(self) -> float:
        """Penetration [mm]."""
        return float(self.problem.fields[self.contact.travel_name].vec[0])

    def press(self) -> Work:
        """Apply the load from first contact, with long-term elastic rubber."""
        pin, travel = self.pin, self.problem.fields[self.contact.travel_name].vec
        travel[0] = 0.01 * pin.radius
        force = "pin force [N]"
        self.problem.set_loads({force: 0.01 * pin.load})
        work = relax(self.problem, StepOptions(first=0.25))
        work.add(advance(self.problem, {force: pin.load}, StepOptions(first=0.05)))
        return work

    def slide(self, speed: float, options: SteadyOptions) -> Work:
        """Find the steady state at a speed, starting from the present state."""
        if self.memory is None:
            raise SceneError("pin.series", None, "sliding without memory has no speed: press the pin on")
        self.problem.set_loads({"pin force [N]": self.pin.load})
        wavelength = self.pin.contact_radius  # a quarter of the pressure's own
        self.memory.set_speed(speed, wavelength)
        if self.friction is not None:
            self.friction.coefficient.set_state(0.0, speed)
        return solve_steady(self.problem, self.memory, options)

    def disc(self) -> tuple[float, float, float]:
        """Middle and radius of the reference disc that holds the contact [mm]."""
        faces = self.contact.faces()
        on = faces.reference[faces.loaded, :2]
        middle = 0.5 * (on.min(axis=0) + on.max(axis=0))
        return float(middle[0]), float(middle[1]), float(np.linalg.norm(on - middle, axis=1).max())

    def write_vtk(self, file: Path) -> None:
        """Write displacement and volumetric stress for ParaView."""
        fields = self.problem.fields
        stress = fields[VOLUMETRIC_STRESS]
        names = [DISPLACEMENT, VOLUMETRIC_STRESS.replace(" ", "_")]
        ng.VTKOutput(self.body.mesh, coefs=[fields[DISPLACEMENT], stress], names=names, filename=str(file)).Do()

    def result(self, speed: float, work: Work, cpu: float) -> PinSlide:
        """The state as a ``PinSlide``."""
        pin, contact = self.pin, self.contact
        surface = slip = 0.0
        if self.friction is not None:
            tangent = contact.surface.tangent(*contact.place(self.problem.fields))
            traction = tuple(self.friction.mu() * t for t in tangent)
            surface, slip = contact.turning(traction), contact.slipping(traction)
        return PinSlide(
            speed=speed,
            surface_friction=surface / pin.load,
            slip_work=slip / pin.load,
            internal_friction=contact.resistance() / pin.load,
            dissipation=self.memory.drag() / pin.load if self.memory is not None else 0.0,
            depth=self.depth,
            patch=contact_patch(contact),
            faces=contact.faces(),
            elements=self.body.mesh.ne,
            work=work,
            cpu_seconds=cpu,
        )


def slide_pin(
    pin: Pin,
    speed: float,
    *,
    mesh: PinMesh | None = None,
    options: SteadyOptions | None = None,
    vtk: Path | None = None,
) -> tuple[PinSlide, PinSlide]:
    """Slide steadily on a coarse mesh, refine to the contact found there, and slide again; both, the fine one last.

    The first mesh has elements and columns 1.6 times as large, so that the two meshes give an error estimate.

    Parameters
    ----------
    pin : Pin
    speed : float
        [mm/s].
    mesh : PinMesh or None
    options : SteadyOptions or None
    vtk : Path or None
        Folder for the deformed sheet as a file for ParaView.

    Raises
    ------
    SceneError
        For a speed that is not positive or a rubber without memory.
    ConvergenceError
        If no steady state is found.
    """
    if not 0 < speed < math.inf:
        raise SceneError("speed", speed, "steady sliding needs a speed above 0 mm/s; at rest press the pin on")
    mesh, options = mesh or PinMesh(), options or SteadyOptions(tolerance=ROUGH)
    pin = replace(pin, series=mesh.folding(pin.arms, speed).kept)
    clock = time.process_time()
    coarse = PinStage(pin, coarsened(mesh), (0.0, 0.0, pin.contact_radius), speed=speed)
    work = coarse.press()
    work.add(coarse.slide(speed, options))
    first = coarse.result(speed, work, time.process_time() - clock)
    fine = PinStage(pin, mesh, coarse.disc(), speed=speed)
    transfer_solid(coarse.problem, fine.problem)
    work = fine.slide(speed, options)
    if vtk is not None:
        fine.write_vtk(vtk / f"sheet_{speed:g}_mm_s")
    return first, fine.result(speed, work, time.process_time() - clock)


def coarsened(mesh: PinMesh) -> PinMesh:
    """The coarse mesh of the first slide."""
    return replace(mesh, patch=COARSER * mesh.patch, column=COARSER * mesh.column)


def _seeds(disc: tuple[float, float, float], size: float, high: float) -> tuple[Array, Array]:
    """Places on and under a disc of the top, and the element edges asked for there: twice as long in the depth."""
    x, y, radius = disc
    seeds, sizes = [], []
    for depth, edge, reach in ((0.0, size, 1.15), (0.3, 1.6 * size, 1.0), (0.6, 2.0 * size, 1.0)):
        ticks = np.arange(-reach * radius, reach * radius + edge / 2, edge)
        grid = np.stack(np.meshgrid(ticks, ticks), axis=-1).reshape(-1, 2)
        inside = grid[np.linalg.norm(grid, axis=1) <= reach * radius] + (x, y)
        seeds.append(np.column_stack([inside, np.full(len(inside), (1 - depth) * high)]))
        sizes.append(np.full(len(inside), edge))
    return np.vstack(seeds), np.concatenate(sizes)


def _graded(start: float, stop: float, left: float, right: float, step: float) -> Array:
    """Places from start to stop, ``step`` apart between left and right and further apart beyond, rising."""
    middle = np.linspace(left, right, max(2, round((right - left) / step) + 1))
    back, ahead = [left], [right]
    while back[-1] > start:
        back.append(back[-1] - step - 0.25 * (left - back[-1]))
    while ahead[-1] < stop:
        ahead.append(ahead[-1] + step + 0.25 * (ahead[-1] - right))
    back[-1], ahead[-1] = min(start, left), max(stop, right)
    return np.unique(np.concatenate([back, middle, ahead]))
