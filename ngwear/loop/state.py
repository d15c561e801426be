"""The accepted state of a run: one equilibrium for each stroke of the cycle, and the ledger of worn material."""

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
from ngwear.loop.solution_checks import Finding
from ngwear.loop.stage import Stage
from ngwear.scene.scene import Scene
from ngwear.surfaces import WornProfile
from ngwear.wear.jump_control import JumpControl

if TYPE_CHECKING:  # modules of effects that a scene does not have are not imported
    from ngwear.effects.blow_by import BlowBy
    from ngwear.fields.background_mesh import Background
    from ngwear.loop.memory_over_cycles import CycleMemory

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LastWear:
    """Wear of a stroke of the cycle in its last step; arrays of shape (contacts, n) belong to the outline points.

    Attributes
    ----------
    end : array, shape (contacts, n)
        Worn area over sliding distance by the pressure of the end of the step and the largest wear rate, ``k P / J``
        times the length of the outline there [mm].
    mean : array, shape (contacts, n)
        Mean of the same over the step: worn area over ``ways`` [mm].
    lengths : array, shape (2, n)
        Length of the outline at each point at the end of the step, and halfway [mm].
    ways : array, shape (contacts,)
        Equivalent sliding distance of the step, ``int k ds / max k`` [mm].
    """

    end: Array
    mean: Array
    lengths: Array
    ways: Array


@dataclass
class Phase:
    """Data of one stroke of the cycle, for the solve of the same stroke in the next step.

    Attributes
    ----------
    vector : array
        Last equilibrium.
    rate : array or None
        Its change per cycle, on the same mesh.
    worn : LastWear or None
        Wear of the last step.
    error : float
        Relative error of the last worn area [-]; infinite if it is not known.
    shares : dict of str to array, or None
        Slip over travel at the nodes [-], of each contact with stick and slip, in the last solve on this mesh.
    path : list of tuple of float and array
        Load steps from the previous stroke in the last solve on this mesh, if friction sticks and one step failed: the
        fraction of the way and the equilibrium there.
    fewest : bool
        Whether half as many load steps have failed.
    stays : bool
        Whether the last solve began at this stroke's own end in the cycle before.
    failed, rests : int
        How often in a row a solve at once has failed, and how many solves are done in load steps before it is tried
        again.
    passed : array or None
        Reference places up to which the fluid has lifted contacts (``FluidPressure.passed``); None without.
    left : array or None
        What the fluids leave at its end (``TrappedFluid.leaves``), if pockets keep it.
    """

    vector: Array
    rate: Array | None = None
    worn: LastWear | None = None
    error: float = math.inf
    shares: dict[str, Array] | None = None
    path: list[tuple[float, Array]] = field(default_factory=list)
    fewest: bool = False
    stays: bool = False
    failed: int = 0
    rests: int = 0
    passed: Array | None = None
    left: Array | None = None


@dataclass
class Ledger:
    """Sums of worn material and of estimated errors.

    Attributes
    ----------
    worn : float
        Worn section area by the wear law [mm²].
    removed : float
        Area removed from the outline's polygon [mm²].
    moment : float
        First moment of that area about y = 0 [mm³]; 2 pi times it is the worn volume of a ring.
    depth : float
        Maximum worn depth [mm].
    area_error : float
        Sum of the embedded error estimates of worn area over all steps [mm²].
    depth_error : float
        Change of the maximum depth if the sum of the signed error estimates is subtracted at each point [mm]; positive
        if the depth is overestimated. With ``wear.step = "jump"`` only steps of several cycles count.
    step_error : float
        Sum of what each step by itself adds to that, as it is at the end of the step [mm].
    remesh_jump : float
        Largest relative change of the section's area by remeshing [-].
    remeshes : int
        Number of new meshes.
    lost : dict of Fate to float
        Area of deactivated elements by cause [mm²].
    late : int
        Largest number of cycles by which an element may be torn too late, at the end of a jump.
    """

    worn: float = 0.0
    removed: float = 0.0
    moment: float = 0.0
    depth: float = 0.0
    area_error: float = 0.0
    depth_error: float = 0.0
    step_error: float = 0.0
    remesh_jump: float = 0.0
    remeshes: int = 0
    lost: dict[Fate, float] = field(default_factory=lambda: dict.fromkeys(Fate, 0.0))
    late: int = 0

    def copy(self) -> Ledger:
        """An independent copy."""
        return replace(self, lost=dict(self.lost))

    def depth_ratio(self, before: Ledger, share: float, *, left: float) -> float:
        """A step's error of the final depth over its share of the program [-].

        The final depth is extrapolated with the rate of the step over the part of the program that is ``left``; both
        shares are fractions of the program.
        """
        end = self.depth + (self.depth - before.depth) / share * left
        return abs(self.step_error - before.step_error) / end / share if end > 0 else 0.0


@dataclass
class State:
    """An accepted state of a run; ``Stepper.advance`` turns one into the next.

    ``depths``, shape (2, n), are worn depth and sum of the signed error estimates at the points of the outline [mm].
    ``fatigue`` is the accumulated damage of each element, and ``strained`` that of the present cycle so far [-]; both
    are empty unless damage accumulates over cycles. ``fine``, shape (k, 3), are places and the element edges that
    solves have asked for there [mm]; ``halved`` and ``refined`` say how often (``ngwear.loop.finer_mesh``).
    ``mesh_errors`` are relative errors by the mesh, by name; when they were computed, ``first_wear`` [N] was the
    largest wear per cycle, and ``wear_changes``, shape (k, 4), are places [mm], their wear per cycle, and its change on
    the other mesh [N] (``ngwear.loop.halved_elements``). ``placed``: where it is mounted, from where it is drawn [mm]
    (``ngwear.loop.placing``).
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
    fine: Array = field(default_factory=lambda: np.empty((0, 3)))
    halved: int = 0
    refined: int = 0
    mesh_errors: dict[str, float] = field(default_factory=dict)
    first_wear: float = 0.0
    wear_changes: Array = field(default_factory=lambda: np.empty((0, 4)))
    placed: tuple[float, float] = (0.0, 0.0)

    @property
    def background(self) -> Background | None:
        """The mesh on which the memory is stored; None without memory."""
        return None if self.memory is None else self.memory.background

    def to_data(self) -> dict[str, Any]:
        """The state as plain data, from which ``from_data`` restores it exactly; of the scene only the accuracy."""
        data = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "stage"}
        stage = self.stage
        return data | {"accuracy": stage.scene.accuracy, "body": stage.body, "friction_shares": stage.friction_shares}

    @classmethod
    def from_data(cls, data: dict[str, Any], scene: Scene) -> State:
        """Restore the state from plain data, with the same scene."""
        there = replace(scene, accuracy=data["accuracy"])
        memory: CycleMemory | None = data["memory"]
        background = None if memory is None else memory.background
        stage = Stage(there, data["body"], background, data["friction_shares"])
        return cls(stage, **{f.name: data[f.name] for f in fields(cls) if f.name != "stage"})

    def saved(self) -> dict[str, Any]:
        """Data for ``restore``, in case a step fails."""
        return {
            "stage": self.stage,
            "contour": self.contour,
            "friction_shares": dict(self.stage.friction_shares),
            "phases": [replace(p) for p in self.phases],
            "strokes": self.strokes,
            "memory": copy(self.memory),
            "fatigue": self.fatigue,
            "strained": copy(self.strained),
            "reports": self.reports,
            "ledger": self.ledger.copy(),
            "counters": self.counters,
            "depths": self.depths,
            "fine": self.fine,
            "halved": self.halved,
            "refined": self.refined,
        }

    def restore(self, saved: dict[str, Any]) -> None:
        """Restore the state before a rejected step, and count the retry."""
        self.work.retries += 1
        contour, shares = saved.pop("contour"), saved.pop("friction_shares")
        self.__dict__.update(saved)
        self.stage.friction_shares = shares
        self.stage.body.move_to(contour)

    @property
    def contour(self) -> Outline:
        """The present outline."""
        return self.stage.body.contour

    @property
    def cells(self) -> Cells | None:
        """The present elements of a scene that deactivates some; else None."""
        return self.stage.body.now if self.stage.scene.deactivation is not None else None


@dataclass(frozen=True)
class StrokeReport:
    """One solved stroke: its equilibrium, and the outline after its wear.

    Attributes
    ----------
    phase : int
        Index of the stroke in the cycle.
    last_stroke, repeats : int
        Number of the last stroke for which this solve stands, and the number of strokes of this kind.
    iterations : int
        Newton iterations.
    contacts : dict of str to ContactProfile
        The refined contacts at equilibrium.
    forces : dict of str to array, shape (2,)
        Resultants on the part [N, or N/mm].
    heats : dict of str to float
        Frictional heat of one stroke, of each contact with friction [mJ, or mJ/mm].
    margins : dict of str to float
        Stability margin of each contact in full sliding [-]; below 0, waves grow along it.
    coefficients, wear_rates : dict of str to float
        Mean friction coefficient, weighted by pressure [-], and mean k over the strokes [mm²/N], of contacts whose law
        is not constant.
    counters : dict of str to WornProfile
        Profiles of the surfaces that wear, after the stroke.
    leaks : bool
        Whether no contact stops the fluid.
    leak_pressure : tuple of float and str, or None
        Fluid pressure that the contacts hold [MPa], and the edge that would leak first; None if not asked for.
    contour : Outline
        Outline after the wear of the stroke.
    ledger : Ledger
        Ledger after the wear of the stroke.
    cells : Cells or None
        Elements after the wear of the stroke, if the scene deactivates some.
    loaded : dict of str to array
        Displacement of their points and stresses in them at equilibrium.
    section : dict of str to array
        The loaded section (``ngwear.loop.section_snapshot``) at strokes that are saved, else empty.
    findings : tuple of Finding
        What a reader must know of this solve (``ngwear.loop.solution_checks``).
    blow_by : tuple of BlowBy
        Fluids that no contact holds.
    comes_further : bool
        Whether a fluid would come further into a contact, within what contact pressures err by.
    turned : float
        Angle by which a part with room to move has turned [degrees].
    trapped : float or None
        Highest pressure in a pocket [MPa]; None if pockets keep none.
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
    findings: tuple[Finding, ...] = ()
    blow_by: tuple[BlowBy, ...] = ()
    comes_further: bool = False
    turned: float = 0.0
    trapped: float | None = None


def with_findings(reports: list[StrokeReport], found: list[Finding]) -> list[StrokeReport]:
    """The reports, the last with these findings too."""
    if not found:
        return reports
    *others, last = reports
    return [*others, replace(last, findings=(*last.findings, *found))]
