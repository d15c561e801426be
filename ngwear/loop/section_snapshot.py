"""Data of a loaded section for figures: deformed elements, stresses, surfaces and contact pressures."""

from __future__ import annotations

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.cauchy import cauchy_stress, largest_stretch
from ngwear.effects.contact import OutlineContact
from ngwear.fields.element_nodes import ElementNodes
from ngwear.loop.stage import Stage

Arrays = dict[str, NDArray[np.generic]]


def section_snapshot(stage: Stage) -> Arrays:
    """The section in the present state; names and shapes as in ``ngwear.results.section.Section``.

    Single precision, stresses at vertices only: about 75 bytes for each element, 45 in the compressed file.
    """
    problem, body = stage.problem, stage.body
    u, nodes = problem.fields[DISPLACEMENT], ElementNodes(body.mesh)
    found = nodes.values(ng.CF((ng.x, ng.y, u[0], u[1])))
    strain, piola = problem.stress()
    values = np.concatenate([cauchy_stress(strain, piola), largest_stretch(strain)[..., None]], axis=-1)
    recovered = problem.points.recovered_at_vertices(values)
    out: Arrays = {
        "points [mm]": found[:, :2] + found[:, 2:],
        "displacement [mm]": found[:, 2:],
        "triangles": nodes.triangles,
        "quadrilaterals": nodes.quadrilaterals,
        "stress xx, yy, xy, zz [MPa]": recovered[:, :4],
        "maximum principal stretch [-]": recovered[:, 4],
    }
    if stage.fluids:
        ends, shares = body.outline.vertices, [fluid.shares for fluid in stage.fluids.values()]
        pressures = [fluid.pressure.Get() for fluid in stage.fluids.values()]
        if stage.trapped is not None:
            in_pockets = [q for q in np.unique(stage.trapped.pressures) if q > 0]
            shares += [np.where(stage.trapped.pressures == q, 1.0, 0.0) for q in in_pockets]
            pressures += in_pockets
        inlet, edge = np.nonzero(np.array(shares) > 0)
        out["fluid pressure [MPa]"] = np.array(pressures)
        out["wetted edges"] = np.column_stack([ends[edge, 0], nodes.middle(ends[edge]), ends[edge, 1]])
        out["wetted share [-]"] = np.array(shares)[inlet, edge]
        out["wetted from inlet"] = inlet
    held = body.outline.vertices[body.outline.on(tuple(e for s in stage.scene.supports for e in s.edges))]
    if len(held):
        out["held edges"] = np.column_stack([held[:, 0], nodes.middle(held), held[:, 1]])
    for name, contact in stage.contacts.items():
        out |= {f"{name}: {quantity}": values for quantity, values in _contact(contact).items()}
    return {name: _short(values) for name, values in out.items()}


def _contact(contact: OutlineContact) -> Arrays:
    """Position of a surface, and the pressure along the edges that may touch it."""
    profile = contact.profile()
    return {
        "place [mm]": profile.place,
        "pressure [MPa]": profile.pressure,
        "edges": profile.edges,
        "moved by [mm]": np.array(contact.stands()),
        "turned by [mm]": np.array(contact.turned),
    }


def _short(values: NDArray[np.generic]) -> NDArray[np.generic]:
    return values.astype(np.float32 if values.dtype.kind == "f" else np.int32)
