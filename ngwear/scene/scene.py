"""What is simulated, as plain frozen data: no mesh, no solver, nothing that runs."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from ngwear.errors import require
from ngwear.geometry.outline import Outline
from ngwear.laws import FrictionLaw, WearLaw, WearRate, law_of
from ngwear.materials import Folding, Hyperelastic, PronySeries, Stiffened
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.checks import refuse_in_contact, refuse_in_scene
from ngwear.scene.deactivation import Deactivation
from ngwear.scene.program import Program
from ngwear.surfaces import RigidSurface


@dataclass(frozen=True, kw_only=True)
class Contact:
    """A rigid surface and the edges that may touch it.

    Parameters
    ----------
    name : str
    edges : tuple of str
    surface : RigidSurface
        In its final place; while mounting it comes in from first touch.
    friction : FrictionLaw or float
        Coefficient of friction [-], >= 0.
    slides : bool
        Whether the surface moves along itself in the strokes, as a rod does; a housing stands still.
    sticks : bool or None
        Whether friction may stick, with unknowns and a history of its own, or all of the contact slides in every
        stroke; left to ``Scene.may_stick`` unless given.
    specific_wear_rate : WearRate or float
        Archard's k [mm²/N], >= 0: depth per nominal pressure and sliding distance.
    wear_law : WearLaw or None
        What the wear makes of the pressure, times that k; Archard's law unless given. The surface wears by it too.
    counter_wear_rate : float
        That of the surface, which keeps a worn profile of its own [mm²/N], >= 0; only where the part wears too.
    force : float or None
        Press the surface on with this force [N, or N/mm in plane strain] instead of by its place.
    refine : bool
        Whether the mesh shall follow this contact; wearing contacts always are followed.
    """

    name: str
    edges: tuple[str, ...]
    surface: RigidSurface
    friction: FrictionLaw | float = 0.0
    slides: bool = True
    sticks: bool | None = None
    specific_wear_rate: WearRate | float = 0.0
    wear_law: WearLaw | None = None
    counter_wear_rate: float = 0.0
    force: float | None = None
    refine: bool = False

    def __post_init__(self) -> None:
        place = f"contact '{self.name}'"
        require(bool(self.edges), f"{place}.edges", self.edges, "name at least one edge")
        if not isinstance(self.friction, FrictionLaw):
            require(self.friction >= 0, f"{place}.friction", self.friction, "must be at least 0")
        if not isinstance(self.specific_wear_rate, WearRate):
            rate = self.specific_wear_rate
            require(rate >= 0, f"{place}.specific_wear_rate", rate, "must be at least 0 mm²/N")
        counter = self.counter_wear_rate
        require(counter >= 0, f"{place}.counter_wear_rate", counter, "must be at least 0 mm²/N")
        require(
            self.force is None or self.force > 0, f"{place}.force", self.force, "must be greater than 0 (it presses)"
        )
        refuse_in_contact(self)

    @property
    def friction_law(self) -> FrictionLaw | None:
        """The law of friction; None without any."""
        return law_of(self.friction)

    @property
    def wear_rate(self) -> WearRate:
        """The specific wear rate as a table, of one row for a number."""
        rate = self.specific_wear_rate
        return rate if isinstance(rate, WearRate) else WearRate(distance=(0.0,), rate=(rate,))

    @property
    def wears(self) -> bool:
        """Whether there is any wear."""
        return self.wear_rate.highest > 0


@dataclass(frozen=True, kw_only=True)
class Fluid:
    """Where a sealed fluid may go: ``edges`` in one piece, ``inlet`` always wetted.

    ``leak_pressure`` asks what fluid pressure the contacts hold; meshes are then fine where the fluid meets them, too:
    at its front, as at a punch's edge, a contact often presses hardest.
    """

    edges: tuple[str, ...]
    inlet: tuple[str, ...]
    leak_pressure: bool = False


@dataclass(frozen=True, kw_only=True)
class Support:
    """Edges held at their place in x, y or both."""

    edges: tuple[str, ...]
    x: bool = True
    y: bool = True


@dataclass(frozen=True, kw_only=True)
class Wear:
    """How the worn depth is integrated, and what becomes of the mesh.

    The nodes follow the worn outline, those inside smoothly; a mesh can do so until its elements are squeezed or folded
    (``Body.move_to``). With ``remesh`` other than ``"due"`` it is fine at once wherever the wear may take the contact.

    Parameters
    ----------
    scheme : str
        ``"implicit"`` (backward Euler inside the contact law, stable for every step) or ``"explicit"``.
    step : str
        ``"jump"``: as many cycles at once as ``Accuracy.wear_error`` allows; ``"fixed"``: ``max_jump``, fewer where so
        many fail; ``"each"``: every stroke.
    max_jump : int
        Most cycles at once.
    remesh : str
        ``"due"``: a new mesh as soon as another would be better for the present contact; ``"limit"``: once the nodes
        cannot be moved any further; ``"never"``: the run gives up there.
    """

    scheme: str = "implicit"
    step: str = "jump"
    max_jump: int = 1000
    remesh: str = "due"

    def __post_init__(self) -> None:
        require(self.scheme in ("implicit", "explicit"), "wear.scheme", self.scheme, "must be 'implicit' or 'explicit'")
        require(self.step in ("jump", "fixed", "each"), "wear.step", self.step, "must be 'jump', 'fixed' or 'each'")
        require(self.max_jump >= 1, "wear.max_jump", self.max_jump, "must be at least 1")
        require(
            self.remesh in ("due", "limit", "never"), "wear.remesh", self.remesh, "must be 'due', 'limit' or 'never'"
        )


@dataclass(frozen=True, kw_only=True)
class Save:
    """What a run keeps besides one line a step.

    Parameters
    ----------
    strokes : tuple of int
        Strokes that a jump must not pass over, so that outline and pressure are kept just there.
    vtk : bool
        Whether the deformed mesh is written for ParaView at these strokes and at the end.
    """

    strokes: tuple[int, ...] = ()
    vtk: bool = False

    def __post_init__(self) -> None:
        require(all(n > 0 for n in self.strokes), "save.strokes", self.strokes, "must be whole numbers above 0")


@dataclass(frozen=True, kw_only=True)
class Scene:
    """Everything that a run needs.

    ``material`` is the long-term behaviour, ``prony`` the arms of its memory, if any, at the scene's temperature.
    ``program`` is kept as it is solved, each stroke in ``accuracy.parts``.

    Raises
    ------
    SceneError
        With the place in the scene, the value found and the remedy.
    """

    name: str
    contour: Outline
    material: Hyperelastic
    contacts: tuple[Contact, ...]
    program: Program
    prony: PronySeries | None = None
    axisymmetric: bool = False
    fluid: Fluid | None = None
    supports: tuple[Support, ...] = ()
    accuracy: Accuracy = field(default_factory=Accuracy)
    wear: Wear = field(default_factory=Wear)
    deactivation: Deactivation | None = None
    save: Save = field(default_factory=Save)

    def __post_init__(self) -> None:
        object.__setattr__(self, "program", self.program.divided(self.accuracy.parts))
        known = self.contour.edge_names
        users = [(f"contact '{c.name}'.edges", c.edges) for c in self.contacts]
        users += [(f"support[{i}].edges", s.edges) for i, s in enumerate(self.supports)]
        if self.fluid is not None:
            users += [("fluid.edges", self.fluid.edges), ("fluid.inlet", self.fluid.inlet)]
            require(
                set(self.fluid.inlet) <= set(self.fluid.edges) and bool(self.fluid.inlet),
                "fluid.inlet",
                self.fluid.inlet,
                f"must name some of the fluid's edges {list(self.fluid.edges)}",
            )
        for place, edges in users:
            for edge in edges:
                require(edge in known, place, edge, f"the outline has no such edge; it has {list(known)}")
        names = [c.name for c in self.contacts]
        require(len(set(names)) == len(names), "contact.name", names, "must differ from each other")
        if self.axisymmetric:
            lowest = float(self.contour.points[:, 1].min())
            require(lowest > 0, "contour", lowest, "an axisymmetric section must lie above the axis: radii > 0 mm")
        refuse_in_scene(self)
        for contact in self.contacts:
            self._check_side(contact)

    def _check_side(self, contact: Contact) -> None:
        """A rigid body that swallows the part, or that it can never reach, is on the wrong side."""
        from shapely import Polygon

        centre = Polygon(self.contour.points).centroid
        gap = float(contact.surface.gap(centre.x, centre.y))
        require(
            gap > 0 and math.isfinite(gap),
            f"contact '{contact.name}'.surface",
            contact.surface,
            f"lies on the wrong side: the middle of the section is {-gap:.4g} mm inside the rigid body; "
            "check diameters, point and normal",
        )

    @property
    def folding(self) -> Folding | None:
        """Which arms the scene can tell from a spring or from nothing; None without memory.

        Its window reaches from the shortest stroke to the time from mounting to the end.
        """
        if self.prony is None:
            return None
        shortest = min(stroke.duration for stroke in self.program.cycle)
        longest = max(self.program.rest + self.program.duration, shortest)
        return self.prony.folded(shortest=shortest, longest=longest, tolerance=self.accuracy.folding_error)

    @property
    def rubber(self) -> Hyperelastic:
        """What is solved as elastic: the long-term material, and the arms that never relax here as springs."""
        folding = self.folding
        if folding is None or folding.stiffening == 1:
            return self.material
        return Stiffened(material=self.material, factor=folding.stiffening, bulk_modulus=self.material.bulk_modulus)

    @property
    def arms(self) -> PronySeries | None:
        """Arms that need a memory, relative to ``rubber``; None if there are none."""
        folding = self.folding
        return folding.kept if folding is not None and folding.kept.times else None

    def may_stick(self, contact: Contact) -> bool:
        """Whether a contact's friction is solved as stick and slip; see ``why_it_may_stick``."""
        return self._sticking(contact)[0]

    def why_it_may_stick(self, contact: Contact) -> str:
        """Reason in words why a contact's friction is solved as stick and slip, or as full sliding."""
        return self._sticking(contact)[1]

    def _sticking(self, contact: Contact) -> tuple[bool, str]:
        """At a reversal a surface first carries the part along, at most by ``2 mu p / G`` of its height; p about G."""
        if contact.friction_law is None:
            return False, "no friction"
        if contact.sticks is not None:
            return contact.sticks, "as the scene asks"
        if not contact.slides:
            return True, "the surface stands still"
        strokes = self.program.cycle
        if len({math.copysign(1.0, stroke.direction) for stroke in strokes}) == 1:
            return False, "the sliding never turns round"
        carried, shortest = self.elastic_slip(contact), self.program.shortest_way
        told = f"the shortest stroke is {shortest:.3g} mm, an elastic slip about {carried:.2g} mm at most"
        return shortest < carried, told

    def elastic_slip(self, contact: Contact) -> float:
        """How far at most a surface carries the part along before it slips [mm]: ``2 mu`` of its height, p about G."""
        law = contact.friction_law
        if law is None:
            return 0.0
        end = self.program.slid(self.program.strokes)
        mu = max(law.curve(stroke.speed).extremes(0.0, end)[1] for stroke in self.program.cycle)
        return 2 * mu * float(self.contour.points[:, 1].max() - self.contour.points[:, 1].min())

    @property
    def marks(self) -> tuple[int, ...]:
        """Strokes as they are solved that a jump must not pass over."""
        return tuple(self.program.parts * strokes for strokes in self.save.strokes)

    @property
    def worn_edges(self) -> tuple[str, ...]:
        """Names of the edges that wear."""
        return tuple(e for c in self.contacts if c.wears for e in c.edges)

    @property
    def followed(self) -> tuple[Contact, ...]:
        """Contacts that the mesh follows."""
        return tuple(c for c in self.contacts if c.refine or c.wears)
