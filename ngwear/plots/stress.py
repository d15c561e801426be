"""Figure of the stresses in a section of elements, loaded, at the first and the last kept stroke."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.laws.damage import Fatigue, MaximumPrincipalStress, Stresses, TensileNormalStress
from ngwear.plots.sections import draw_planes, living, sections, show, when, worn_face
from ngwear.plots.style import new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ngwear.results.result_file import ResultFile, Snapshot

Array = NDArray[np.float64]

STRESS = "stress xx, yy, xy [MPa]"
PRINCIPAL = (MaximumPrincipalStress.name, Fatigue.name)
NEAR = 2.0  # times the highest pull: a critical stress beyond that would leave the section pale
LEAST = 1e-3  # MPa: top of the colours of a section that nothing pulls
BEHIND = 0.06  # of the window's width: how much of the rubber behind the face is shown besides
ROD = 0.4  # of that: how much of what lies before the face


def stress_figure(result: ResultFile) -> Figure:
    """The stress that tears, by element on the deformed section, for each direction of sliding."""
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import Normalize

    kept, (low, high) = sections(result), worn_face(result)
    room = BEHIND * (high - low)[0]
    low, high = low - room, high + room
    stroke = {kept[0].stroke: kept[0], kept[-1].stroke: kept[-1]}
    shown = [_at(result, s, kind) for kind in directions(result) for s in stroke]
    fields = []
    for snapshot in shown:
        shapes, numbers = living(snapshot, deformed=True)
        inside = np.array([bool((s.mean(axis=0) > low).all() and (s.mean(axis=0) < high).all()) for s in shapes])
        fields.append((shapes, tensile(result, snapshot)[numbers], inside))
    seen = np.vstack([shape for shapes, _, inside in fields for shape, i in zip(shapes, inside, strict=True) if i])
    low, high = np.maximum(low, seen.min(axis=0) - ROD * room), np.minimum(high, seen.max(axis=0) + ROD * room)
    critical = critical_stress(result)
    # Rubber tears under tension: the colour scale resolves tension, however large compression is elsewhere.
    largest = max(float(np.nanmax(stress[inside], initial=LEAST)) for _, stress, inside in fields)
    marked = critical if critical is not None and critical < NEAR * largest else None
    largest = largest if marked is None else max(largest, 1.05 * marked)
    scale = Normalize(-largest, largest)
    height = min(max(8.2 * (high - low)[1] / (high - low)[0], 0.6), 4.0)
    heights = (height,) * len(shown)
    figure, axes = new_figure(len(shown), heights, size=(10.5, sum(heights) + 0.3 * len(shown) + 1.0))
    for panel, snapshot, (shapes, stress, _) in zip(axes, shown, fields, strict=True):
        draw_planes(panel, snapshot, (high - low)[1])
        drawn = PolyCollection(shapes, array=stress, cmap="RdBu_r", norm=scale, edgecolor="face", lw=0.2)
        panel.add_collection(drawn)
        show(panel, (low, high))
        panel.set_title(f"{when(result, snapshot)}: {snapshot.kind}", loc="left", fontsize=10)
        panel.set_ylabel("y [mm]")
    axes[-1].set_xlabel("x [mm]")
    bar = figure.colorbar(drawn, ax=axes, extend="min", shrink=0.8, pad=0.02, aspect=30)
    name = "larger principal stress" if uses_principal(result) else "larger normal stress along x or y"
    tears = "tears in one cycle at" if result.damage is not None and result.damage[0] == Fatigue.name else "tears at"
    beyond = "" if critical is None or marked is not None else f"; {tears} {critical:.3g}"
    bar.set_label(f"{name} [MPa]: pull is positive{beyond}")
    if marked is not None:
        bar.ax.axhline(marked, color="k", lw=2)
        bar.ax.text(-0.4, marked, f"{tears} {marked:.3g}", ha="right", va="center", fontsize=9, rotation=90)
    figure.suptitle(f"{result.scene}: stress that tears, on the loaded section", fontsize=12)
    return figure


def directions(result: ResultFile) -> list[str]:
    """One kind of stroke for each direction in which friction pulls: strokes of the same direction look alike."""
    first: dict[Any, str] = {}
    forces = tuple(f"{name} friction force x [N" for name in result.snapshots[0].profiles)  # N, or N/mm
    pulls = [c for c in result.series if c.startswith(forces)]
    for kind in result.kinds:
        row = next(i for i, s in enumerate(result.snapshots) if s.kind == kind)
        way = np.sign(sum(float(result.series[c][row]) for c in pulls)) if pulls else kind
        first.setdefault(way, kind)
    return list(first.values())


def _at(result: ResultFile, stroke: float, kind: str) -> Snapshot:
    """The latest snapshot with elements of a kind, at a stroke if it has been kept there."""
    mine = [s for s in result.snapshots if s.elements and s.kind == kind]
    return min(reversed(mine), key=lambda s: abs(s.stroke - stroke))


def uses_principal(result: ResultFile) -> bool:
    """Whether the run's criterion looks at the principal stress."""
    return result.damage is not None and result.damage[0] in PRINCIPAL


def critical_stress(result: ResultFile) -> float | None:
    """The stress that tears an element at once [MPa]; None where none does."""
    name, critical = result.damage or ("", None)
    return critical if name in (TensileNormalStress.name, *PRINCIPAL) else None


def tensile(result: ResultFile, snapshot: Snapshot) -> Array:
    """The stress of each element that the run's criterion looks at, else the larger normal stress [MPa]."""
    stresses = Stresses(snapshot.elements[STRESS], np.zeros(len(snapshot.elements[STRESS])))
    return stresses.principal if uses_principal(result) else stresses.tensile
