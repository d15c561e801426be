"""The loaded sections that a run has saved, by stroke and kind."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ngwear.errors import ResultError
from ngwear.results.result_file import ResultFile, Snapshot
from ngwear.results.section import Section
from ngwear.surfaces import RigidSurface


@dataclass(frozen=True)
class KeptSections:
    """Strokes of a run whose loaded section is saved.

    Attributes
    ----------
    scene : str
        Name of the scene.
    snapshots : sequence of Snapshot
    surfaces : dict of str to RigidSurface
        Surface of each contact in its final position.
    """

    scene: str
    snapshots: Sequence[Snapshot]
    surfaces: Mapping[str, RigidSurface]

    @classmethod
    def of(cls, result: ResultFile) -> KeptSections:
        """The sections in a result file."""
        return cls(result.scene, [s for s in result.snapshots if s.section], result.surfaces)

    def __bool__(self) -> bool:
        return bool(self.snapshots)

    @property
    def main_kind(self) -> str:
        """Name of the stroke with the highest fluid pressure; the first one if several are equal."""
        first = {s.kind: s for s in reversed(self.snapshots)}
        kinds = list(dict.fromkeys(s.kind for s in self.snapshots))
        return max(kinds, key=lambda kind: Section.of(first[kind].section).fluid_pressure)

    def at(self, stroke: float | None = None, kind: str | None = None) -> Snapshot:
        """The section at a stroke (default the last) of a kind (default ``main_kind``).

        Raises
        ------
        ResultError
            If it is not saved; the message lists those that are.
        """
        if not self:
            raise ResultError(f"the run '{self.scene}' has no saved section: it is of an older version; run it again")
        kinds = list(dict.fromkeys(s.kind for s in self.snapshots))
        kind = self.main_kind if kind is None else kind
        if kind not in kinds:
            raise ResultError(f"no stroke is called '{kind}': the cycle has {kinds}")
        mine = [s for s in self.snapshots if s.kind == kind and stroke in (None, s.stroke)]
        if not mine:
            kept = ", ".join(f"{s:g}" for s in dict.fromkeys(s.stroke for s in self.snapshots if s.kind == kind))
            raise ResultError(
                f"the section of stroke {stroke:g} is not saved; saved: {kept}; save.strokes in the scene adds more"
            )
        return mine[-1]
