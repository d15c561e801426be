"""The outline of a section before and after its deformation: how far it is compressed, and where it crosses itself."""

from __future__ import annotations

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.fields.element_nodes import ElementNodes
from ngwear.geometry.meshed_section import MeshedSection

Array = NDArray[np.float64]


def outline_places(section: MeshedSection, displacement: ng.GridFunction) -> tuple[Array, Array]:
    """Places of the start and the middle of each mesh edge before and after the deformation, each (2, m, 2) [mm]."""
    ends, nodes, u = section.outline.vertices, ElementNodes(section.mesh), displacement
    values = nodes.values(ng.CF((ng.x, ng.y, u[0], u[1])))
    values = np.stack([values[ends[:, 0]], values[nodes.middle(ends)]])
    return values[..., :2], values[..., :2] + values[..., 2:]


def stretches(before: Array, after: Array) -> Array:
    """Length of each half of each mesh edge after over before, from ``outline_places``, shape (2, m) [-]."""
    lengths = []
    for starts, middles in (before, after):
        ends = np.roll(starts, -1, axis=0)
        lengths.append(np.linalg.norm([middles - starts, ends - middles], axis=-1))
    found: Array = lengths[1] / lengths[0]
    return found


def crossing(places: Array) -> tuple[float, float] | None:
    """Where an outline through ``places``, shape (2, m, 2), crosses itself [mm]; None if it does not."""
    from shapely import Polygon, is_valid, is_valid_reason

    outline = Polygon(places.transpose(1, 0, 2).reshape(-1, 2))
    if is_valid(outline):
        return None
    x, y = is_valid_reason(outline).partition("[")[2].rstrip("]").split()
    return float(x), float(y)
