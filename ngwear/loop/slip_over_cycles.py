"""What of a stroke's slip goes on in every cycle that a solve stands for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ngwear.loop.state import Phase
from ngwear.scene.program import Stroke

Array = NDArray[np.float64]


def lasting(cycle: Sequence[Stroke], phases: Sequence[Phase], index: int, repeats: int) -> dict[str, Array] | None:
    """Slip over travel of a stroke, mean over its ``repeats``, by contact: what the wear follows.

    Where wear unloads a place, its neighbours take over its friction and slip a little, once; solved for many cycles at
    once, that slip must not count as often. A surface that goes to and fro leaves each point where it was after a cycle
    that repeats itself, so that both strokes slip alike: what one slips more than the other happens once. Cycles of
    other strokes are taken as they are.
    """
    own = phases[index].shares
    if own is None or repeats < 2 or len(cycle) != 2:
        return own
    there, back = cycle
    other = phases[1 - index].shares
    if other is None or there.direction * there.travel + back.direction * back.travel != 0:
        return own
    return {name: (share + (repeats - 1) * np.minimum(share, other[name])) / repeats for name, share in own.items()}
