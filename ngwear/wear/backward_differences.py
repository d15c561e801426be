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


def error_over_difference(now: float, before: float) -> float:
    """A step's error over its difference from the trapezoidal rule, to leading order [-].

    With a mean pressure p + p' s/2 + p'' s²/6 over a way s, the step above errs by e and the trapezoidal rule by 1/6,
    both in p'' s²/2:

        e = a / (3 r²) + (1 - a) - 1/3,   e / (e - 1/6) = 1 + r (1 + 2 r) / (2 + 3 r).

    Backward Euler errs in first order, so that the difference is its error.

    Parameters
    ----------
    now, before : float
        As in ``share_of_last``.
    """
    if before <= 0:
        return 1.0
    ratio = now / before
    return 1 + ratio * (1 + 2 * ratio) / (2 + 3 * ratio)
