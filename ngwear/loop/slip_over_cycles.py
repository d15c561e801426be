"""Slip of a stroke in each of the cycles that one solve stands for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ngwear.loop.state import Phase
from ngwear.scene.program import Stroke

Array = NDArray[np.float64]


def slip_per_cycle(
    cycle: Sequence[Stroke], phases: Sequence[Phase], index: int, repeats: int
) -> dict[str, Array] | None:
    """Slip over travel of a stroke, mean over its ``repeats`` [-], by contact; wear is proportional to it.

    Where wear unloads a place, its neighbours take over the friction and slip a little, once. In a solve for many
    cycles this slip must count once, not in each cycle. In a periodic cycle of two opposite strokes each point returns
    to its place, so that both strokes have equal slip: the excess of one over the other happens once. For other cycles
    the slip is not corrected.
    """
    own = phases[index].shares
    if own is None or repeats < 2 or len(cycle) != 2:
        return own
    there, back = cycle
    other = phases[1 - index].shares
    if other is None or there.direction * there.travel + back.direction * back.travel != 0:
        return own
    return {name: (share + (repeats - 1) * np.minimum(share, other[name])) / repeats for name, share in own.items()}
