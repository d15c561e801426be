"""Adhesion of a contact: pull-off force, and Tabor's number."""

from __future__ import annotations

import math

LIMIT = 0.1  # pull-off force over load: by that share of it adhesion changes what the contact carries


def hertz_radius(load: float, half_width: float, modulus: float) -> float:
    """Radius of the cylinder whose Hertzian contact has this load and width, ``R = pi E* a^2 / (4 P')`` [mm].

    Johnson, *Contact Mechanics*, 1985, equation 4.43. For other contacts it is an equivalent radius.

    Parameters
    ----------
    load : float
        P' [N/mm].
    half_width : float
        a [mm].
    modulus : float
        E* [MPa].
    """
    return math.pi * modulus * half_width**2 / (4 * load)


def line_pull_off(radius: float, modulus: float, work: float) -> float:
    """Pull-off force of a cylinder on a half-space, ``(3/4) (4 pi E* W^2 R)^(1/3)`` [N/mm].

    The minimum of ``P' = pi E* a^2 / (4 R) - sqrt(2 pi E* a W)`` (Barquins, J. Adhesion 26 (1988) 1), the line contact
    of Johnson, Kendall & Roberts. Neglected: roughness, oil, and rubber's losses, which multiply W at separation.

    Parameters
    ----------
    radius : float
        R [mm].
    modulus : float
        E* [MPa].
    work : float
        W, of adhesion [N/mm].
    """
    return 0.75 * (4 * math.pi * modulus * work**2 * radius) ** (1 / 3)


def point_pull_off(radius: float, work: float) -> float:
    """Pull-off force of a ball on a half-space, ``(3/2) pi W R`` [N].

    Johnson, Kendall & Roberts, Proc. R. Soc. A 324 (1971) 301; neglects what ``line_pull_off`` does.

    Parameters
    ----------
    radius : float
        R [mm].
    work : float
        W [N/mm].
    """
    return 1.5 * math.pi * work * radius


def tabor(radius: float, modulus: float, work: float, distance: float) -> float:
    """``(R W^2 / (E*^2 z0^3))^(1/3)`` [-]: deformation by adhesion over range of the attraction.

    Tabor, J. Colloid Interface Sci. 58 (1977) 2. Above 5 the theory of Johnson, Kendall & Roberts holds, and with it
    the pull-off forces here; below 0.1 the attraction acts outside the contact (Maugis, ibid. 150 (1992) 243; for lines
    Johnson & Greenwood, J. Phys. D 41 (2008) 155315).

    Parameters
    ----------
    radius : float
        R [mm].
    modulus : float
        E* [MPa].
    work : float
        W [N/mm].
    distance : float
        z0, of the surfaces' atoms [mm].
    """
    return (radius * work**2 / (modulus**2 * distance**3)) ** (1 / 3)
