"""Archard's law on the reference outline."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact_profile import ContactProfile
from ngwear.geometry.outline import Outline

Array = NDArray[np.float64]


def worn_share(contour: Outline, profile: ContactProfile, amount: Array) -> Array:
    """Distribute the worn area of a contact's mesh nodes to the outline's points: depth times length at each.

    Archard's law (J. Appl. Phys. 24 (1953) 981) per reference area, ``W = k P ds / J`` with the nominal
    pressure P, so that the volume is right on a stretched lip too. The sum is conserved exactly.

    Along a mesh edge the depth is a parabola with the nodes' values at its ends and the mean that belongs to the edge's
    mean pressure. With the nodes' values alone, waves of the outline from edge to edge would not be worn.

    Parameters
    ----------
    contour : Outline
    profile : ContactProfile
    amount : array, shape (k,)
        ``int W phi_i ds`` at the profile's nodes [mm²].

    Returns
    -------
    array, shape (n,)
        Depth W at each contour point times half the length of its two segments [mm²].
    """
    n = len(contour)
    ways = np.concatenate([[0.0], np.cumsum(np.tile(contour.lengths, 2))])

    def way(t: Array | NDArray[np.intp]) -> Array:
        return np.interp(t, np.arange(2 * n + 1), ways)

    depth, covered = np.zeros(n), np.zeros(n, dtype=bool)
    a, b = profile.t[profile.edges].T
    b = np.where(b > a, b, b + n)
    segments, _ = _spans(np.floor(a + 1e-9), np.ceil(b - 1e-9))
    covered[segments % n] = True
    points, edge = _spans(np.ceil(a - 1e-9), np.floor(b + 1e-9) + 1)
    first, last = (amount / profile.weight)[profile.edges].T
    load, worn = profile.load[profile.edges].sum(axis=1), amount[profile.edges].sum(axis=1)
    rise = np.divide(worn, load, out=np.zeros_like(worn), where=load > 0) * profile.mean - 0.5 * (first + last)
    start = way(a)[edge]
    part = (way(points) - start) / (way(b)[edge] - start)
    along = (1 - part) * first[edge] + part * last[edge] + 6 * part * (1 - part) * rise[edge]
    bears = (first != 0) | (last != 0)
    depth[points[bears[edge]] % n] = np.maximum(along, 0.0)[bears[edge]]
    half = 0.5 * contour.lengths * covered
    share = depth * (half + np.roll(half, 1))
    if amount.any() and not share.any():  # a contact between two points of the outline
        np.add.at(share, np.rint(profile.t).astype(int) % n, amount)
    return share * (amount.sum() / share.sum()) if share.sum() > 0 else share


def _spans(start: Array, end: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Whole numbers from each start up to before its end, one after the other, and whose they are."""
    count = np.maximum(end - start, 0).astype(int)
    whose = np.repeat(np.arange(len(count)), count)
    within = np.arange(len(whose)) - np.repeat(np.cumsum(count) - count, count)
    return start.astype(int)[whose] + within, whose


def critical_distance(element: float, specific_wear_rate: float, plane_strain_modulus: float) -> float:
    """Sliding distance beyond which the explicit step is unstable [mm]: ``4 h / (pi k E*)``.

    A pressure ripple of the mesh's shortest wave, q = pi / h, meets the stiffness E* q / 2 of a half-plane,
    and an explicit step multiplies it by 1 - k ds E* q / 2 (Johansson, Int. J. Numer. Methods Eng. 37
    (1994) 1595 analyses the instability for a half-plane).
    """
    if specific_wear_rate == 0:
        return math.inf
    return 4 * element / (math.pi * specific_wear_rate * plane_strain_modulus)
