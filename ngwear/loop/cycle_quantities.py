"""Quantities of the strokes of a cycle, to compare the same cycle on another mesh, or with other friction."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from ngwear.loop.state import State, StrokeReport
from ngwear.results.quantities_of_interest import AREA, DEPTH, FRICTION, PEAK, WIDTH

Array = NDArray[np.float64]
Quantities = dict[str, dict[str, ArrayLike]]  # by the name of their error in the summary, and the quantity's own


def read_cycle(state: State) -> Quantities:
    """Values of each stroke, and load per length times travel over the cycle, to which wear is proportional.

    Of each stroke its last report counts; where a new mesh lies between two, loads are those of the nearest nodes.
    """
    scene, reports = state.stage.scene, _last_reports(state)
    out: Quantities = {}
    for report in reports:
        stroke = scene.program.cycle[report.phase].name
        for name, profile in report.contacts.items():
            zones = profile.zones()
            out.setdefault(PEAK, {})[f"{stroke}: {name}"] = max((zone.peak for zone in zones), default=0.0)
            out.setdefault(WIDTH, {})[f"{stroke}: {name}"] = sum(zone.width for zone in zones)
        for name in (name for name in report.forces if name.endswith("friction")):
            out.setdefault(FRICTION, {})[f"{stroke}: {name}"] = report.forces[name]
    for name in (spec.name for spec in scene.contacts if spec.wears):
        ways, profiles = ([scene.program.cycle[r.phase].travel for r in reports], [r.contacts[name] for r in reports])
        out.setdefault(AREA, {})[name] = sum(way * p.load.sum() for way, p in zip(ways, profiles, strict=True))
        out.setdefault(DEPTH, {})[name] = wear_per_stroke(state, name).sum(axis=0).max()
    return out


def wear_per_stroke(state: State, contact: str) -> Array:
    """Load per length times travel of each stroke at the nodes of the last report's profile, shape (strokes, k) [N]."""
    cycle, reports = state.stage.scene.program.cycle, _last_reports(state)
    there = reports[-1].contacts[contact]
    worn = []
    for report in reports:
        profile = report.contacts[contact]
        _, nearest = cKDTree(profile.reference).query(there.reference)
        worn.append(cycle[report.phase].travel * (profile.load / profile.weight)[nearest])
    return np.array(worn)


def _last_reports(state: State) -> list[StrokeReport]:
    """The last report of each stroke of the cycle."""
    return list({report.phase: report for report in state.reports}.values())
