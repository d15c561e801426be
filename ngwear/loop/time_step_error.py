"""Error by the time step of rubber with memory: the next cycle is solved again with half the time step.

In one solve, of a stroke or a part of it, the strain is constant (``ngwear.loop.memory_over_cycles``). The change of
the mean values with half the time step, on the same mesh and outline, gives the error.

First order is assumed: the error is twice that change. ``ngwear verify stroke_memory`` compares with much finer steps.
"""

from __future__ import annotations

from copy import copy
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ngwear.effects.contact_profile import ContactProfile
from ngwear.loop.state import State
from ngwear.loop.stepper import Stepper
from ngwear.results.quantities_of_interest import AREA, BY_TIME_STEP, DEPTH, FRICTION, PEAK
from ngwear.results.richardson import relative_errors
from ngwear.scene.program import whole_name

REMAINS = 2.0  # of first order: the error over what halves change, 1 / (1 - 1/2)
Read = dict[str, dict[str, ArrayLike]]


def time_step_errors(state: State) -> dict[str, float]:
    """Relative errors of depth, area, pressure and friction by the time step, by their names in the summary.

    The error of the depth is that of the wear per cycle of the contact zone with the deepest place: within a zone, wear
    evens out the pressures. The error of the peak pressure is that of the mean pressure, weighted by load, because
    nodal peaks scatter by more. Contact widths scatter too and are not compared.

    Parameters
    ----------
    state : State
        State of a run with memory after its last stroke.

    Raises
    ------
    ConvergenceError
        If a stroke of that cycle has no equilibrium.
    """
    try:
        whole, halves = next_cycle(state), next_cycle(in_halves(state))  # both from the same state
    finally:
        Stepper(state.stage.scene).restore_last_stroke(state)
    deepest = _deepest(whole)
    mine, other = (_read(seen, deepest) for seen in (whole, halves))
    return {f"{name[:-4]} {BY_TIME_STEP}": REMAINS * error for name, error in relative_errors(mine, other).items()}


def next_cycle(state: State) -> State:
    """Solve the next cycle on a copy of the state, without wear; its ``reports`` are the strokes."""
    there = copy(state)
    there.work, there.phases, there.memory = copy(state.work), list(state.phases), copy(state.memory)
    there.reports = Stepper(state.stage.scene).solve_next_cycle(there)
    return there


def in_halves(state: State) -> State:
    """The same state with each stroke, or part of a stroke, divided into two halves."""
    there, stage = copy(state), copy(state.stage)
    accuracy = stage.scene.accuracy
    stage.scene = replace(stage.scene, accuracy=replace(accuracy, parts=2 * accuracy.parts))
    there.stage, there.strokes = stage, 2 * state.strokes
    there.phases = [phase for phase in state.phases for _ in range(2)]
    there.memory = None if state.memory is None else state.memory.in_halves()
    return there


def _deepest(state: State) -> tuple[str, NDArray[np.intp]] | None:
    """Contact and nodes of the zone at the deepest place; None if nothing wears there."""
    wearing = [spec.name for spec in state.stage.scene.contacts if spec.wears]
    if state.depths is None or not wearing:
        return None
    place, seen = int(state.depths[0].argmax()), [report.contacts for report in state.reports]
    away = {name: np.abs(seen[0][name].t - place) for name in wearing}
    name = min(wearing, key=lambda name: away[name].min())
    node = int(away[name].argmin())
    profiles = [contacts[name] for contacts in seen]
    zones = [(profile.load[zone.nodes].sum(), zone.nodes) for profile in profiles for zone in profile.zones()]
    around = [found for found in zones if node in found[1]]
    return (name, max(around, key=lambda found: found[0])[1]) if around else None


def _read(state: State, deepest: tuple[str, NDArray[np.intp]] | None) -> Read:
    """Mean values over each given stroke, and load times travel over the cycle, to which wear is proportional."""
    scene = state.stage.scene
    out: Read = {}
    cycle = scene.program.cycle
    for kind in dict.fromkeys(whole_name(stroke.name) for stroke in cycle):
        mine = [report for report in state.reports if whole_name(cycle[report.phase].name) == kind]
        for name in mine[0].contacts:
            out.setdefault(PEAK, {})[f"{kind}: {name}"] = np.mean([_mean_pressure(r.contacts[name]) for r in mine])
        for name in (name for name in mine[0].forces if name.endswith("friction")):
            out.setdefault(FRICTION, {})[f"{kind}: {name}"] = np.mean([report.forces[name] for report in mine], axis=0)
    for name in (spec.name for spec in scene.contacts if spec.wears):
        parts = (cycle[report.phase].travel * report.contacts[name].load for report in state.reports)
        loads = sum(parts, np.zeros(()))
        out.setdefault(AREA, {})[name] = loads.sum()
        if deepest is not None and name == deepest[0]:
            out[DEPTH] = {name: loads[deepest[1]].sum()}
    return out


def _mean_pressure(profile: ContactProfile) -> float:
    """Mean pressure weighted by load [MPa]; 0 without contact."""
    return float(profile.pressure @ profile.load / profile.load.sum()) if profile.load.any() else 0.0
