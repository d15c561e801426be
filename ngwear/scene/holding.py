"""What holds a part: its supports, or surfaces that press on it from two sides."""

from __future__ import annotations

from typing import Any

import numpy as np

AGAINST = 0.5  # cosine: a surface whose normal is nearer to a direction holds the part in it


def free_directions(scene: Any) -> tuple[int, ...]:
    """Components of the displacement, 0 for x and 1 for y, in which nothing holds the unworn part.

    A support holds it, and two surfaces that touch or overlap the section as drawn from opposite sides. The hoop
    tension of an axisymmetric part holds it in the radial direction. Friction does not count: it may slip.
    """
    contour = scene.part.outline
    free = []
    for axis, name in enumerate("x" if scene.axisymmetric else "xy"):
        ways: set[int] = set()
        for spec in scene.contacts:
            mine = contour.on(spec.edges)
            x, y = contour.points[mine | np.roll(mine, 1)].T
            push = np.broadcast_to(spec.surface.normal(x, y)[axis], x.shape)[spec.surface.gap(x, y) <= 0]
            ways |= {sign for sign in (-1, 1) if (sign * push > AGAINST).any()}
        if not (any(getattr(s, name) for s in scene.supports) or len(ways) == 2):
            free.append(axis)
    return tuple(free)
