"""Backward differences of second order for the worn depth."""

from __future__ import annotations


def share_of_last(now: float, before: float) -> float:
    """Weight a of the last step's mean pressure in the depth of the next one, [0, 1/2).

        w_1 - w_0 = kappa (a q_0 + (1 - a) p_1),   a = r / (1 + 2 r),   r = now / before

    with the pressure p_1 at the end of the step and q_0 = (w_0 - w_-1) / kappa_0 the mean one of the last. This is BDF2
    for dw/ds = k p with variable steps, written by increments: of second order, and a ripple of any stiffness is damped
    (Hairer & Wanner, *Solving Ordinary Differential Equations II*, section V.1). Being a mean of two pressures it wears
    k F s under a constant force. Without a last step it is backward Euler, a = 0.

    Parameters
    ----------
    now, before : float
        ``int k ds`` over the highest k, of this step and of the last [mm]; before = 0 if there is none.
    """
    return now / (before + 2 * now) if before > 0 else 0.0
