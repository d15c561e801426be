"""Records of a run, and its files series.csv, result.h5 and summary.json."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ngwear.files.hdf5 import mark, put, put_series, subgroup, write
from ngwear.files.peak_memory import peak_memory
from ngwear.files.result_folder import CHECKPOINT, FIELDS, SUMMARY, OutFolder
from ngwear.files.subnormal import without_subnormals
from ngwear.files.version import VERSION
from ngwear.geometry.cells import Fate
from ngwear.geometry.outline import Outline
from ngwear.geometry.sizing import divided
from ngwear.results.kept_sections import KeptSections
from ngwear.results.resting import elsewhere, resting, rests
from ngwear.results.result_file import CONTACT, PART, WEAR_RATE, Snapshot
from ngwear.results.surface_text import surface_text
from ngwear.scene.scene import Scene
from ngwear.units import UNITS, energy_unit, force_unit

Array = NDArray[np.float64]


def fingerprint(scene: Scene) -> str:
    """Hash of a scene, to check whether a folder belongs to it."""
    contour = scene.part.outline
    rest = [repr(getattr(scene, f.name)) for f in fields(scene) if f.name != "contour"]
    content = [contour.points.tobytes(), contour.corners.tobytes(), repr((contour.names, rest)).encode()]
    return hashlib.sha256(b"".join(content)).hexdigest()


POINTS_ALONG = 200  # number of points for the depth on a straight edge as long as the section
LOST = {Fate.TORN: "tearing", Fate.DISTORTED: "distortion", Fate.LOOSE: "coming loose"}
LEAK, EDGE = "leak pressure [MPa]", "element edge in contact [mm]"
WITHOUT_STEPS = "maximum depth without the error of the steps [mm]"
TORN = "area lost in all by tearing [-]"  # part of the error of the total lost area
LOST_AREAS = LOST | {Fate.WORN: "merging"}  # lost areas; merging of surface nodes changes the area a little


def depths(before: Outline, after: Outline) -> Array:
    """Worn depth: distance of each point of the unworn outline from the worn one [mm], shape (n,)."""
    from shapely import STRtree, linestrings, points

    segments = STRtree(linestrings(np.stack([after.points, np.roll(after.points, -1, axis=0)], axis=1)))
    _, found = segments.query_nearest(points(before.points), return_distance=True, all_matches=False)
    return found


def measured_at(scene: Scene) -> Outline:
    """The scene's outline with additional points on straight worn edges; depths are measured at its points."""
    longest = float(np.ptp(scene.part.outline.points, axis=0).max()) / POINTS_ALONG
    return divided(scene.part.outline, scene.worn_edges, longest)


@dataclass
class Recorder:
    """Rows and snapshots of a run so far, as plain data that a checkpoint stores.

    ``unworn`` is the outline from which depths are measured: that of the scene, or of its elements. ``findings`` holds
    the worst of each kind and place: how much, at which stroke, and the sentence. ``blow_by`` holds the first stroke of
    each kind in which a fluid passes all contacts, and where.
    """

    scene: Scene
    rows: list[dict[str, Any]] = field(default_factory=list)
    snapshots: list[Snapshot] = field(default_factory=list)
    wall: float = 0.0
    cpu: float = 0.0
    unworn: Outline | None = None
    unworn_area: float = 0.0
    findings: dict[str, list[Any]] = field(default_factory=dict)
    blow_by: list[dict[str, Any]] = field(default_factory=list)

    def to_data(self) -> dict[str, Any]:
        """The records as plain data for ``from_data``, without the scene."""
        return {f.name: getattr(self, f.name) for f in fields(self) if f.name != "scene"}

    @classmethod
    def from_data(cls, data: dict[str, Any], scene: Scene) -> Recorder:
        """Restore the records of a run of the same scene."""
        return cls(scene, **data)

    def add(self, state: Any, *, wall: float) -> None:
        """Add the strokes of the state's last step."""
        unworn: Outline | None = self.unworn
        if unworn is None:
            unworn = measured_at(self.scene) if state.cells is None else state.contour
            self.unworn, self.unworn_area = unworn, unworn.area
        for report in state.reports:
            self._add_blow_by(report)
            self.rows.append(self._row(state, report, wall, unworn))
            self.snapshots.append(self._snapshot(report))
            for found in report.findings:
                if found.amount > self.findings.get(found.key, [0.0])[0]:
                    stroke = self.scene.program.counted(report.last_stroke)
                    self.findings[found.key] = [found.amount, stroke, found.sentence]

    def _add_blow_by(self, report: Any) -> None:
        """Keep the first stroke of each kind in which a fluid passes all contacts."""
        kind = self.scene.program.cycle[report.phase].name
        for blown in report.blow_by:
            known = [(found["kind"], found["inlet"]) for found in self.blow_by]
            if (kind, blown.inlet) not in known:
                self.blow_by.append(
                    {
                        "kind": kind,
                        "stroke": self.scene.program.counted(report.last_stroke),
                        "inlet": blown.inlet,
                        "edge": blown.edge,
                        "fluid pressure [MPa]": blown.pressure,
                        "highest contact pressure [MPa]": blown.holds,
                    }
                )

    def _row(self, state: Any, report: Any, wall: float, unworn: Outline) -> dict[str, Any]:
        scene = self.scene
        cycle = scene.program.cycle
        unit = force_unit(scene.axisymmetric)
        depth = depths(unworn, report.contour)
        ledger = report.ledger
        row: dict[str, Any] = {
            "stroke [-]": scene.program.counted(report.last_stroke),
            "kind [-]": cycle[report.phase].name,
            "strokes in one solve [-]": report.repeats,  # 0: solved without wear
            "sliding distance [mm]": scene.program.slid(report.last_stroke),
            "worn area by the law [mm^2]": ledger.worn,
            "area removed from the outline [mm^2]": ledger.removed,
            "error estimate of worn area [mm^2]": ledger.area_error,
            "maximum depth [mm]": float(depth.max()),
            "error estimate of maximum depth [mm]": abs(ledger.depth_error),
            WITHOUT_STEPS: float(depth.max()) - ledger.depth_error,
        }
        for name in dict.fromkeys(scene.worn_edges):
            row[f"depth at {name} [mm]"] = float(depth[unworn.on((name,))].max())
        if report.cells is not None:
            row |= self._lost_areas(report)
        for contact, profile in report.contacts.items():
            zones = profile.zones()
            highest = max(zones, key=lambda z: z.peak, default=None)
            row[f"{contact} peak pressure [MPa]"] = 0.0 if highest is None else highest.peak
            row[f"{contact} width at the peak [mm]"] = 0.0 if highest is None else highest.width
            row[f"{contact} contact width [mm]"] = sum(z.width for z in zones)
            row[f"{contact} contact zones [-]"] = len(zones)
            row[f"{contact} {EDGE}"] = profile.element_edge
        for name, counter in report.counters.items():
            row[f"{name} counter-surface depth [mm]"] = float(counter.depth.max())
            row[f"{name} counter-surface worn area [mm^2]"] = counter.area
        for name, force in report.forces.items():
            row[f"{name} force x [{unit}]"], row[f"{name} force y [{unit}]"] = (float(f) for f in force)
        row |= resting(scene, report.forces, report.turned)
        for name, heat in report.heats.items():
            row[f"{name} friction heat of the stroke [{energy_unit(scene.axisymmetric)}]"] = heat
        row |= {f"{name} margin of steady sliding [-]": margin for name, margin in report.margins.items()}
        row |= {f"{name} friction coefficient [-]": mu for name, mu in report.coefficients.items()}
        row |= {f"{name} specific wear rate [mm^2/N]": rate for name, rate in report.wear_rates.items()}
        if scene.fluid is not None:
            row["blow-by [-]"] = len(report.blow_by)
        if report.trapped is not None:
            row["pressure trapped in pockets [MPa]"] = report.trapped
        if report.leak_pressure is not None:
            row[LEAK], row["leaks first at [-]"] = report.leak_pressure
        row |= {
            "leaks [-]": int(report.leaks),
            "Newton iterations [-]": report.iterations,
            "solves [-]": state.work.solves,
            "retries [-]": state.work.retries,
            "remeshes [-]": ledger.remeshes,
            "elements [-]": state.stage.body.mesh.ne if report.cells is None else int(report.cells.living.sum()),
            "wall time [s]": round(wall, 3),
        }
        return row

    def _lost_areas(self, report: Any) -> dict[str, Any]:
        """Lost area and elements by cause, in total and in the last solve."""
        ledger, before = report.ledger, self.rows[-1] if self.rows else {}
        areas = {"wear": ledger.removed} | {name: ledger.lost[fate] for fate, name in LOST_AREAS.items()}
        out: dict[str, Any] = {f"area lost by {name} [mm^2]": area for name, area in areas.items()}
        out["area lost in all [mm^2]"] = self.unworn_area - report.cells.area
        out |= {f"{k[:-7]} in this solve [mm^2]": area - before.get(k, 0.0) for k, area in list(out.items())}
        counts = np.bincount(report.cells.fate, minlength=len(Fate))
        out |= {f"elements lost by {name} [-]": int(counts[fate]) for fate, name in LOST.items()}
        out["elements worn away [-]"] = int(counts[Fate.WORN])
        return out

    def _snapshot(self, report: Any) -> Snapshot:
        profiles = {
            name: {
                "reference [mm]": p.reference,
                "place [mm]": p.place,
                "pressure [MPa]": p.pressure,
                "nominal pressure [MPa]": p.load / p.weight,  # pressure in the wear law
                "gap [mm]": p.gap,
            }
            for name, p in report.contacts.items()
        }
        for name, counter in report.counters.items():
            profiles[name]["counter-surface coordinate [mm]"] = counter.along
            profiles[name]["counter-surface depth [mm]"] = counter.depth
        kind = self.scene.program.cycle[report.phase].name
        last, elements = report.last_stroke, {}
        if report.cells is not None and last in self.scene.kept:
            cells = report.cells
            elements = {"points [mm]": cells.points, "corners": cells.corners, "fate": cells.fate} | report.loaded
        stroke, time = self.scene.program.counted(last), self.scene.program.elapsed(last)
        return Snapshot(stroke, kind, report.contour.points, profiles, report.section, elements, time)

    def add_sections(self, reports: Sequence[Any]) -> None:
        """Add loaded sections to the last snapshot of their kind of stroke, if it has none."""
        for report in reports:
            kind = self.scene.program.cycle[report.phase].name
            last = max((k for k, s in enumerate(self.snapshots) if s.kind == kind), default=None)
            if last is not None and not self.snapshots[last].section:
                self.snapshots[last] = replace(self.snapshots[last], section=report.section)

    @property
    def sections(self) -> KeptSections:
        """The saved loaded sections."""
        surfaces = {contact.name: contact.surface for contact in self.scene.contacts}
        return KeptSections(self.scene.name, [s for s in self.snapshots if s.section], surfaces)

    def summary(self, state: Any, status: str, message: str) -> dict[str, Any]:
        """Contents of ``summary.json``: status, main results, cost and error estimates."""
        scene = self.scene
        cycle = [s.name for s in scene.program.cycle]
        unworn = self.unworn or measured_at(scene)
        depth = depths(unworn, state.contour)
        ledger = state.ledger
        out: dict[str, Any] = {
            "status": status,
            "message": message,
            "scene": scene.name,
            "strokes": scene.program.counted(state.strokes),
            "worn area [mm^2]": ledger.removed,
            "worn area by the law [mm^2]": ledger.worn,
            "maximum depth [mm]": float(depth.max()),
        }
        if scene.axisymmetric:
            out["worn volume [mm^3]"] = 2 * np.pi * ledger.moment
        for name in dict.fromkeys(scene.worn_edges):
            out[f"{name} depth [mm]"] = float(depth[unworn.on((name,))].max())
        if state.cells is not None:
            out |= {f"area lost by {name} [mm^2]": ledger.lost[fate] for fate, name in LOST_AREAS.items()}
            out["area lost in all [mm^2]"] = self.unworn_area - state.cells.area
        peaks = [c for c in (self.rows[-1] if self.rows else {}) if c.endswith("peak pressure [MPa]")]
        leaks = [LEAK] if self.rows and LEAK in self.rows[-1] else []
        for kind in cycle:
            rows = [r for r in self.rows if r["kind [-]"] == kind]
            for column in peaks + leaks:
                out[f"first {kind} {column}"] = rows[0][column]
                out[f"last {kind} {column}"] = rows[-1][column]
        if peaks:
            out["peak pressure [MPa]"] = max(r[c] for r in self.rows[-len(cycle) :] for c in peaks)
        if leaks:
            under = max(scene.program.cycle, key=lambda stroke: stroke.highest_pressure).name
            last = [row for row in self.rows if row["kind [-]"] == under][-1]
            out |= {LEAK: last[LEAK], "leaks first at": last["leaks first at [-]"]}
        out |= rests(scene, self.rows)
        if scene.fluid is not None:
            out["blow-by"] = self.blow_by
        worst = max(ledger.worn, 1e-300)
        out["warnings"] = self._warnings()
        out |= {
            "solves": state.work.solves,
            "Newton iterations": state.work.iterations,
            "retries": state.work.retries,
            "remeshes": ledger.remeshes,
            "error estimates": {
                "worn area [-]": ledger.area_error / worst,
                "maximum depth [-]": abs(ledger.depth_error) / max(float(depth.max()), 1e-300),
                "area against the law [-]": abs(ledger.removed - ledger.worn) / worst,
                "area in a remesh [-]": ledger.remesh_jump,
            },
            "elements": state.stage.body.mesh.ne,
            "element edge in the contact [mm]": round(state.stage.scene.accuracy.patch, 6),
            "unknowns": state.stage.problem.space.ndof,
            "wall time [s]": round(self.wall, 3),
            "CPU time [s]": round(self.cpu, 3),
            "peak memory [MB]": round(peak_memory(), 1),
            "units": UNITS,
            "ngwear": VERSION,
        }
        if scene.deactivation is not None and scene.deactivation.damage is not None:
            torn = sum(out[f"area lost by {cause} [mm^2]"] for cause in ("tearing", "coming loose"))
            out["error estimates"]["tearing too late [cycles]"] = ledger.late
            out["error estimates"][TORN] = torn / max(out["area lost in all [mm^2]"], 1e-300)
        return out

    def _warnings(self) -> list[str]:
        """Warnings for the reader of the results: what solves show, a part that comes elsewhere, unstable sliding."""
        found = [f"{sentence} (stroke {stroke})" for _, stroke, sentence in self.findings.values()]
        found += elsewhere(self.scene, self.rows)
        for spec in self.scene.contacts:
            column = f"{spec.name} margin of steady sliding [-]"
            least = min((row[column] for row in self.rows if row.get(column, 0.0) < 0.0), default=0.0)
            if least < 0.0:
                found.append(
                    f"contact '{spec.name}': friction and pressure are so high that steady sliding is unstable "
                    f"({column} {least:.2g}): waves would run along the surface; the results are for steady sliding"
                )
        return found


class Folder(OutFolder):
    """The folder of a run of a wear scene."""

    def __init__(self, path: Path, scene: Scene, *, resume: bool) -> None:
        self.scene_hash = fingerprint(scene)
        super().__init__(path, CHECKPOINT, resume=resume)

    def finish(self, recorder: Recorder, summary: dict[str, Any]) -> None:
        """Write the summary, the series and the fields."""
        self.clear()
        if recorder.rows:
            self.write_series(recorder.rows)
        self.write_json(SUMMARY, summary)
        self.replace(FIELDS, lambda file: write(file, lambda h5: _fill(h5, recorder, summary)))


def _fill(h5: Any, recorder: Recorder, summary: dict[str, Any]) -> None:
    import h5py

    scene = recorder.scene
    mark(h5, scene.name)
    h5.attrs["units"] = json.dumps(UNITS)
    h5.attrs["summary"] = json.dumps(without_subnormals(summary))
    outline = h5.create_group("outline")
    put(outline, "points [mm]", scene.part.outline.points)
    outline["edges"] = np.array(scene.part.outline.names, dtype=h5py.string_dtype())
    outline.attrs["provenance"] = scene.part.outline.provenance
    h5.attrs["memory"] = scene.arms is not None
    h5.attrs["laws over distance"] = any(
        c.wear_rate.varies or (c.friction_law is not None and bool(c.friction_law.breaks)) for c in scene.contacts
    )
    damage = None if scene.deactivation is None else scene.deactivation.damage
    if damage is not None:
        h5.attrs["damage criterion"], h5.attrs["critical damage"] = damage.name, damage.critical
    contacts = h5.create_group("contacts")
    for number, spec in enumerate(scene.contacts):
        group = subgroup(contacts, spec.name)
        rate, end = spec.wear_rate, scene.program.slid(scene.program.strokes)
        mean = rate.curve.mean(0.0, end) if rate.varies and end > 0 else rate.at(0.0)
        group.attrs["edges"], group.attrs[WEAR_RATE] = spec.edges, without_subnormals(mean)
        group.attrs["surface"], group.attrs["number"] = surface_text(spec.surface), number
        if spec.wear_law is not None:
            group.attrs["wear law"] = spec.wear_law.words
    put_series(h5, recorder.rows)
    strokes = h5.create_group("strokes")
    for number, snapshot in enumerate(recorder.snapshots):
        _stroke(strokes.create_group(f"{number:05d}"), snapshot)


def _stroke(group: Any, snapshot: Snapshot) -> None:
    group.attrs["stroke"], group.attrs["kind"] = snapshot.stroke, snapshot.kind
    group.attrs["time [s]"] = snapshot.time
    put(group, "outline [mm]", snapshot.outline)
    for name, profile in snapshot.profiles.items():
        _put_all(subgroup(group, name), CONTACT, profile)
    for name, content in (("section", snapshot.section), ("elements", snapshot.elements)):
        if content:
            _put_all(subgroup(group, name), PART, content, compressed=name == "section")


def _put_all(group: Any, kind: str, content: Mapping[str, NDArray[Any]], *, compressed: bool = False) -> None:
    group.attrs["holds"] = kind
    for name, values in content.items():
        put(group, name, values, compressed=compressed)
