"""The edge of a contact patch between the mesh's nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact_patch import PatchContact

Array = NDArray[np.float64]
RAYS = 72
NEAR, FAR = 0.004, 0.03  # gaps over the ball's radius between which the edge is extrapolated


@dataclass(frozen=True)
class Patch:
    """A ball's contact.

    Attributes
    ----------
    edge : array, shape (72, 2)
        From above, as deformed [mm].
    area : float
        As it lies on the ball [mm²].
    reference_area : float
        Of the undeformed surface that touches [mm²].
    """

    edge: Array
    area: float
    reference_area: float


def contact_patch(contact: PatchContact) -> Patch:
    """Edge and area of a ball's contact.

    Outside a contact the gap grows with the power 3/2 of the distance: along rays from the contact's middle
    gap^(2/3) is a straight line, and its zero is the edge. An area counted by elements or integration points is
    quantised.
    """
    faces = contact.faces()
    loaded = faces.pressure > 1e-3 * faces.pressure.max()
    middle = faces.reference[loaded, :2].mean(axis=0)
    height = faces.reference[0, 2]
    reach = np.linalg.norm(faces.reference[loaded, :2] - middle, axis=1).max()
    lengths = np.linspace(0.4 * reach, 1.8 * reach, 141)
    angles = 2 * np.pi * np.arange(RAYS) / RAYS
    direction = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    places = (middle + lengths[None, :, None] * direction[:, None]).reshape(-1, 2)
    gap, moved = contact.at(np.column_stack([places, np.full(len(places), height)]))
    gap, moved = gap.reshape(RAYS, -1), moved[:, :2].reshape(RAYS, -1, 2)
    radius, edge, reference = contact.surface.radius, np.empty((RAYS, 2)), np.empty(RAYS)
    for k in range(RAYS):
        last = np.flatnonzero(gap[k] < NEAR * radius)[-1]
        use = (np.arange(len(lengths)) > last) & (gap[k] < FAR * radius)
        slope, start = np.polyfit(lengths[use], gap[k, use] ** (2 / 3), 1)
        reference[k] = -start / slope
        edge[k] = [np.interp(reference[k], lengths, moved[k, :, i]) for i in range(2)]
    from_axis = edge - np.array(contact.surface.centre[:2])
    turn = np.unwrap(np.arctan2(*from_axis.T[::-1]))
    cap = radius**2 * (1 - np.sqrt(1 - (from_axis**2).sum(axis=1) / radius**2))
    step = np.diff(np.append(turn, turn[0] + 2 * np.pi))
    sector = 0.5 * np.sin(2 * np.pi / RAYS)
    return Patch(
        edge=edge,
        area=float((0.5 * (cap + np.roll(cap, -1)) * step).sum()),
        reference_area=float(sector * (reference * np.roll(reference, -1)).sum()),
    )
