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
    near = np.rint(profile.t)
    on_point = np.abs(profile.t - near) < 1e-9
    np.add.at(share, near[on_point].astype(int) % n, amount[on_point])
    between = np.flatnonzero(~on_point & (amount > 0))
    low = np.floor(profile.t[between]).astype(int)
    fraction = profile.t[between] - low
    np.add.at(share, low % n, (1 - fraction) * amount[between])
    np.add.at(share, (low + 1) % n, fraction * amount[between])
    return _spread(share, contour, profile, amount / profile.weight)


def _spread(share: Array, contour: Contour, profile: ContactProfile, depth: Array) -> Array:
    """Divide a node's share among the contour points that a coarse mesh edge skips, as W is linear there."""
    n = len(contour)
    out = share.copy()
    for i, j in profile.edges:
        a, b = int(np.rint(profile.t[i])), int(np.rint(profile.t[j]))
        b = b if b > a else b + n
        wa, wb = depth[i], depth[j]
        if b - a < 2 or (wa == 0 and wb == 0):
            continue
        length = contour.lengths[np.arange(a, b) % n]
        total = length.sum()
        s = np.concatenate([[0.0], np.cumsum(length)]) / total
        w = (1 - s) * wa + s * wb
        points = np.arange(a, b + 1) % n
        out[points[0]] -= wa * total / 2
        out[points[-1]] -= wb * total / 2
        np.add.at(out, points[:-1], (2 * w[:-1] + w[1:]) * length / 6)
        np.add.at(out, points[1:], (w[:-1] + 2 * w[1:]) * length / 6)
    return out


def critical_distance(element: float, specific_wear_rate: float, plane_strain_modulus: float) -> float:
    """Sliding distance beyond which the explicit step is unstable [mm]: ``4 h / (pi k E*)``.

    A pressure ripple of the mesh's shortest wave, q = pi / h, meets the stiffness E* q / 2 of a half-plane,
    and an explicit step multiplies it by 1 - k ds E* q / 2 (Johansson, Int. J. Numer. Methods Eng. 37
    (1994) 1595 analyses the instability for a half-plane).
    """
    if specific_wear_rate == 0:
        return math.inf
    return 4 * element / (math.pi * specific_wear_rate * plane_strain_modulus)
