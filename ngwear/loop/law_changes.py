"""Change of friction and wear laws with the sliding distance, and the longest cycle jump that it allows."""

from __future__ import annotations

from collections.abc import Iterator

from ngwear.laws import Curve
from ngwear.scene.contact import Contact
from ngwear.scene.scene import Scene

# Settled on starving lubrication (``verify lubrication error_estimates``); coarser runs show what this errs by.
CHANGE, MOST_CHANGE = 5.0, 0.5  # times the wear error, and most: of a law in a jump, over its highest value
LAG = 0.5  # times the wear error: of the friction that a jump uses behind its mean over the jump


def steady_cycles(scene: Scene, done: int, most: int) -> int:
    """Number of cycles, from one to ``most``, of a step after ``done`` strokes.

    In a step of several cycles no law may change by more than five times ``Accuracy.wear_error`` of its maximum in the
    scene, nor by more than half of that maximum. Friction is taken from the middle of the step; it may differ from its
    mean over the step by half of ``wear_error``. So no jump passes over a phase of a law. A coarser run, with longer
    jumps, shows the error.
    """
    start, kinds = scene.program.slid(done), len(scene.program.cycle)
    allowed, refused = 1, most + 1
    while refused - allowed > 1:
        tried = (allowed + refused) // 2
        if _is_steady(scene, start, scene.program.slid(done + tried * kinds)):
            allowed = tried
        else:
            refused = tried
    return allowed


def friction_range(scene: Scene, contact: Contact) -> tuple[float, float]:
    """Smallest and largest friction coefficient over the program [-], at zero pressure."""
    last = scene.program.slid(scene.program.strokes)
    found = [curve.extremes(0.0, last) for curve in _friction(scene, contact)]
    return min(low for low, _ in found), max(high for _, high in found)


def _is_steady(scene: Scene, start: float, end: float) -> bool:
    last, error = scene.program.slid(scene.program.strokes), scene.accuracy.tolerances.wear_error
    for contact in scene.contacts:
        friction = list(_friction(scene, contact))
        for curve in (*friction, contact.wear_rate.curve):
            low, high = curve.extremes(start, end)
            if high - low > min(CHANGE * error, MOST_CHANGE) * curve.extremes(0.0, last)[1]:
                return False
        for curve in friction:
            mean = curve.mean(start, end)
            if abs(curve.value(0.5 * (start + end)) - mean) > LAG * error * mean:
                return False
    return True


def _friction(scene: Scene, contact: Contact) -> Iterator[Curve]:
    """Friction over sliding distance, at the speed of each stroke of the cycle."""
    law = contact.friction_law
    if law is not None:
        for speed in {stroke.speed for stroke in scene.program.cycle}:
            yield law.curve(speed)
