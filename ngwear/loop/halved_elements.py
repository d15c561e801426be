"""Error by the mesh: a cycle is solved again on elements of half the edges, without wear.

Coarser runs may all miss what the elements of none of them resolve, and then agree. The change of peak pressures, loads
and widths with half the edges does not depend on them. The error is stated as 4.6 times that change: of the order 3/2,
with the factor of safety of two grids (``ngwear.results.richardson``). It is computed before the first stroke. Wear
then evens the pressures out, and with them their errors: so these count by how much of the largest wear per cycle is
left at the end. That of the peak pressure counts whole: the peak may move to the end of the contact, where wear leaves
an edge. What the nodes do not show of the peak at the end is added to it (``ContactProfile.missed_at_peak``): before, a
node may have lain on the peak by chance. A worn outline has points for its own elements only, so that finer ones show
peaks that are none; it is used if there is no equilibrium on the finer ones before, not even after mounting on them.

Only for parts with room to move, which are mounted on coarse elements.
"""

from __future__ import annotations

from copy import copy
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ngwear.errors import ConvergenceError, GeometryError, MeshError
from ngwear.loop.cycle_quantities import Quantities, read_cycle, wear_per_stroke
from ngwear.loop.finer_mesh import FINER, refine_everywhere, remeshes
from ngwear.loop.state import State
from ngwear.loop.stepper import Stepper
from ngwear.loop.time_step_error import next_cycle
from ngwear.results.quantities_of_interest import BY_HALVED, DEPTH, PEAK
from ngwear.results.richardson import HIGHEST, SAFETY, relative_errors

BY_DEPTH, BY_PEAK = (f"{name[:-4]} {BY_HALVED}" for name in (DEPTH, PEAK))
Array = NDArray[np.float64]

NEAR = 3  # a place, and those on both sides of it
REMAINS = SAFETY / (1.0 - FINER**HIGHEST)  # of the error, over what halves change


def add_mesh_errors(state: State) -> list[str]:
    """Store the relative errors by the mesh in the present state in ``State.mesh_errors``, unless they are known.

    They are those of depth, area, peak pressure, contact width and friction, by their names in the summary; that of the
    depth is that of the largest wear per cycle. ``State.wear_changes`` has the changes at all places. Not for a part
    that is held, or rubber with memory. Returns a warning if there is no equilibrium on the finer elements.
    """
    if state.mesh_errors or state.memory is not None or not remeshes(state):
        return []
    try:
        here, there = next_cycle(state) if state.strokes else state, _on_halved(state)
        mine, other = read_cycle(here), read_cycle(there)
    except (ConvergenceError, GeometryError, MeshError) as error:
        return [
            "elements of half the edges do not tell the error by the mesh, only coarser ones do: "
            f"{error}; compare with a finer accuracy"
        ]
    finally:
        Stepper(state.stage.scene).restore_last_stroke(state)
    changes = relative_errors(mine, other)
    if DEPTH in changes:  # something wears
        state.wear_changes = _wear_changes(here, there)
    state.mesh_errors = {f"{name[:-4]} {BY_HALVED}": REMAINS * change for name, change in changes.items()}
    state.first_wear = _largest_wear(mine)
    return []


def faded(state: State) -> dict[str, float]:
    """``State.mesh_errors`` times what is left of the largest wear per cycle; that of the peak pressure whole.

    To that of the peak pressure, what the present peaks may be read too low by is added. That of the depth is at least
    that of the wear at the place that is the deepest now, or wears most if nothing has worn: largest values may agree
    by chance though those of each place do not.
    """
    left = min(1.0, _largest_wear(read_cycle(state)) / state.first_wear) if state.first_wear > 0 else 1.0
    errors = dict(state.mesh_errors)
    if len(state.wear_changes):
        place = state.wear_changes[state.wear_changes[:, 2].argmax(), :2]
        if state.depths is not None:
            place = state.contour.points[state.depths[0].argmax()]
        errors[BY_DEPTH] = max(errors[BY_DEPTH], REMAINS * _change_at(state, place))
    errors = {name: error * (1.0 if name == BY_PEAK else left) for name, error in errors.items()}
    if BY_PEAK in errors:
        profiles = [profile for report in state.reports for profile in report.contacts.values()]
        largest = max(float(profile.pressure.max()) for profile in profiles)
        errors[BY_PEAK] += max(profile.missed_at_peak for profile in profiles) / largest if largest > 0 else 0.0
    return errors


def _wear_changes(here: State, there: State) -> Array:
    """Places of the wearing contacts [mm], wear per cycle, and its change on the other mesh [N], shape (k, 4)."""
    rows = []
    for name in (spec.name for spec in here.stage.scene.contacts if spec.wears):
        wear, other = (wear_per_stroke(state, name).sum(axis=0) for state in (here, there))
        before, after = (state.reports[-1].contacts[name].reference for state in (here, there))
        apart, nearest = cKDTree(after).query(before, k=2)
        between = apart[:, 0] / apart.sum(axis=1)
        there_too = (1.0 - between) * other[nearest[:, 0]] + between * other[nearest[:, 1]]
        rows.append(np.column_stack([before, wear, np.abs(wear - there_too)]))
    return np.vstack(rows)


def _change_at(state: State, place: Array) -> float:
    """Change of the wear per cycle at a place, over the largest wear [-]; the mean of the ``NEAR`` places there.

    At a single place the pressures of both meshes may cross each other.
    """
    _, near = cKDTree(state.wear_changes[:, :2]).query(place, k=min(NEAR, len(state.wear_changes)))
    largest = state.wear_changes[:, 2].max()
    return float(state.wear_changes[near, 3].mean() / largest) if largest > 0 else 0.0


def _largest_wear(read: Quantities) -> float:
    return max((float(np.max(wear)) for wear in read.get(DEPTH, {}).values()), default=0.0)


def _on_halved(state: State) -> State:
    """A copy of the state with halved elements, on which the cycle is solved without wear.

    An outline that has not worn is rounded off less, too, as for a patch with half the edges.
    """
    there, scene = copy(state), state.stage.scene
    there.stage = copy(state.stage)
    there.stage.scene = replace(scene, accuracy=replace(scene.accuracy, patch=FINER * scene.accuracy.lengths.patch))
    there.work, there.ledger = copy(state.work), state.ledger.copy()
    there.phases = [replace(phase) for phase in state.phases]
    refine_everywhere(there)
    Stepper(state.stage.scene).settle_on_new_mesh(there, anew=False)
    return there
