"""The accepted state of a run: one equilibrium for each stroke of the cycle, and the book of worn material."""

from __future__ import annotations

import math
from copy import copy
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact_profile import ContactProfile
from ngwear.equilibrium.stepping import Work
from ngwear.geometry.cells import Cells, Fate
from ngwear.geometry.outline import Outline
from ngwear.loop.stage import Stage
from ngwear.scene.scene import Scene
from ngwear.surfaces import WornProfile
from ngwear.wear.jump_control import JumpControl

if TYPE_CHECKING:  # no memory, no import of it
    from ngwear.fields.background_mesh import Background
    from ngwear.loop.memory_over_cycles import CycleMemory

Array = NDArray[np.float64]

# Settled on the rod seal with 2.5, 4, 8 and 12 elements across: 48 to 81 solves, 0.94 to 0.10 % along the run
# (``python tests/benchmarks/adaptive_against_fixed.py``).
FALLS = 1.7  # change of the rate of depth over a step, whose square counts as an error: see depth_ratio


@dataclass(frozen=True)
class LastWear:
    """What a stroke of the cycle wore the last time; arrays of shape (contacts, n) are of the outline's points.

    Attributes
    ----------
    pressure : array, shape (contacts, n)
        Depth over way that each contact would wear with its pressure at the end of the last time and the highest wear
        rate, ``k P / J`` [-]. Depths, not areas: a sharp lip's points come closer as it wears.
    mean : array, shape (contacts, n)
        The same of what the last time wore over its way, ``ways`` [-].
    area : array, shape (contacts,)
        Area over way that the last time wore [mm].
    ways : array, shape (contacts,)
        [mm].
    """

    pressure: Array
    mean: Array
    area: Array
    ways: Array


@dataclass
class Phase:
    """What is kept of one stroke of the cycle, for the same stroke of the next one.

    Attributes
    ----------
    vector : array
        Equilibrium of the last time.
    rate : array or None
        Its change per cycle, on the same mesh.
    worn : LastWear or None
    error : float
        Of what the last time wore, relative [-]; infinite if it is not known.
    shares : dict of str to array, or None
        What each mesh edge has slipped over the travel [-], where friction may stick, of the last time on this mesh.
    """

    vector: Array
    rate: Array | None = None
    worn: LastWear | None = None
    error: float = math.inf
    shares: dict[str, Array] | None = None


@dataclass
class Ledger:
    """Book of worn material and of the errors made.

    Attributes
    ----------
    worn : float
        int W dA by the law, as section area [mm²].
    removed : float
        Area taken off the outline's polygon [mm²].
    moment : float
        First moment of that area about y = 0 [mm³]: about the axis of a ring, 2 pi times it is the worn volume.
    depth, rate, share : float
        Greatest depth worn off the outline [mm], what the last step added to it over its share of the program [mm], and
        that share [-].
    area_error : float
        Sum of the steps' embedded errors of worn area [mm²].
    depth_error : float
        What the greatest depth changes by if each point's sum of the steps' errors, with their signs, is taken off it;
        of jumps only, where the scene lets cycles be jumped; positive if it is less by that [mm].
    remesh_jump : float
        Largest relative change of the section's area in a remesh [-].
    lost : dict of Fate to float
        Area of deactivated elements by cause [mm²].
    late : int
        Cycles by which an element may have been torn too late, at the end of a jump.
    """

    worn: float = 0.0
    removed: float = 0.0
    moment: float = 0.0
    depth: float = 0.0
    rate: float = 0.0
    share: float = 0.0
    area_error: float = 0.0
    depth_error: float = 0.0
    remesh_jump: float = 0.0
    remeshes: int = 0
    lost: dict[Fate, float] = field(default_factory=lambda: dict.fromkeys(Fate, 0.0))
    late: int = 0

    def copy(self) -> Ledger:
        """A book of its own with the same entries."""
        return replace(self, lost=dict(self.lost))

    def depth_ratio(self, before: Ledger, share: float, *, left: float) -> float:
        """Book a step's rate; return its error of the depth that the program will reach, over its share of that [-].

        The rate of the step is taken for what is ``left`` of the program; both shares are fractions of it. What a step
        tells of itself changes its sign now and then, and the next one would be far too long; and it cannot see a
        contact's end that runs past whole elements. So the change of the rate over the step, ``FALLS`` times and
        squared, counts as much, for a step as for the program. What it changes by since the step before, it does from
        the middle of that to the middle of this one: over its own length in proportion.
        """
        grown = self.depth - before.depth
        self.rate, self.share = grown / share, share
        end = self.depth + self.rate * left
        if end <= 0:
            return 0.0
        less, more = sorted((before.rate, self.rate))
        falls = FALLS * (1 - less / more) * 2 * share / (before.share + share) if less > 0 else 0.0
        return max(abs(self.depth_error - before.depth_error) / end / share, falls**2)


@dataclass
class State:
    """An accepted state of a run; ``Stepper.advance`` turns one into the next.

    ``depths``, shape (2, n), are the depth worn at the points of the outline and the sum of what its steps err by, with
    their signs [mm]. ``fatigue`` and ``strained`` are what each element has used up of its life, and what the present
    cycle uses up so far [-], of a scene whose damage adds up over cycles; else they are empty.
    """

    stage: Stage
    phases: list[Phase]
    control: JumpControl
    strokes: int = 0
    ledger: Ledger = field(default_factory=Ledger)
    work: Work = field(default_factory=Work)
    depths: Array | None = None
    counters: dict[str, WornProfile] = field(default_factory=dict)
    memory: CycleMemory | None = None
    reports: list[StrokeReport] = field(default_factory=list)
    fatigue: Array = field(default_factory=lambda: np.empty(0))
    strained: Array = field(default_factory=lambda: np.empty(0))
    across: float | None = None

    @property
    def background(self) -> Background | None:
        """Where the memory lives, if the rubber has one."""
        return None if self.memory is None else self.memory.background

    def to_data(self) -> dict[str, Any]:
        """What ``from_data`` makes the same state of, to the last bit; of the scene only what a run changes."""
        data = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "stage"}
        return data | {"accuracy": self.stage.scene.accuracy, "body": self.stage.body}

    @classmethod
    def from_data(cls, data: dict[str, Any], scene: Scene) -> State:
        """The state again, of a run of the same scene."""
        there = replace(scene, accuracy=data["accuracy"])
        memory: CycleMemory | None = data["memory"]
        stage = Stage(there, data["body"], None if memory is None else memory.background)
        return cls(stage, **{f.name: data[f.name] for f in fields(cls) if f.name != "stage"})

    def saved(self) -> dict[str, Any]:
        """What ``take_back`` needs, should a step fail."""
        return {
            "stage": self.stage,
            "contour": self.contour,
            "phases": [replace(p) for p in self.phases],
            "strokes": self.strokes,
            "memory": copy(self.memory),
            "fatigue": self.fatigue,
            "strained": copy(self.strained),
            "reports": self.reports,
            "ledger": self.ledger.copy(),
            "counters": self.counters,
            "depths": self.depths,
        }

    def take_back(self, saved: dict[str, Any]) -> None:
        """Take a step back, and count it as tried."""
        self.work.retries += 1
        contour = saved.pop("contour")
        self.__dict__.update(saved)
        self.stage.body.move_to(contour)

    @property
    def contour(self) -> Outline:
        """The outline as it is now."""
        return self.stage.body.contour

    @property
    def cells(self) -> Cells | None:
        """The elements as they are now, of a scene that deactivates some."""
        return self.stage.body.now if self.stage.scene.deactivation is not None else None


@dataclass(frozen=True)
class StrokeReport:
    """One solved stroke: its equilibrium, and the outline after its wear.

    Attributes
    ----------
    phase : int
        Which stroke of the cycle.
    last_stroke, repeats : int
        Number of the last stroke that this solve stands for, and how many of its kind it stands for.
    iterations : int
        Newton iterations.
    contacts : dict of str to ContactProfile
        The followed contacts at equilibrium.
    forces : dict of str to array, shape (2,)
        Resultants on the part [N, or N/mm].
    heats : dict of str to float
        Heat of the friction in one stroke, of each contact that has friction [mJ, or mJ/mm].
    margins : dict of str to float
        How far each contact that slides in full is from waves that grow along it [-]: below 0 they do.
    coefficients, wear_rates : dict of str to float
        Mean friction coefficient under the pressure [-] and mean k of the strokes [mm²/N], of the contacts whose law is
        no constant.
    counters : dict of str to WornProfile
        Worn profiles of the surfaces that keep one, after the stroke's wear.
    leaks : bool
        Whether the fluid meets no contact.
    leak_pressure : tuple of float and str, or None
        Fluid pressure that the contacts hold [MPa], and the edge that would give way first; None if not asked for.
    contour : Outline
        Outline after the stroke's wear.
    ledger : Ledger
        Book after the stroke's wear.
    cells : Cells or None
        Elements after the stroke's wear, where a scene deactivates some.
    loaded : dict of str to array
        Displacement of their points and stresses in them at equilibrium, likewise.
    section : dict of str to array
        The loaded section (``ngwear.loop.section_snapshot``) at strokes that are kept, else empty.
    """

    phase: int
    last_stroke: int
    repeats: int
    iterations: int
    contacts: dict[str, ContactProfile]
    forces: dict[str, Array]
    heats: dict[str, float]
    margins: dict[str, float]
    coefficients: dict[str, float]
    wear_rates: dict[str, float]
    counters: dict[str, WornProfile]
    leaks: bool
    leak_pressure: tuple[float, str] | None
    contour: Outline
    ledger: Ledger
    cells: Cells | None = None
    loaded: dict[str, Array] = field(default_factory=dict)
    section: dict[str, NDArray[np.generic]] = field(default_factory=dict)
