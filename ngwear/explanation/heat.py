"""Flash temperature of a sliding contact."""

from __future__ import annotations

import math

import numpy as np
from scipy.special import k0e, k1e

LIMIT = 10.0  # K: by WLF's universal constants rubber 50 K above its glass transition then relaxes six times as fast
POINTS = 2001  # of a sum over the band; its error is far below that of the constants assumed


def peclet(speed: float, half_width: float, diffusivity: float) -> float:
    """``L = v b / (2 kappa)`` [-] of a body that moves past a contact.

    Jaeger (J. Proc. R. Soc. N.S.W. 76 (1942) 203). Below 0.1 heat conduction is faster than the motion; above 5 it
    is slower.

    Parameters
    ----------
    speed : float
        v [mm/s].
    half_width : float
        b [mm].
    diffusivity : float
        kappa [mm²/s].
    """
    return speed * half_width / (2 * diffusivity)


def band_rise(flux: float, half_width: float, speed: float, conductivity: float, heat_capacity: float) -> float:
    """Maximum steady temperature rise under a band of uniform heat that moves over a half-space [K].

    Jaeger's line sources (Carslaw & Jaeger, *Conduction of Heat in Solids*, 1959, section 10.7) integrated over the
    band:

        T(x) = 2 q kappa / (pi k v) [I+(L + X) + I-(L - X)],   X = v x / (2 kappa), L = v b / (2 kappa),
        I+(z) = z e^z (K0(z) + K1(z)) - 1,   I-(z) = z e^-z (K0(z) - K1(z)) + 1,

    the integrals of ``e^(+-t) K0(t)`` (Abramowitz & Stegun, section 11.3). At high speed it is ``2 q sqrt(2 b / (pi k
    rho c v))``. Neglected: heat from earlier passes, and heat into the other body.

    Parameters
    ----------
    flux : float
        q, heat per area and time that goes into this body [MPa mm/s].
    half_width : float
        b [mm].
    speed : float
        v [mm/s], > 0.
    conductivity : float
        k [W/(m K)].
    heat_capacity : float
        rho c [MPa/K].
    """
    diffusivity = conductivity / heat_capacity
    number = peclet(speed, half_width, diffusivity)
    place = number * np.cos(np.linspace(0.0, math.pi, POINTS)[1:-1])  # X, from one end of the band to the other
    behind, ahead = number + place, number - place
    wake = behind * (k0e(behind) + k1e(behind)) - 1
    bow = ahead * np.exp(-2 * ahead) * (k0e(ahead) - k1e(ahead)) + 1
    return 2 * flux * diffusivity / (math.pi * conductivity * speed) * float((wake + bow).max())


def disc_rise(flux: float, radius: float, speed: float, conductivity: float, heat_capacity: float) -> float:
    """Maximum steady temperature rise under a disc of uniform heat that moves over a half-space, or rests [K].

    ``T = 2 q a / (k sqrt(pi (1.273 + L)))`` with ``L = v a / (2 kappa)`` (Tian & Kennedy, J. Tribol. 116 (1994) 167),
    which is q a / k at rest, and at high speed that of a band with the width of the disc. Neglected: as in
    ``band_rise``.

    Parameters
    ----------
    flux : float
        q [MPa mm/s].
    radius : float
        a [mm].
    speed : float
        v [mm/s], >= 0.
    conductivity, heat_capacity : float
        k [W/(m K)] and rho c [MPa/K].
    """
    number = peclet(speed, radius, conductivity / heat_capacity)
    return 2 * flux * radius / (conductivity * math.sqrt(math.pi * (1.273 + number)))


def shared_rise(one: float, other: float) -> float:
    """Temperature rise with heat divided for equal temperature of both bodies [K]: ``1 / T = 1 / T_1 + 1 / T_2``.

    Each argument is the rise if all heat goes into that body (Archard, Wear 2 (1959) 438).
    """
    return one * other / (one + other)


def reach(time: float, diffusivity: float) -> float:
    """Depth that is warmed by steady heating of a surface, ``sqrt(pi kappa t) / 2`` [mm].

    Defined so that the heat q t in a layer of this depth gives the surface temperature ``2 q sqrt(t / (pi k rho c))``
    of a half-space under constant flux (Carslaw & Jaeger, 1959, section 2.9).

    Parameters
    ----------
    time : float
        t [s].
    diffusivity : float
        kappa [mm²/s].
    """
    return math.sqrt(math.pi * diffusivity * time) / 2


def uncooled_rise(heat: float, volume: float, heat_capacity: float) -> float:
    """Temperature rise of a volume without cooling, ``Q / (rho c V)`` [K].

    Parameters
    ----------
    heat : float
        Q [mJ, or mJ/mm].
    volume : float
        V [mm³, or mm²].
    heat_capacity : float
        rho c [MPa/K].
    """
    return heat / (heat_capacity * volume)
