"""The loaded sections that a run has kept, by stroke and kind."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ngwear.errors import ResultError
from ngwear.results.result_file import ResultFile, Snapshot
from ngwear.results.section import Section
from ngwear.surfaces import RigidSurface


@dataclass(frozen=True)
class KeptSections:
    """Strokes of a run whose loaded section is known.

    Attributes
    ----------
    scene : str
        Name.
    snapshots : sequence of Snapshot
    surfaces : dict of str to RigidSurface
        Of the contacts, in their final place.
    """

    scene: str
    snapshots: Sequence[Snapshot]
    surfaces: Mapping[str, RigidSurface]

    @classmethod
    def of(cls, result: ResultFile) -> KeptSections:
        """Those of a result file."""
        return cls(result.scene, [s for s in result.snapshots if s.section], result.surfaces)

    def __bool__(self) -> bool:
        return bool(self.snapshots)

    @property
    def main_kind(self) -> str:
        """The stroke of the cycle under the highest fluid pressure; the first of those that are alike."""
        first = {s.kind: s for s in reversed(self.snapshots)}
        kinds = list(dict.fromkeys(s.kind for s in self.snapshots))
        return max(kinds, key=lambda kind: Section.of(first[kind].section).fluid_pressure)

    def at(self, stroke: float | None = None, kind: str | None = None) -> Snapshot:
        """The section at a stroke, the latest unless given, of a kind, ``main_kind`` unless given.

        Raises
        ------
        ResultError
            If it is not kept, with those that are.
        """
        if not self:
            raise ResultError(f"the run '{self.scene}' has kept no section: it is of an older version; run it again")
        kinds = list(dict.fromkeys(s.kind for s in self.snapshots))
        kind = self.main_kind if kind is None else kind
        if kind not in kinds:
            raise ResultError(f"no stroke is called '{kind}': the cycle has {kinds}")
        mine = [s for s in self.snapshots if s.kind == kind and stroke in (None, s.stroke)]
        if not mine:
            kept = ", ".join(f"{s:g}" for s in dict.fromkeys(s.stroke for s in self.snapshots if s.kind == kind))
            raise ResultError(
                f"no section is kept of stroke {stroke:g}: those of {kept} are; save.strokes in the scene keeps more"
            )
        return mine[-1]
