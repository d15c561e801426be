"""What is simulated, as plain frozen data: no mesh, no solver, nothing that runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, field
from pathlib import Path
from typing import Any

from ngwear.errors import check_fields, require
from ngwear.materials import Folding, Hyperelastic, PronySeries, Stiffened
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Fluid, Support
from ngwear.scene.checks import refuse_in_scene
from ngwear.scene.contact import Contact
from ngwear.scene.deactivation import Deactivation
from ngwear.scene.options import Save, Wear
from ngwear.scene.part import Part
from ngwear.scene.program import Program


@dataclass(frozen=True)
class Scene:
    """Everything that a run needs.

    Parameters
    ----------
    name : str
    part : Part
    contacts : sequence of Contact
    program : Program
        Kept as it is solved: each stroke in ``accuracy.parts``.
    axisymmetric : bool
        Whether the section is (axial, radial) of a ring, as of seals; else plane strain, forces per mm of thickness.
    fluid : Fluid or None
    supports : sequence of Support
    accuracy : Accuracy
    wear : Wear
    deactivation : Deactivation or None
    save : Save

    Raises
    ------
    SceneError
        With the place in the scene, the value found and the remedy.
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

    def write(self, path: Path | str) -> None:
        """Write the scene to a ``.toml`` file and its outline beside it (``ngwear.scene.write_scene``).

        Raises
        ------
        SceneError
            For what a scene file cannot say, such as a law or material of one's own.
        """
        from ngwear.scene.write_scene import write_wear_scene

        write_wear_scene(self, Path(path))

    def _check_kinds(self) -> None:
        """Refuse what is no part, no contact ...; lists become tuples."""
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
        """A rigid body that swallows the part, or that it can never reach, is on the wrong side."""
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
        """Which arms the scene can tell from a spring or from nothing; None without memory.

        Its window reaches from the shortest stroke to the time from mounting to the end.
        """
        if self.part.prony is None:
            return None
        shortest = min(stroke.duration for stroke in self.program.cycle)
        longest = max(self.program.rest + self.program.duration, shortest)
        return self.part.prony.folded(shortest=shortest, longest=longest, tolerance=self.accuracy.folding_error)

    @property
    def rubber(self) -> Hyperelastic:
        """What is solved as elastic: the long-term material, and the arms that never relax here as springs."""
        folding = self.folding
        if folding is None or folding.stiffening == 1:
            return self.part.material
        return Stiffened(
            material=self.part.material, factor=folding.stiffening, bulk_modulus=self.part.material.bulk_modulus
        )

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
        return 2 * mu * float(self.part.outline.points[:, 1].max() - self.part.outline.points[:, 1].min())

    @property
    def marks(self) -> tuple[int, ...]:
        """Strokes as they are solved that a jump must not pass over."""
        return tuple(self.program.parts * strokes for strokes in self.save.strokes)

    @property
    def kept(self) -> tuple[int, ...]:
        """Strokes as they are solved whose sections are kept, new and at the end among them."""
        return (0, *self.marks, self.program.strokes)

    @property
    def worn_edges(self) -> tuple[str, ...]:
        """Names of the edges that wear."""
        return tuple(e for c in self.contacts if c.wears for e in c.edges)

    @property
    def followed(self) -> tuple[Contact, ...]:
        """Contacts that the mesh follows."""
        return tuple(c for c in self.contacts if c.refine or c.wears)
