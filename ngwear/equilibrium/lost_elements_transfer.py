"""Transfer a problem's states when elements are lost: every remaining unknown has its old value."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ngwear.effects.base import DISPLACEMENT, VOLUMETRIC_STRESS, Array
from ngwear.equilibrium.problem import Problem
from ngwear.equilibrium.state_transfer import contact_pairs, sticking
from ngwear.geometry.element_body import ElementBody, Index, elements

NONE = -1


def transfer_to_remaining(old: Problem, states: Sequence[Array], new: Problem) -> list[Array]:
    """State vectors of ``old`` on the elements that ``new`` still has.

    Of two merged points the remaining one has its own values; new surfaces start without pressure.
    """
    was, now = elements(old.body), elements(new.body)
    inside = _unknowns(was, now)
    scalar = old.part(DISPLACEMENT).stop - old.part(DISPLACEMENT).start
    pairs = {after.name: (before, after) for before, after in contact_pairs(old, new)}
    twins = {name: _twins(was, before.positions, now, after.positions) for name, (before, after) in pairs.items()}
    shown = old.state.vec.FV().NumPy()
    before_all, kept = shown.copy(), []
    for state in states:
        shown[:] = state
        out = new.state.vec.CreateVector()
        out[:] = 0.0
        target = out.FV().NumPy()
        # An edge that is new, beside merged points, begins straight: its own unknown is 0, as the one put last here.
        displacement = np.pad(state[old.part(DISPLACEMENT)].reshape(2, scalar // 2), ((0, 0), (0, 1)))
        target[new.part(DISPLACEMENT)] = displacement[:, inside].ravel()
        vertices = inside[: now.mesh.nv]
        target[new.part(VOLUMETRIC_STRESS)] = state[old.part(VOLUMETRIC_STRESS)][vertices]
        for before, after in pairs.values():
            twin = twins[after.name]
            ends = np.where((twin >= 0)[:, None], before.end_pressures()[twin], 0.0)
            target[new.part(after.pressure_name)] = after.pressure_vector(ends)
            if after.force_controlled:
                target[new.part(after.travel_name)] = state[old.part(before.travel_name)]
        new.state.vec.data = out
        for friction in sticking(new):
            twin = twins[friction.contact.name]
            before, after = pairs[friction.contact.name]
            for name in friction.tractions:
                values = np.where(twin >= 0, before.edge_values(old.fields[name])[twin], 0.0)
                after.set_edge_values(new.fields[name], values)
        kept.append(new.state.vec.FV().NumPy().copy())
    shown[:] = before_all
    return kept


def _unknowns(old: ElementBody, new: ElementBody) -> Index:
    """Where each unknown of a scalar field of order 2 was: vertices, edges, then insides of quadrilaterals."""
    vertices = np.searchsorted(old.vertices, new.vertices)
    size = len(old.cells.points)

    def keys(body: ElementBody) -> Index:
        low, high = np.sort(body.vertices[body.edges], axis=1).T
        return low * size + high

    mine = keys(old)
    order = np.argsort(mine)
    nearest = np.minimum(np.searchsorted(mine[order], keys(new)), len(order) - 1)
    edges = np.where(mine[order][nearest] == keys(new), old.mesh.nv + order[nearest], NONE)

    def quads(body: ElementBody) -> Index:
        return np.flatnonzero(body.cells.living & body.cells.quads)

    insides = np.searchsorted(quads(old), quads(new))
    return np.concatenate([vertices, edges, old.mesh.nv + len(old.edges) + insides])


def _twins(old: ElementBody, old_positions: Index, new: ElementBody, positions: Index) -> Index:
    """Which surface element of a contact each new one was, by position in the contact's order; -1 for a fresh one."""

    def ends(body: ElementBody, where: Index) -> list[tuple[int, ...]]:
        return [tuple(pair) for pair in body.vertices[body.outline.vertices[where]].tolist()]

    known = {pair: k for k, pair in enumerate(ends(old, old_positions))}
    return np.array([known.get(pair, -1) for pair in ends(new, positions)], dtype=np.intp)
