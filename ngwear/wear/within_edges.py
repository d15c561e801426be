"""Wear of what a contact does not see: a curve of the outline within a mesh edge."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact_profile import ContactProfile
from ngwear.geometry.outline import Outline

Array = NDArray[np.float64]

MOST = 1 / 3  # of the difference in depth: what an end gains; both may, and then none becomes the deeper one
SAME = 1e-9  # of a segment: a node so near to a point of the outline is on it


def evened(contour: Outline, profile: ContactProfile, share: Array) -> Array:
    """Move wear from the middle of mesh edges that stands off to their ends that press; the sum stays.

    The pressure is linear along a mesh edge, so that a contact sees of its gap the mean and the slope only. A gap of
    ``s (4 x (1 - x) - 2/3)``, x from 0 to 1 along the edge, has neither: the middle stands off, both ends are in the
    surface, and no pressure tells of it. It comes about where a worn contact ends in a corner: the node there belongs
    to an edge out of contact, too, and lags behind. Finer elements of a later mesh would find a ridge, and a spike of
    pressure. So the ends wear deeper by ``2/3 s``, and the points between them less. No end becomes the deeper one:
    what stands off for another reason stays.

    Parameters
    ----------
    contour : Outline
    profile : ContactProfile
    share : array, shape (n,)
        Worn area at each point of the outline [mm²].

    Returns
    -------
    array, shape (n,)
        The same sum.
    """
    n, half, width = len(contour), 0.5 * contour.lengths, contour.widths()
    depth, flow = share / width, np.zeros(n)
    standing = np.flatnonzero((profile.mean > 0) & (profile.standing_off > 0))
    givers = np.bincount(profile.edges[standing].ravel(), minlength=len(profile.t))
    for k in standing:
        nodes = profile.edges[k]
        a, b = profile.t[nodes]
        b = b if b > a else b + n
        between = np.arange(np.floor(a + SAME) + 1, np.ceil(b - SAME)).astype(int) % n
        given, long = share[between].sum(), width[between].sum()
        if given == 0:
            continue
        for t, beside, giving in ((a, 0, givers[nodes[0]]), (b, -1, givers[nodes[1]])):
            end = round(t) % n
            shallower = given / long - depth[end]
            if abs(t - round(t)) < SAME and shallower > 0:
                wanted = 2 / 3 * profile.standing_off[k] * half[(end + beside) % n]
                moved = min(wanted, MOST * shallower * min(width[end] / giving, long))
                flow[end] += moved
                flow[between] -= moved * share[between] / given
    return share + flow
