"""Wear of what a contact does not see: a curve of the outline within a mesh edge."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact_profile import ContactProfile
from ngwear.geometry.outline import Outline

Array = NDArray[np.float64]

MOST = 0.5  # of its own wear: what a point gives; settled on a worn U-cup, see tests/benchmarks/README.md
SAME = 1e-9  # of a segment: a node so near to a point of the outline is on it


def evened(contour: Outline, profile: ContactProfile, share: Array) -> Array:
    """Move wear from the middle of mesh edges that stands off to their ends that press; the sum stays.

    The pressure is linear along a mesh edge, so that a contact sees of its gap the mean and the slope only. A gap of
    ``s (4 x (1 - x) - 2/3)``, x from 0 to 1 along the edge, has neither: the middle stands off, both ends are in the
    surface, and no pressure tells of it. It comes about where a worn contact ends in a corner: the node there belongs
    to an edge out of contact, too, and lags behind. Finer elements of a later mesh would find a ridge, and a spike of
    pressure. So the ends wear deeper by ``2/3 s``, and the points between them less.

    Parameters
    ----------
    contour : Outline
    profile : ContactProfile
    share : array, shape (n,)
        Worn area at each point of the outline [mm²].

    Returns
    -------
    array, shape (n,)
        The same sum; no point gives more than ``MOST`` of its own.
    """
    n, half = len(contour), 0.5 * contour.lengths
    flow = np.zeros(n)
    for k in np.flatnonzero((profile.mean > 0) & (profile.standing_off > 0)):
        a, b = profile.t[profile.edges[k]]
        b = b if b > a else b + n
        between = np.arange(np.floor(a + SAME) + 1, np.ceil(b - SAME)).astype(int) % n
        ends = [(round(t), beside) for t, beside in ((a, 0), (b, -1)) if abs(t - round(t)) < SAME]
        wanted = {t % n: 2 / 3 * profile.standing_off[k] * half[(t + beside) % n] for t, beside in ends}
        most, asked = MOST * share[between].sum(), sum(wanted.values())
        if most == 0 or asked == 0:
            continue
        moved = min(1.0, most / asked)
        for t, area in wanted.items():
            flow[t] += moved * area
        flow[between] -= moved * asked * share[between] / share[between].sum()
    return share + flow
