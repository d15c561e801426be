"""A turning shaft that wears a rubber sheet by moved nodes (case C3, ``geometries/shaft_on_plate``), 60 s.

Source: Békési, *Modelling Friction and Abrasive Wear of Elastomers*, 10.5772/50498: sheet 2 mm thick, shaft of 10 mm
under 16 N, 50 rad/s, mu = 1, 60 s; the profile wears asymmetrically, and the explicit method fails on fine meshes.
Width, rubber and wear rate are not given; the scene labels what is taken instead.

Worn area. On a circle friction is the pressure turned by 90 degrees, times mu. So the resultants N of the pressure and
mu N of the friction are at right angles, and N = sqrt((F^2 + H^2) / (1 + mu^2)) with the force F and the horizontal
force H on the sheet, however the pressure is distributed; with N tilted by alpha to the vertical that is
N = F / (cos alpha - mu sin alpha), more than F: the shaft digs in. The law wears with
``int p da = N / <cos(theta - alpha)>``, for half an ellipse of pressure over an arc of half angle beta
N / (1 - beta^2 / 8). Summed up over the steps, times k ds, this is the reference; J is within 0.2 % of 1.

Asymmetry. Friction drags the sheet's surface to +x: there the contact lies, and left of the middle lies the material
that it presses and wears, so that the groove of the unloaded sheet is deeper on the left. Without friction it is
symmetric.

Error. The jumps of the scene as shipped err in the largest depth by what it differs by from that after 200 steps; what
they say of that themselves is told without another run.

Explicit steps of 0.8 and 2 critical distances on two meshes. Roughness is the pressure's total variation over twice
its maximum: 1 for a single hump, however skew. Area is right all the while.

Order. The profile's distance (L1) from that after 200 steps, of 6 and of 12 steps.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from ngwear.effects.contact_profile import ContactProfile
from ngwear.errors import ConvergenceError, GeometryError, MeshError, SceneError
from ngwear.geometry.outline import Array, Outline
from ngwear.laws import FrictionLaw, WearRate
from ngwear.loop.stepper import Stepper
from ngwear.scene.contact import Contact
from ngwear.scene.scene import Scene
from ngwear.surfaces import Cylinder
from ngwear.verify.base import BAND, Bound, Check, Stopwatch
from ngwear.verify.rod_seal import shipped_scene
from ngwear.wear.archard import critical_distance

CASE, SHAFT = "shaft_on_plate", "shaft"
GRID = np.linspace(-3.0, 3.0, 1201)
FEW, MANY = 12, 200


def cut(scene: Scene, strokes: int, scheme: str | None = None) -> Scene:
    """The same sliding in equal strokes, each one solved, with the scene's scheme unless another is given."""
    (stroke,) = scene.program.cycle
    whole = scene.program.slid(scene.program.strokes)
    program = replace(scene.program, cycle=(replace(stroke, travel=whole / strokes),), strokes=strokes)
    return replace(scene, program=program, wear=replace(scene.wear, step="each", scheme=scheme or scene.wear.scheme))


def on_mesh(scene: Scene, patch: float) -> Scene:
    """The same on elements of another size [mm]."""
    mounting = max(patch, scene.accuracy.lengths.mounting)
    return replace(scene, accuracy=replace(scene.accuracy, patch=patch, mounting=mounting))


def worn_depth(contour: Outline) -> Array:
    """Depth below the sheet's unworn top at ``GRID`` [mm]."""
    on = contour.on(("top",))
    points = contour.points[on | np.roll(on, 1)]
    points = points[np.argsort(points[:, 0])]
    return points[0, 1] - np.interp(GRID, *points.T)


def roughness(profile: ContactProfile) -> float:
    """Total variation of the pressure over twice its maximum [-]."""
    return float(np.abs(np.diff(profile.pressure)).sum() / (2 * profile.pressure.max()))


@dataclass
class Story:
    """What a run left behind."""

    depth: Array
    area: float
    closed_form: float
    strokes: int
    depth_error: float = 0.0
    iterations: list[int] = field(default_factory=list)
    profiles: list[ContactProfile] = field(default_factory=list)
    seconds: float = 0.0

    @property
    def centre(self) -> float:
        """Centre of gravity of the worn area along the sheet [mm]."""
        return float((self.depth @ GRID) / self.depth.sum())

    @property
    def profile(self) -> ContactProfile:
        """The last one."""
        return self.profiles[-1]

    @property
    def contact_middle(self) -> float:
        """Middle of the last contact, deformed [mm]."""
        ends = [end[0] for zone in self.profile.zones() for end in (zone.start, zone.end)]
        return float(0.5 * (min(ends) + max(ends)))


def constants(spec: Contact) -> tuple[float, float, float, float]:
    """The shaft's radius [mm], its friction [-], wear rate [mm²/N] and force [N/mm]."""
    surface, friction, rate, force = spec.surface, spec.friction, spec.specific_wear_rate, spec.force
    if not isinstance(surface, Cylinder) or isinstance(friction, FrictionLaw) or isinstance(rate, WearRate):
        raise SceneError(f"contact '{spec.name}'", spec, "must be a shaft with a constant friction and wear rate")
    if force is None:
        raise SceneError(f"contact '{spec.name}'.force", force, "is missing")
    return surface.radius, friction, rate, force


def story(scene: Scene) -> Story:
    """Run a scene to its end, or until it gives up."""
    watch, (spec,) = Stopwatch(), scene.contacts
    radius, friction, rate, force = constants(spec)
    found = Story(np.zeros_like(GRID), 0.0, 0.0, 0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # the explicit scheme says itself that it is unstable
        stepper = Stepper(scene)
    state = stepper.start()
    while not stepper.finished(state):
        before = state.strokes
        try:
            state = stepper.advance(state)
        except (ConvergenceError, GeometryError, MeshError):
            break
        (report,) = state.reports
        found.profiles.append(report.contacts[SHAFT])
        found.iterations.append(report.iterations)
        along = sum(force[0] for force in report.forces.values())
        zones = found.profile.zones()
        ends = [math.asin(end[0] / radius) for zone in zones for end in (zone.start, zone.end)]
        half_angle = 0.5 * (max(ends) - min(ends))
        normal = math.sqrt((force**2 + along**2) / (1 + friction**2))
        sliding = scene.program.slid(state.strokes) - scene.program.slid(before)
        found.closed_form += rate * sliding * normal / (1 - half_angle**2 / 8)
    found.depth, found.area, found.strokes = worn_depth(state.contour), state.ledger.removed, state.strokes
    found.depth_error = abs(state.ledger.depth_error)
    found.seconds = watch.seconds
    return found


def run() -> list[Check]:
    """Shipped scene, 6, 12 and 200 equal steps, no friction, explicit steps on two meshes."""
    scene = shipped_scene("scene.toml", CASE)
    shipped, few, many = story(scene), story(cut(scene, FEW)), story(cut(scene, MANY))
    (spec,) = scene.contacts
    smooth = story(replace(cut(scene, FEW), contacts=(replace(spec, friction=0.0),)))
    checks: list[Check] = []

    def add(
        quantity: str, value: float, reference: float, source: Story, tolerance: float = 0.0, bound: Bound = "near"
    ) -> None:
        checks.append(Check(CASE, quantity, value, reference, tolerance, source.seconds, bound=bound))

    add("centre of the worn area, unloaded [mm]", shipped.centre, -0.03, shipped, bound="below")
    add("middle of the contact at the end, loaded [mm]", shipped.contact_middle, 0.1, shipped, bound="above")
    add("the same centre without friction [mm]", smooth.centre, 0.0, smooth, tolerance=1e-3)
    for name, mine in (("as shipped", shipped), (f"{FEW} steps", few), (f"{MANY} steps", many)):
        add(f"worn area, {name} [mm^2]", mine.area, mine.closed_form, mine, tolerance=0.01)
    for name, mine in (("as shipped", shipped), (f"{FEW} equal steps", few)):
        against = f"{name} against {MANY}"
        add(f"steps, {name} [-]", len(mine.iterations), FEW, mine, bound="below")
        add(f"largest depth, {against} [mm]", mine.depth.max(), many.depth.max(), mine, tolerance=0.01)
        add(f"worn area, {against} [mm^2]", mine.area, many.area, mine, tolerance=0.01)
        apart = np.abs(mine.depth - many.depth).sum() / many.depth.sum()
        add(f"profile, {against}, L1 over area [-]", apart, 0.0, mine, tolerance=0.01)
        add(f"Newton iterations a step, {name} [-]", float(np.mean(mine.iterations)), 5.0, mine, bound="below")
    true = abs(shipped.depth.max() - many.depth.max())
    for limit, bound in BAND:
        says = f"what the jumps say of the largest depth's error over the true one, as shipped, {bound} {limit:g} [-]"
        add(says, shipped.depth_error / true, limit, shipped, bound=bound)
    rough = story(cut(scene, FEW // 2))
    off = [np.abs(mine.depth - many.depth).sum() for mine in (rough, few)]
    add(
        f"order of the profile in the step, {FEW // 2} and {FEW} steps [-]",
        math.log2(off[0] / off[1]),
        1.8,
        rough,
        bound="above",
    )
    _explicit(scene, add)
    return checks


def _explicit(scene: Scene, add: Callable[..., None]) -> None:
    """Below the critical distance the pressure is as smooth as the implicit one, above it is not."""
    whole, (spec,) = scene.program.slid(scene.program.strokes), scene.contacts
    for patch in (0.1, 0.05):
        critical = critical_distance(patch, spec.wear_rate.highest, scene.part.material.plane_strain_modulus)
        for times, limit, bound in ((0.8, 1.05, "below"), (2.0, 1.2, "above")):
            strokes = (math.ceil if times < 1 else math.floor)(whole / (times * critical))
            for scheme in ("explicit", "implicit"):
                mine = story(cut(on_mesh(scene, patch), strokes, scheme=scheme))
                where = f"{scheme}, {times:g} critical steps, elements of {patch} mm"
                held = (1.05, "below") if scheme == "implicit" else (limit, bound)
                add(f"roughness of the pressure, {where} [-]", roughness(mine.profile), held[0], mine, bound=held[1])
                add(f"worn area, {where} [mm^2]", mine.area, mine.closed_form, mine, tolerance=0.01)
