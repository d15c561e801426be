"""What the wear cases share: a block under a rigid cylinder that wears it, and runs of a scene."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ngwear.effects.contact_profile import ContactProfile
from ngwear.geometry.outline import Outline
from ngwear.loop.stepper import Stepper
from ngwear.loop.wear_step import CALM
from ngwear.materials import Hyperelastic
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Support
from ngwear.scene.contact import Contact
from ngwear.scene.options import Save, Wear
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Cylinder
from ngwear.wear.backward_differences import share_of_last

if TYPE_CHECKING:
    from ngwear.loop.state import State

CONTACT = "ring"


@dataclass(frozen=True, kw_only=True)
class CylinderOnBlock:
    """A rigid cylinder slides across the top of a block in plane strain and wears it; the bottom is bonded.

    Parameters
    ----------
    material : Hyperelastic
    radius : float
        Of the cylinder [mm].
    load : float
        Force per thickness [N/mm].
    wear_rate : float
        Specific wear rate k [mm²/N].
    size : float
        Height and half width of the block [mm].
    patch : float
        Element edge in the contact [mm].
    travel : float
        Sliding distance of a stroke [mm].
    wear_error : float
        Relative error of worn area that a jump may make [-].
    """

    material: Hyperelastic
    radius: float
    load: float
    wear_rate: float
    size: float
    patch: float
    travel: float
    wear_error: float

    def scene(self, name: str, marks: tuple[int, ...]) -> Scene:
        """Scene whose jumps stop at the given strokes; the last of them ends it."""
        size = self.size
        ring = Cylinder(centre=(0.0, size + self.radius), radius=self.radius)
        return Scene(
            name=name,
            part=Part(Outline.rectangle((-size, size), (0.0, size)), material=self.material),
            contacts=(
                Contact(name=CONTACT, edges=("top",), surface=ring, force=self.load, specific_wear_rate=self.wear_rate),
            ),
            supports=(Support(edges=("bottom",)),),
            program=Program(cycle=(Stroke(name="turn", travel=self.travel),), strokes=marks[-1]),
            accuracy=Accuracy(
                patch=self.patch, coarse=size / 5, mounting=max(self.patch, 0.02), wear_error=self.wear_error
            ),
            wear=Wear(max_jump=marks[-1]),
            save=Save(strokes=marks),
            axisymmetric=False,
        )


@dataclass
class Book:
    """The law's integrals over the contact at every solve, apart from the stepper's own book; filled by ``steps``.

    Attributes
    ----------
    worn : float
        ``sum k ds int P / J dA`` [mm²].
    load : float
        Resultant of the pressure, averaged over the sliding [N/mm].
    mean : float
        ``int P / J dA`` as the last step took it [N/mm]: of its end and, by backward differences, of the step before.
    """

    worn: float = 0.0
    load: float = 0.0
    mean: float = 0.0


def steps(scene: Scene, book: Book | None = None) -> Iterator[State]:
    """Run a scene with one contact and one kind of stroke; yield the state after each accepted step."""
    (spec,), (stroke,) = scene.contacts, scene.program.cycle
    stepper, book = Stepper(scene), book or Book()
    state = stepper.start()
    while not stepper.finished(state):
        (phase,) = state.phases
        before = phase.worn.ways[0] if phase.worn is not None and phase.error <= CALM else 0.0
        state = stepper.advance(state)
        report = state.reports[0]
        profile = report.contacts[spec.name]
        distance = report.repeats * stroke.travel
        load = abs(float(report.forces[spec.name][1]))
        share = report.repeats / state.strokes
        last = share_of_last(distance, before)
        book.mean = last * book.mean + (1 - last) * pressure_over_volume_ratio(scene, profile)
        book.worn += spec.wear_rate.highest * distance * book.mean
        book.load += share * (load - book.load)
        yield state


def pressure_over_volume_ratio(scene: Scene, profile: ContactProfile) -> float:
    """``int P / J dA`` [N/mm] with Hooke's J under a frictionless surface: ln J = -2 p (1 + nu)(1 - 2 nu) / E.

    In plane strain a half-plane's surface under the pressure p has the stresses -p along and across it.
    """
    shear, bulk = scene.part.material.shear_modulus, scene.part.material.bulk_modulus
    # (1 + nu)(1 - 2 nu) / E = 1 / (2 (lambda + G)), lambda = K - 2 G / 3
    compliance = 1 / (2 * (bulk + shear / 3))
    return float(profile.load @ (1 + 2 * compliance * profile.nominal_pressure))


def depth_at(contour: Outline, edge: str, top: float, x: float) -> float:
    """Depth of the worn edge, a graph over x, below the height ``top`` [mm]."""
    on = contour.on((edge,))
    points = contour.points[on | np.roll(on, 1)]
    points = points[np.argsort(points[:, 0])]
    return top - float(np.interp(x, points[:, 0], points[:, 1]))


def half_width(profile: ContactProfile) -> float:
    """Half the distance between the outermost ends of the contact [mm]."""
    zones = profile.zones()
    ends = [end[0] for zone in zones for end in (zone.start, zone.end)]
    return 0.5 * (max(ends) - min(ends))


def middle_pressure(profile: ContactProfile, within: float) -> float:
    """Mean Cauchy pressure over the nodes with |x| <= ``within`` [MPa]."""
    x, order = profile.reference[:, 0], np.argsort(profile.reference[:, 0])
    inside = order[np.abs(x[order]) <= within]
    return float(profile.pressure[inside] @ profile.weight[inside] / profile.weight[inside].sum())
