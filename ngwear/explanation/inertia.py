"""Inertia of the rubber."""

from __future__ import annotations

import math

LIMIT = 0.01  # rho v^2 / G: by so much, relatively, inertia changes stresses under a steadily sliding load
SLOW = 0.1  # travel time of a shear wave over the time of a stroke: ten ways through: the part is as good as at rest


def wave_speed(modulus: float, density: float) -> float:
    """Speed of shear waves, ``sqrt(G / rho)`` [mm/s] (Johnson, *Contact Mechanics*, 1985, section 11.1).

    Parameters
    ----------
    modulus : float
        G [MPa]; the long-term one gives the slowest waves.
    density : float
        rho [t/mm³].
    """
    return math.sqrt(modulus / density)


def mach_squared(speed: float, modulus: float, density: float) -> float:
    """``rho v^2 / G`` [-]: dynamic pressure over stiffness, for a load that slides over rubber with the speed v [mm/s].

    The stiffness under a load in steady motion is lower by a share of this order (Johnson, 1985, chapter 11).
    Neglected: vibrations that friction itself excites (squeal), which need no high speed.
    """
    return density * speed**2 / modulus


def reversal(size: float, modulus: float, density: float, duration: float) -> float:
    """Time of a shear wave through the part over the time of a stroke, ``L / (c D)`` [-]; small: quasi-static.

    Parameters
    ----------
    size : float
        L, largest extent of the section [mm].
    modulus, density : float
        G [MPa] and rho [t/mm³].
    duration : float
        D, of the stroke [s].
    """
    return size / (wave_speed(modulus, density) * duration)
