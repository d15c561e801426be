"""The scene: part, contacts, program and options of a simulation, as frozen dataclasses."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, field, replace
from pathlib import Path
from typing import Any

from ngwear.errors import check_fields, require
from ngwear.materials import Folding, Hyperelastic, PronySeries, Stiffened
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Fluid, Support
from ngwear.scene.checks import refuse_in_scene
from ngwear.scene.contact import ANY_EDGE, Contact
from ngwear.scene.deactivation import Deactivation
from ngwear.scene.holding import free_directions
from ngwear.scene.options import Save, Wear
from ngwear.scene.part import Part
from ngwear.scene.program import Program
from ngwear.scene.room import refuse_fluids, refuse_without_room


@dataclass(frozen=True)
class Scene:
    """The complete input of a wear simulation.

    Parameters
    ----------
    name : str
    part : Part
    contacts : sequence of Contact
    program : Program
        Stored as it is solved: each stroke divided into ``accuracy.parts``.
    axisymmetric : bool
        True: the section is (axial, radial) of a ring, as of seals. False: plane strain, forces per mm of thickness.
    fluid : Fluid or None
    supports : sequence of Support
    accuracy : Accuracy
    wear : Wear
    deactivation : Deactivation or None
    save : Save

    Raises
    ------
    SceneError
        If a value is wrong, or two contradict each other: with the place, the value and the remedy.
    """

    name: str
    part: Part
    _: KW_ONLY
    contacts: Sequence[Contact]
    program: Program
    axisymmetric: bool = True
    fluid: Fluid | None = None
    supports: Sequence[Support] = ()
    accuracy: Accuracy = field(default_factory=Accuracy)
    wear: Wear = field(default_factory=Wear)
    deactivation: Deactivation | None = None
    save: Save = field(default_factory=Save)

    def __post_init__(self) -> None:
        self._check_kinds()
        object.__setattr__(self, "program", self.program.divided(self.accuracy.parts))
        known = self.part.outline.edge_names
        whole = [replace(c, edges=known) if tuple(c.edges) == (ANY_EDGE,) else c for c in self.contacts]
        object.__setattr__(self, "contacts", tuple(whole))
        users = [(f"contact '{c.name}'.edges", c.edges) for c in self.contacts]
        users += [(f"support[{i}].edges", s.edges) for i, s in enumerate(self.supports)]
        if self.fluid is not None:
            users.append(("fluid.edges", self.fluid.edges))
        for place, edges in users:
            for edge in edges:
                require(edge in known, place, edge, f"the outline has no such edge; it has {list(known)}")
        names = [c.name for c in self.contacts]
        require(len(set(names)) == len(names), "contact.name", names, "must differ from each other")
        if self.axisymmetric:
            lowest = float(self.part.outline.points[:, 1].min())
            require(
                lowest > 0,
                "contour",
                lowest,
                "an axisymmetric section must lie above the axis, radii > 0 mm; or make it plane strain",
            )
        refuse_in_scene(self)
        for contact in self.contacts:
            self._check_side(contact)
        refuse_without_room(self)
        if self.fluid is not None:
            refuse_fluids(self)
        if free_directions(self):  # it may roll onto any edge
            object.__setattr__(self, "contacts", tuple(replace(c, edges=known) for c in self.contacts))

    def write(self, path: Path | str) -> None:
        """Write the scene to a ``.toml`` file and its outline beside it (``ngwear.scene.write_scene``).

        Raises
        ------
        SceneError
            If a scene file cannot represent something, such as a user-defined law or material.
        """
        from ngwear.scene.write_scene import write_wear_scene

        write_wear_scene(self, Path(path))

    def _check_kinds(self) -> None:
        """Check the classes of all fields; lists become tuples."""
        check_fields(self, "scene")
        kinds: dict[str, Any] = {"part": Part, "program": Program, "accuracy": Accuracy, "wear": Wear, "save": Save}
        for name, kind in kinds.items():
            value = getattr(self, name)
            require(isinstance(value, kind), name, value, f"must be of the class {kind.__name__}")
        for name, kind in {"fluid": Fluid, "deactivation": Deactivation}.items():
            value = getattr(self, name)
            require(value is None or isinstance(value, kind), name, value, f"must be of the class {kind.__name__}")
        for name, kind in {"contacts": Contact, "supports": Support}.items():
            values = getattr(self, name)
            right = isinstance(values, Sequence) and all(isinstance(value, kind) for value in values)
            require(right, name, values, f"must be a list of the class {kind.__name__}")
            object.__setattr__(self, name, tuple(values))

    def _check_side(self, contact: Contact) -> None:
        """SceneError if the middle of the section lies inside the rigid body: the surface is on the wrong side."""
        from shapely import Polygon

        centre = Polygon(self.part.outline.points).centroid
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
        """Which relaxation times need a memory, act as springs, or are always relaxed; None without memory.

        The time window reaches from the duration of the shortest stroke to the time from mounting to the end.
        """
        if self.part.prony is None:
            return None
        shortest = min(stroke.duration for stroke in self.program.cycle)
        longest = max(self.program.rest + self.program.duration, shortest)
        return self.part.prony.folded(shortest=shortest, longest=longest, tolerance=self.accuracy.folding_error)

    @property
    def rubber(self) -> Hyperelastic:
        """The elastic material: long-term behaviour, and the arms that never relax in this scene, as springs."""
        folding = self.folding
        if folding is None or folding.stiffening == 1:
            return self.part.material
        return Stiffened(
            material=self.part.material, factor=folding.stiffening, bulk_modulus=self.part.material.bulk_modulus
        )

    @property
    def arms(self) -> PronySeries | None:
        """Prony series of the arms that need a memory, moduli relative to ``rubber``; None without any."""
        folding = self.folding
        return folding.kept if folding is not None and folding.kept.times else None

    def may_stick(self, contact: Contact) -> bool:
        """Whether friction in a contact is solved as stick and slip; see ``why_it_may_stick``."""
        return self._sticking(contact)[0]

    def why_it_may_stick(self, contact: Contact) -> str:
        """Reason, as text, why friction in a contact is solved as stick and slip, or as full sliding."""
        return self._sticking(contact)[1]

    def _sticking(self, contact: Contact) -> tuple[bool, str]:
        """After a reversal a contact sticks over at most ``2 mu p / G`` times the height of the part; p is about G."""
        if contact.friction_law is None:
            return False, "no friction"
        if contact.sticks is not None:
            return contact.sticks, "as the scene asks"
        if not contact.slides:
            return True, "the surface does not slide"
        strokes = self.program.cycle
        if len({math.copysign(1.0, stroke.direction) for stroke in strokes}) == 1:
            return False, "the direction of sliding never changes"
        carried, shortest = self.elastic_slip(contact), self.program.shortest_way
        reason = f"the shortest stroke is {shortest:.3g} mm, an elastic slip about {carried:.2g} mm at most"
        return shortest < carried, reason

    def elastic_slip(self, contact: Contact) -> float:
        """Largest travel before the contact slips [mm]: ``2 mu`` times the height of the part; p is about G."""
        law = contact.friction_law
        if law is None:
            return 0.0
        end = self.program.slid(self.program.strokes)
        mu = max(law.curve(stroke.speed).extremes(0.0, end)[1] for stroke in self.program.cycle)
        return 2 * mu * float(self.part.outline.points[:, 1].max() - self.part.outline.points[:, 1].min())

    @property
    def marks(self) -> tuple[int, ...]:
        """Numbers of solved strokes that no cycle jump may pass (``save.strokes``)."""
        return tuple(self.program.parts * strokes for strokes in self.save.strokes)

    @property
    def kept(self) -> tuple[int, ...]:
        """Numbers of solved strokes whose loaded section is saved; the first and the last are among them."""
        return (0, *self.marks, self.program.strokes)

    @property
    def worn_edges(self) -> tuple[str, ...]:
        """Names of the edges that wear."""
        return tuple(e for c in self.contacts if c.wears for e in c.edges)

    @property
    def followed(self) -> tuple[Contact, ...]:
        """Contacts in which the mesh is refined, and which results hold: all if none wears and none asks for it."""
        return tuple(c for c in self.contacts if c.refine or c.wears) or tuple(self.contacts)
