"""Relaxation of a Prony series: stiffness over time, and time of relaxation."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ngwear.explanation.verdict import onset


def stiffness(ratios: Sequence[float], times: Sequence[float], time: float) -> float:
    """``G(t) / G_inf = 1 + sum gamma_i exp(-t / tau_i)`` [-] of a Prony series.

    Holzapfel, *Nonlinear Solid Mechanics*, 2000, section 6.10.

    Parameters
    ----------
    ratios, times : sequence of float
        gamma_i [-] and tau_i [s].
    time : float
        Time t after a step of the strain [s].
    """
    return 1 + sum(g * math.exp(-time / tau) for g, tau in zip(ratios, times, strict=True))


def relaxed_after(ratios: Sequence[float], times: Sequence[float], excess: float) -> float:
    """Time after which the stiffness exceeds the long-term one by less than ``excess``, relative [s]."""
    return onset(lambda t: -stiffness(ratios, times, t), -(1 + excess))
