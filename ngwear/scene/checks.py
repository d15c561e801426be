"""Effects of a scene that contradict each other: refused, with the reason and a way out."""

from __future__ import annotations

import math
from typing import Any

from ngwear.errors import require


def refuse_in_contact(contact: Any) -> None:
    """SceneError for a ``Contact`` (which calls this as it is built) whose effects contradict each other."""
    place, law, counter = f"contact '{contact.name}'", contact.friction_law, contact.counter_wear_rate
    still = "a surface that stands still (slides = false)"

    remedy = "give the part a specific_wear_rate as well: its error chooses the jumps"
    require(counter == 0 or contact.wears, f"{place}.counter_wear_rate", counter, remedy)

    remedy = f"{still} cannot be in full sliding: leave sticks out"
    require(contact.slides or contact.sticks is not False, f"{place}.sticks", contact.sticks, remedy)

    remedy = "without friction nothing sticks or slips: give the contact a friction, or leave sticks out"
    require(contact.sticks is None or law is not None, f"{place}.sticks", contact.sticks, remedy)

    remedy = f"{still} wears nothing: leave its wear rate out"
    require(contact.slides or not contact.wears, f"{place}.specific_wear_rate", contact.specific_wear_rate, remedy)

    drifts = law is not None and (bool(law.breaks) or law.depends_on_speed)
    remedy = f"{still} has no sliding distance and no speed for a law to follow: give a number"
    require(contact.slides or not drifts, f"{place}.friction", contact.friction, remedy)

    wear = contact.wear_law
    remedy = "wears by the work of friction: give the contact a friction"
    require(wear is None or not wear.needs_friction or law is not None, f"{place}.wear_law", wear, remedy)

    remedy = "says how the part wears, but its specific_wear_rate is 0: give one, or leave the law out"
    require(wear is None or contact.wears, f"{place}.wear_law", wear, remedy)


def refuse_in_scene(scene: Any) -> None:
    """SceneError for parts of a ``Scene``, which calls this as it is built, that contradict each other."""
    for stroke in scene.program.cycle:
        place, known = f"program.stroke '{stroke.name}'", stroke.speed is not None
        remedy = "a sealed pressure needs a [fluid] table that says which edges it may reach"
        require(stroke.pressure == 0 or scene.fluid is not None, f"{place}.pressure", stroke.pressure, remedy)
        remedy = "rubber with memory needs the stroke's speed in mm/s"
        require(scene.part.prony is None or known, f"{place}.speed", stroke.speed, remedy)
        for contact in scene.contacts:
            law = contact.friction_law
            remedy = f"the friction of contact '{contact.name}' depends on speed: give the stroke's in mm/s"
            require(law is None or not law.depends_on_speed or known, f"{place}.speed", stroke.speed, remedy)

    parts = scene.accuracy.parts
    for contact in scene.contacts:
        remedy = f"contact '{contact.name}' wears and may stick: whole strokes tell what of its slip lasts; take 1"
        whole = parts == 1 or not (contact.wears and scene.may_stick(contact))
        require(whole, "accuracy.parts", parts, remedy)

    rest = scene.program.rest
    remedy = "only rubber with memory changes while it sits: give [material.prony], or leave rest out"
    require(scene.part.prony is not None or math.isinf(rest), "program.rest", rest, remedy)

    order = scene.accuracy.order
    why = why_not_order(scene, order)
    require(why is None, "accuracy.order", order, why or "")

    if scene.deactivation is not None:
        _refuse_with_deactivation(scene)


def why_not_order(scene: Any, order: int) -> str | None:
    """Why the elements of a ``Scene`` cannot have an order, and a way out; None if they can.

    Stick and slip on elements of order 1: the stick zone of ``verify partial_slip`` on edges of a/25 is 38 % too wide,
    of orders 2 and 3 1.2 and 1.3 %.
    """
    if order == 2:
        return None
    if scene.deactivation is not None:
        return (
            "must be 2 in a scene that deactivates elements: what is kept of a state when elements are lost is of that "
            "order, and quadrilaterals have no bubbles; leave [deactivation] out for another"
        )
    sticking = [contact.name for contact in scene.contacts if scene.may_stick(contact)]
    if order == 1 and sticking:
        return (
            f"must be 2 or 3 where friction may stick, as in contact '{sticking[0]}': tractions constant on each mesh "
            "edge ring with displacements of order 1; sticks = false lets the contact slide in full"
        )
    return None


def _refuse_with_deactivation(scene: Any) -> None:
    remedy = "must be 'never' in a scene that deactivates elements: its mesh loses them and is not made anew"
    require(scene.wear.remesh == "never", "wear.remesh", scene.wear.remesh, remedy)
    remedy = "elements can be deactivated in rubber without memory only: leave one of both out"
    require(scene.part.prony is None, "material.prony", scene.part.prony, remedy)
    remedy = "at least one contact must wear: below its edges the layers of elements lie"
    require(bool(scene.worn_edges), "contact.specific_wear_rate", 0.0, remedy)
    for name in ("across", "error"):
        value = getattr(scene.accuracy, name)
        remedy = "elements that are lost have one edge all along: give accuracy.patch, a length in mm"
        require(value is None, f"accuracy.{name}", value, remedy)
    thinnest = scene.accuracy.patch
    remedy = f"must be at least one element thick (accuracy.patch = {thinnest:g} mm)"
    require(scene.deactivation.depth >= thinnest, "deactivation.depth", scene.deactivation.depth, remedy)
