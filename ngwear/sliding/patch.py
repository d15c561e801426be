"""The edge of a contact patch between the mesh's nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from ngwear.effects.contact_patch import Faces, PatchContact
from ngwear.errors import SceneError
from ngwear.surfaces import Sphere

Array = NDArray[np.float64]
RAYS = 72  # to the edge, 5 degrees apart: a circle's area by them is within 0.13 %
# These three were settled on the pin: the error of its area is stated at 1.8 times the true one (error_estimates).
DEGREE = 4  # of the polynomial
SPLIT = 6  # parts of a face's sides: 36 points a face
WELL = 0.15  # of the highest pressure: faces from which the fit starts


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

    Inside a contact the pressure vanishes with the root of the distance from its edge, so that its square is smooth up
    to there (Hertz's is a paraboloid). The edge is the zero line of the polynomial P(x, y) of degree 4 whose root,
    averaged over each loaded face and each of their neighbours, comes nearest to the faces' pressures in the mean
    square. The area of the loaded elements would be quantised, and an area extrapolated from the gaps outside would
    scatter with a coarse mesh.
    """
    ball = contact.surface
    if not isinstance(ball, Sphere):
        raise SceneError("surface", ball, "must be a ball")
    faces = contact.faces()
    edge = _edge(faces)
    height = faces.reference[0, 2]
    moved = contact.deformed(np.column_stack([edge, np.full(RAYS, height)]))
    from_axis = moved[:, :2] - np.array(ball.centre[:2])
    turn = np.unwrap(np.arctan2(*from_axis.T[::-1]))
    radius = ball.radius
    cap = radius**2 * (1 - np.sqrt(1 - (from_axis**2).sum(axis=1) / radius**2))
    step = np.diff(np.append(turn, turn[0] + 2 * np.pi))
    (x, y), (x1, y1) = edge.T, np.roll(edge, -1, axis=0).T
    return Patch(
        edge=moved[:, :2],
        area=float((0.5 * (cap + np.roll(cap, -1)) * step).sum()),
        reference_area=float(0.5 * (x * y1 - x1 * y).sum()),
    )


def _edge(faces: Faces) -> Array:
    """Reference coordinates of the edge, along rays from the middle of the contact, shape (72, 2) [mm]."""
    share = faces.pressure / faces.pressure.max()
    corners = faces.undeformed[:, :, :2]
    loaded = faces.loaded
    near = loaded | _touching(corners, loaded)
    corners, share, loaded = corners[near], share[near], loaded[near]
    middle = corners[loaded].mean(axis=(0, 1))
    reach = np.linalg.norm(corners[loaded] - middle, axis=2).max()
    points = np.einsum("kc,ncd->nkd", _inside(SPLIT), (corners - middle) / reach)
    weight = np.sqrt(faces.reference_areas[near])
    weight /= np.linalg.norm(weight)
    terms, well = _terms(points), share > WELL
    centres = terms[well].mean(axis=1)
    start, *_ = np.linalg.lstsq(centres * weight[well, None], share[well] ** 2 * weight[well], rcond=None)

    def off(c: Array) -> Array:
        return weight * (np.sqrt(np.maximum(terms @ c, 0.0)).mean(axis=1) - share)

    found = least_squares(off, start, x_scale="jac").x
    angles = 2 * np.pi * np.arange(RAYS) / RAYS
    direction = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    lengths = np.linspace(0.0, 1.0, 1001)
    height = _terms(lengths[None, :, None] * direction[:, None]) @ found
    beyond = np.where((height <= 0).any(axis=1), (height <= 0).argmax(axis=1), len(lengths) - 1)
    inside, outside = (height[np.arange(RAYS), i] for i in (beyond - 1, beyond))
    length = lengths[beyond - 1] + lengths[1] * np.clip(inside / (inside - outside), 0.0, 1.0)
    return middle + reach * length[:, None] * direction


def _touching(corners: Array, chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Faces that have a corner in common with a chosen one."""
    _, number = np.unique(np.round(corners.reshape(-1, 2), 9), axis=0, return_inverse=True)
    number = number.reshape(-1, 3)
    return np.any(np.isin(number, number[chosen]), axis=1)


def _inside(split: int) -> Array:
    """Barycentric coordinates of the middles of split² equal parts of a triangle."""
    up = [(i + 1 / 3, j + 1 / 3) for i in range(split) for j in range(split - i)]
    down = [(i + 2 / 3, j + 2 / 3) for i in range(split) for j in range(split - i - 1)]
    first = np.array(up + down) / split
    return np.column_stack([first, 1 - first.sum(axis=1)])


def _terms(points: Array) -> Array:
    """x^i y^j with i + j up to the degree, at points of shape (..., 2)."""
    x, y = np.moveaxis(points, -1, 0)
    return np.stack([x**i * y**j for i in range(DEGREE + 1) for j in range(DEGREE + 1 - i)], axis=-1)
