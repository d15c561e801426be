"""What holds a part: its supports, or surfaces that squeeze it."""

from __future__ import annotations

from typing import Any

import numpy as np

TOUCHING = 1e-9  # of the section's size: what rounding makes of a gap of zero
AGAINST = 0.5  # cosine: a surface whose normal is nearer to a direction holds the part in it


def free_directions(scene: Any) -> tuple[int, ...]:
    """Components of the displacement, 0 for x and 1 for y, in which nothing holds the unworn part.

    A support holds it, and two surfaces that squeeze the section as drawn: they touch it from opposite sides, and one
    at least, not under force, overlaps it: one under force does not stay where it is drawn. Surfaces that only touch it
    may lose it when it deforms. The hoop tension of an axisymmetric part holds it in the radial direction. Friction
    does not count: it may slip.
    """
    contour = scene.part.outline
    free, touching = [], TOUCHING * float(np.ptp(contour.points, axis=0).max())
    for axis, name in enumerate("x" if scene.axisymmetric else "xy"):
        ways, deepest = set[int](), 0.0
        for spec in scene.contacts:
            mine = contour.on(spec.edges)
            x, y = contour.points[mine | np.roll(mine, 1)].T
            gap = spec.surface.gap(x, y)
            push = np.where(gap <= touching, np.broadcast_to(spec.surface.normal(x, y)[axis], x.shape), 0.0)
            ways |= {sign for sign in (-1, 1) if (sign * push > AGAINST).any()}
            if spec.force is None:
                deepest = max(deepest, float(-gap[np.abs(push) > AGAINST].min(initial=0.0)))
        squeezed = len(ways) == 2 and deepest > touching
        if not (squeezed or any(getattr(s, name) for s in scene.supports)):
            free.append(axis)
    return tuple(free)
