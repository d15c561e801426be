"""Archard's law on the reference outline."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact_profile import ContactProfile
from ngwear.geometry.contour import Contour

Array = NDArray[np.float64]


def worn_share(contour: Contour, profile: ContactProfile, amount: Array) -> Array:
    """Share out the worn area of a contact's mesh nodes among the outline's points: depth times length of each.

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
        Depth W at each contour point times half the length of its two segments [mm²].
    """
    share = sampled(contour, profile, amount)
    return share * (amount.sum() / share.sum()) if share.sum() > 0 else share


def sampled(contour: Contour, profile: ContactProfile, amount: Array) -> Array:
    """The same for amounts of either sign: their depth is sampled at the outline's points, the sum roughly kept."""
    n = len(contour)
    ways = np.concatenate([[0.0], np.cumsum(np.tile(contour.lengths, 2))])

    def way(t: Any) -> Any:
        return np.interp(t, np.arange(2 * n + 1), ways)

    at_node = amount / profile.weight
    depth, covered = np.zeros(n), np.zeros(n, dtype=bool)
    for i, j in profile.edges:
        a, b = profile.t[i], profile.t[j]
        b = b if b > a else b + n
        covered[np.arange(math.floor(a + 1e-9), math.ceil(b - 1e-9)) % n] = True
        points = np.arange(math.ceil(a - 1e-9), math.floor(b + 1e-9) + 1)
        if len(points) == 0 or at_node[i] == at_node[j] == 0:
            continue
        # Linear along the mesh edge. Shared by integrals instead, a dent would take its neighbours' wear and deepen.
        part = (way(points) - way(a)) / (way(b) - way(a))
        depth[points % n] = (1 - part) * at_node[i] + part * at_node[j]
    half = 0.5 * contour.lengths * covered
    share = depth * (half + np.roll(half, 1))
    if amount.any() and not share.any():  # a contact between two points of the outline
        np.add.at(share, np.rint(profile.t).astype(int) % n, amount)
    return share


def critical_distance(element: float, specific_wear_rate: float, plane_strain_modulus: float) -> float:
    """Sliding distance beyond which the explicit step is unstable [mm]: ``4 h / (pi k E*)``.

    A pressure ripple of the mesh's shortest wave, q = pi / h, meets the stiffness E* q / 2 of a half-plane,
    and an explicit step multiplies it by 1 - k ds E* q / 2 (Johansson, Int. J. Numer. Methods Eng. 37
    (1994) 1595 analyses the instability for a half-plane).
    """
    if specific_wear_rate == 0:
        return math.inf
    return 4 * element / (math.pi * specific_wear_rate * plane_strain_modulus)
