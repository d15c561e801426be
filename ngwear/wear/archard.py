"""Archard's law on the reference outline."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact_profile import ContactProfile
from ngwear.geometry.contour import Contour

Array = NDArray[np.float64]


def worn_share(contour: Contour, profile: ContactProfile, amount: Array) -> Array:
    """Share out the worn area of a contact's mesh nodes among the outline's points.

    Archard's law (J. Appl. Phys. 24 (1953) 981) per reference area, ``W = k P ds / J`` with the nominal
    pressure P, so that a stretched lip loses the right volume. The sum is kept exactly.

    Parameters
    ----------
    contour : Contour
    profile : ContactProfile
    amount : array, shape (k,)
        ``int W phi_i ds`` at the profile's nodes [mm²].

    Returns
    -------
    array, shape (n,)
        ``int W phi_i ds`` for each contour point [mm²].
    """
    n = len(contour)
    share = np.zeros(n)
    point = np.rint(profile.t).astype(int)
    whole = (np.abs(profile.t - point) < 1e-9)[profile.edges].all(axis=1)
    whole &= (np.diff(point[profile.edges], axis=1) % n == 1).ravel()
    # Where mesh edges are the outline's segments, nodes are its points: sharing out again would only smooth.
    direct = np.ones(len(profile.t), dtype=bool)
    direct[profile.edges[~whole]] = False
    np.add.at(share, point[direct] % n, amount[direct])
    rest = np.where(direct, 0.0, amount)
    return share + _shared_out(contour, profile, rest) if rest.any() else share


def _shared_out(contour: Contour, profile: ContactProfile, amount: Array) -> Array:
    """Share nodal amounts as the integrals of a depth linear between the mesh nodes; the sum is kept."""
    n = len(contour)
    share = np.zeros(n)
    depth = amount / profile.weight
    for i, j in profile.edges:
        if depth[i] == 0 and depth[j] == 0:
            continue
        a, b = profile.t[i], profile.t[j]
        b = b if b > a else b + n
        # Cut the mesh edge at the outline's points; W is linear along its length.
        cuts = np.concatenate([[a], np.arange(math.floor(a) + 1, math.ceil(b)), [b]])
        segment = np.floor(0.5 * (cuts[:-1] + cuts[1:])).astype(int)
        length = np.diff(cuts) * contour.lengths[segment % n]
        s = np.concatenate([[0.0], np.cumsum(length)]) / length.sum()
        w = (1 - s) * depth[i] + s * depth[j]
        middle = 0.5 * (w[:-1] + w[1:])
        for point in (segment, segment + 1):
            ends, inner = _hat(np.stack([cuts[:-1], cuts[1:]]), point), _hat(0.5 * (cuts[:-1] + cuts[1:]), point)
            np.add.at(share, point % n, length / 6 * (w[:-1] * ends[0] + 4 * middle * inner + w[1:] * ends[1]))
    return share * (amount.sum() / share.sum())


def _hat(t: Array, point: NDArray[np.intp]) -> Array:
    """Hat functions of contour points at contour parameters."""
    return np.maximum(1 - np.abs(t - point), 0.0)


def critical_distance(element: float, specific_wear_rate: float, plane_strain_modulus: float) -> float:
    """Sliding distance beyond which the explicit step is unstable [mm]: ``4 h / (pi k E*)``.

    A pressure ripple of the mesh's shortest wave, q = pi / h, meets the stiffness E* q / 2 of a half-plane,
    and an explicit step multiplies it by 1 - k ds E* q / 2 (Johansson, Int. J. Numer. Methods Eng. 37
    (1994) 1595 analyses the instability for a half-plane).
    """
    if specific_wear_rate == 0:
        return math.inf
    return 4 * element / (math.pi * specific_wear_rate * plane_strain_modulus)
