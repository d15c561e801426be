"""Fluid film between rubber and counter-surface."""

from __future__ import annotations

import math

MIXED, FULL = 1.0, 3.0  # film over roughness, from which films carry and part the surfaces (lambda ratio, as usual)


def hersey(viscosity: float, speed: float, load: float) -> float:
    """Hersey's number ``eta v / P'`` of a line contact [-], the abscissa of Stribeck's curve.

    Parameters
    ----------
    viscosity : float
        eta [MPa s].
    speed : float
        v [mm/s].
    load : float
        P' [N/mm].
    """
    return viscosity * speed / load


def line_film(viscosity: float, speed: float, load: float, radius: float, modulus: float) -> float:
    """Minimum film thickness of a fully flooded soft line contact with a sliding counter-surface [mm].

        h = 3.10 R U^0.6 W^-0.2,   U = eta (v / 2) / (2 E* R),   W = P' / (2 E* R)

    (Herrebrugh, J. Lubr. Technol. 90 (1968) 262, in the form of Hamrock, *Fundamentals of Fluid Film Lubrication*,
    isoviscous-elastic regime). Neglected: roughness, starvation, the squeeze at reversals; a seal's film depends on how
    its own pressure rises at the inlet. So it gives only the order of magnitude.

    Parameters
    ----------
    viscosity : float
        eta [MPa s].
    speed : float
        v, of the counter-surface [mm/s]; the entrainment speed is half of it.
    load : float
        P' [N/mm].
    radius : float
        R, of the gap's curvature [mm].
    modulus : float
        E* [MPa].
    """
    drawn, pressed = viscosity * speed / 2 / (2 * modulus * radius), load / (2 * modulus * radius)
    return 3.10 * radius * drawn**0.6 * pressed**-0.2


def point_film(viscosity: float, speed: float, load: float, radius: float, modulus: float) -> float:
    """Minimum film thickness under a ball on soft material, fully flooded [mm].

        h = 7.43 R U^0.65 W^-0.21 (1 - 0.85 e^-0.31),   U = eta (v / 2) / (2 E* R),   W = F / (2 E* R^2)

    (Hamrock & Dowson, J. Lubr. Technol. 100 (1978) 236, circular contact). Neglects what ``line_film`` does.

    Parameters
    ----------
    viscosity, speed : float
        eta [MPa s] and v [mm/s].
    load : float
        F [N].
    radius : float
        R [mm].
    modulus : float
        E* [MPa].
    """
    drawn, pressed = viscosity * speed / 2 / (2 * modulus * radius), load / (2 * modulus * radius**2)
    return 7.43 * radius * drawn**0.65 * pressed**-0.21 * (1 - 0.85 * math.exp(-0.31))


def regime(ratio: float) -> str:
    """Lubrication regime as text, by film thickness over roughness."""
    if ratio < MIXED:
        return "boundary lubrication, the asperities carry"
    return "mixed lubrication, film and asperities carry" if ratio < FULL else "a full film that separates the surfaces"
