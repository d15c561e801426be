"""Transfer a problem's states to another mesh of the same section."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ngwear.effects.base import DISPLACEMENT, VOLUMETRIC_STRESS
from ngwear.effects.contact import OutlineContact
from ngwear.effects.contact_patch import PatchContact
from ngwear.equilibrium.problem import Problem
from ngwear.fields.displacements import from_quadratic
from ngwear.fields.transfer import PointSearch
from ngwear.geometry import nodal
from ngwear.geometry.harmonic import HarmonicFill

if TYPE_CHECKING:  # imported only if friction sticks
    from ngwear.effects.stick_slip import StickSlip

Array = NDArray[np.float64]
LARGEST_REFILL = 0.5  # of the elements: a state of which more is refilled is of no use
LOWEST_JACOBIAN = 0.25  # below, an element of the carried displacement is refilled: half of what rubber shall bear


def transfer(old: Problem, states: Sequence[Array], new: Problem) -> list[Array]:
    """Interpolate state vectors of ``old`` to the mesh of ``new``; a start state, not an equilibrium.

    Displacement and volumetric stress are taken at the new nodes (the nearest old point for a node just outside),
    contact pressures from the two nearest old nodes of the outline, tractions from the nearest edge, travels of rigid
    bodies as they are. Both problems must have the same unknowns.
    """
    search = PointSearch(old.body.mesh, _node_places(new), old.body.deformation)
    pairs = {after.name: (before, after) for before, after in contact_pairs(old, new)}
    near = {name: _neighbours(before, after) for name, (before, after) in pairs.items()}
    keep = old.state.vec.FV().NumPy().copy()
    carried = []
    for state in states:
        old.state.vec.FV().NumPy()[:] = state
        out = new.state.vec.CreateVector()
        out[:] = 0.0
        target = out.FV().NumPy()
        _take_inside(search, old, new, target)
        for before, after in pairs.values():
            index, weight, same, twin = near[after.name]
            ends = (before.profile().nominal_pressure[index] * weight).sum(axis=-1)
            ends[same] = before.end_pressures()[twin[same]]
            target[new.part(after.pressure_name)] = after.pressure_vector(ends)
            if after.force_controlled:
                target[new.part(after.travel_name)] = state[old.part(before.travel_name)]
        new.state.vec.data = out
        for friction in sticking(new):
            *_, twin = near[friction.contact.name]
            before, after = pairs[friction.contact.name]
            for name in friction.tractions:
                after.set_edge_values(new.fields[name], before.edge_values(old.fields[name])[twin])
        unfold(new)
        carried.append(new.state.vec.FV().NumPy().copy())
    old.state.vec.FV().NumPy()[:] = keep
    return carried


def transfer_solid(old: Problem, new: Problem) -> None:
    """Transfer the state of a solid and its contact to another mesh of the same solid; a start state."""
    target = new.state.vec.FV().NumPy()
    _take_inside(PointSearch(old.body.mesh, _node_places(new)), old, new, target)
    before, after = ([t for t in p.terms if isinstance(t, PatchContact)] for p in (old, new))
    for was, contact in zip(before, after, strict=True):
        contact.take_pressure(was)
        if contact.force_controlled:
            new.fields[contact.travel_name].vec.data = old.fields[was.travel_name].vec


def _take_inside(search: PointSearch, old: Problem, new: Problem, target: Array) -> None:
    """Displacement and volumetric stress at the nodes of ``new``, into a vector of its unknowns."""
    body, spaces = new.body, new.fields[DISPLACEMENT].space.components
    nodes = [nodal.join(values, body.edges) for values in search(old.fields[DISPLACEMENT]).T]
    parts = [from_quadratic(*pair, body.edges) for pair in zip(nodes, spaces, strict=True)]
    target[new.part(DISPLACEMENT)] = np.concatenate(parts)
    stress = nodal.join(search(old.fields[VOLUMETRIC_STRESS])[:, 0], body.edges)
    target[new.part(VOLUMETRIC_STRESS)] = from_quadratic(stress, new.fields[VOLUMETRIC_STRESS].space, body.edges)


def unfold(problem: Problem) -> None:
    """Replace the displacement around crushed or inverted elements of a start state by a harmonic extension.

    The start state remains if no such replacement of a small part of it squeezes its elements less.
    """
    mesh, u, points = problem.body.mesh, problem.fields[DISPLACEMENT], problem.points
    points.follow()
    least = problem.jacobians()
    if not (least < LOWEST_JACOBIAN).any():
        return
    best, kept, corners = float(least.min()), u.vec.FV().NumPy().copy(), _corners(mesh)
    for rings in (1, 2, 3, 4):
        touched = np.zeros(mesh.nv, dtype=bool)
        touched[corners[least < LOWEST_JACOBIAN]] = True
        for _ in range(rings - 1):
            touched[corners[touched[corners].any(axis=1)]] = True
        marked: NDArray[np.bool_] = np.any(touched[corners], axis=1)
        if marked.mean() > LARGEST_REFILL:
            break
        _fill_harmonically(u, marked)
        least = problem.jacobians()
        if least.min() > best:
            best, kept = float(least.min()), u.vec.FV().NumPy().copy()
        if not (least < LOWEST_JACOBIAN).any():
            break
    u.vec.FV().NumPy()[:] = kept


def _corners(mesh: ng.Mesh) -> NDArray[np.intp]:
    """Vertices of each element, the first one twice in a triangle; shape (ne, 4)."""
    return np.array([([v.nr for v in mesh[ng.ElementId(ng.VOL, i)].vertices] * 2)[:4] for i in range(mesh.ne)])


def _fill_harmonically(u: ng.GridFunction, marked: NDArray[np.bool_]) -> None:
    space = u.space
    free = ng.BitArray(space.FreeDofs())
    for element in space.mesh.Elements(ng.VOL):
        if not marked[element.nr]:
            for dof in space.GetDofNrs(ng.ElementId(ng.VOL, element.nr)):
                free[dof] = False
    v, w = space.TnT()
    matrix = ng.BilinearForm(ng.InnerProduct(ng.Grad(v), ng.Grad(w)) * ng.dx).Assemble().mat
    values = u.vec.FV().NumPy()
    values[:] = HarmonicFill(matrix, np.fromiter(free, dtype=bool))(values)


def contact_pairs(old: Problem, new: Problem) -> list[tuple[OutlineContact, OutlineContact]]:
    """Pairs of the same contact in two problems of the same scene."""
    before = {t.name: t for t in old.terms if isinstance(t, OutlineContact)}
    return [(before[t.name], t) for t in new.terms if isinstance(t, OutlineContact)]


def sticking(problem: Problem) -> list[StickSlip]:
    """Frictions that stick."""
    if not any(t.remembers for t in problem.terms):
        return []
    from ngwear.effects.stick_slip import StickSlip

    return [t for t in problem.terms if isinstance(t, StickSlip)]


def _node_places(problem: Problem) -> Array:
    """Reference coordinates of vertices, then edge midpoints of the (curved) mesh."""
    mesh = problem.body.mesh
    space = ng.H1(mesh, order=2)
    field = ng.GridFunction(space)
    columns = []
    for coordinate in (ng.x, ng.y, ng.z)[: mesh.dim]:
        field.Set(coordinate)
        columns.append(nodal.split(field.vec.FV().NumPy(), problem.body.edges))
    return np.stack(columns, axis=1)


def _neighbours(
    old: OutlineContact, new: OutlineContact
) -> tuple[NDArray[np.intp], Array, NDArray[np.bool_], NDArray[np.intp]]:
    """For both ends of each new mesh edge the two nearest old nodes and their weights; and which edges are old ones."""
    places, before = new.end_places(), old.end_places()
    distance, index = cKDTree(old.profile().reference).query(places, k=2)
    weight = distance[..., ::-1] / np.maximum(distance.sum(axis=-1, keepdims=True), 1e-300)
    _, twin = cKDTree(before.mean(axis=1)).query(places.mean(axis=1))
    off = np.linalg.norm(before[twin] - places, axis=-1).max(axis=1)
    same = off < 1e-3 * np.linalg.norm(places[:, 1] - places[:, 0], axis=-1)
    return index, weight, same, twin
