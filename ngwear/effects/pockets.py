"""Pockets: pieces of an outline without contact that a surface closes, such as the valley between an X-ring's lobes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import Array
from ngwear.effects.contact import OutlineContact
from ngwear.fields.displacements import at_vertices
from ngwear.geometry.meshed_section import MeshedSection
from ngwear.geometry.outline import polygon_area


@dataclass(frozen=True)
class Pocket:
    """A pocket between the outline and one surface.

    Attributes
    ----------
    edges : array of int
        Its mesh edges, in the order of the outline.
    contact : str
        Name of the contact with the surface, on both sides of the pocket.
    holds : float
        Highest contact pressure on the side where that is lower [MPa].
    """

    edges: NDArray[np.intp]
    contact: str
    holds: float


def contact_pressures(section: MeshedSection, contacts: Sequence[OutlineContact]) -> Array:
    """Highest Cauchy pressure of each contact on each mesh edge of the outline, shape (contacts, m) [MPa]."""
    found = np.zeros((len(contacts), len(section.outline.names)))
    for row, contact in zip(found, contacts, strict=True):
        row[contact.positions] = np.where(contact.touching(), contact.edge_peaks(), 0.0)
    return found


def pockets(section: MeshedSection, displacement: ng.GridFunction, contacts: Sequence[OutlineContact]) -> list[Pocket]:
    """The pockets in the present state.

    A piece between contacts with two surfaces, such as the air side of a ring, is none: it is open through the gap
    between the surfaces. A piece that closes around the part, between the two ends of its contacts, is none either.
    """
    pressures, m = contact_pressures(section, contacts), len(section.outline.names)
    closed = pressures.max(axis=0, initial=0.0) > 0
    if not closed.any():
        return []
    places, found = _places(section, displacement), []
    order = (np.arange(m) + int(np.flatnonzero(closed)[0])) % m
    for piece in np.split(order, np.flatnonzero(np.diff(closed[order])) + 1):
        before, after = (piece[0] - 1) % m, (piece[-1] + 1) % m
        # The part lies to the left of its outline: a pocket, closed by the surface, is passed clockwise.
        if closed[piece[0]] or polygon_area(places[np.append(piece, after)]) > 0:
            continue
        for row, contact in zip(pressures, contacts, strict=True):
            if row[before] > 0 and row[after] > 0:
                holds = min(_highest(row, before, -1), _highest(row, after, 1))
                found.append(Pocket(piece, contact.name, holds))
                break
    return found


def _places(section: MeshedSection, displacement: ng.GridFunction) -> Array:
    """Deformed place of the first node of each mesh edge, shape (m, 2) [mm]."""
    unknowns = at_vertices(displacement.space, section.outline.vertices[:, 0]).T
    places: Array = section.contour.at(section.outline.t[:, 0]) + displacement.vec.FV().NumPy()[unknowns]
    return places


def _highest(pressures: Array, begin: int, step: int) -> float:
    """Highest pressure of the contact that begins at a mesh edge and goes on in one direction [MPa]."""
    onward = np.roll(pressures[::step], -(begin if step == 1 else len(pressures) - 1 - begin))
    return float(onward[: int(np.argmin(onward > 0)) or len(onward)].max())
