"""Checks for values of a scene that contradict each other; each error says the reason and the remedy."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ngwear.errors import require


def refuse_in_contact(contact: Any) -> None:
    """Raise SceneError if values of a ``Contact`` contradict each other; its constructor calls this."""
    place, law, counter = f"contact '{contact.name}'", contact.friction_law, contact.counter_wear_rate
    still = "a surface that does not slide (slides = false)"

    remedy = "give the part a specific_wear_rate as well: its error controls the cycle jumps"
    require(counter == 0 or contact.wears, f"{place}.counter_wear_rate", counter, remedy)

    remedy = f"{still} cannot be in full sliding: remove sticks"
    require(contact.slides or contact.sticks is not False, f"{place}.sticks", contact.sticks, remedy)

    remedy = "without friction nothing sticks or slips: give the contact a friction, or remove sticks"
    require(contact.sticks is None or law is not None, f"{place}.sticks", contact.sticks, remedy)

    remedy = f"{still} wears nothing: remove its wear rate"
    require(contact.slides or not contact.wears, f"{place}.specific_wear_rate", contact.specific_wear_rate, remedy)

    drifts = law is not None and (bool(law.breaks) or law.depends_on_speed)
    remedy = f"{still} has no sliding distance and no speed for a friction law: give a number"
    require(contact.slides or not drifts, f"{place}.friction", contact.friction, remedy)

    wear = contact.wear_law
    remedy = "computes wear from the work of friction: give the contact a friction"
    require(wear is None or not wear.needs_friction or law is not None, f"{place}.wear_law", wear, remedy)

    remedy = "has no effect while specific_wear_rate is 0: give a rate, or remove the law"
    require(wear is None or contact.wears, f"{place}.wear_law", wear, remedy)


def refuse_in_scene(scene: Any) -> None:
    """Raise SceneError if parts of a ``Scene`` contradict each other; its constructor calls this."""
    for stroke in scene.program.cycle:
        place, known = f"program.stroke '{stroke.name}'", stroke.speed is not None
        remedy = "a fluid pressure needs a [fluid] table with the edges that the fluid may wet"
        dry = stroke.highest_pressure == 0
        require(dry or scene.fluid is not None, f"{place}.pressure", stroke.pressure, remedy)
        inlets = [] if scene.fluid is None else list(scene.fluid.inlets)
        if isinstance(stroke.pressure, Mapping):
            for name, pressure in stroke.pressure.items():
                remedy = f"no inlet has this name; the inlets are {inlets}"
                require(name in inlets, f"{place}.pressure.{name}", pressure, remedy)
        else:
            example = ", ".join(f'"{name}" = {stroke.pressure:g}' for name in inlets)
            remedy = f"the scene has several inlets: give the pressure of each, such as {{ {example} }}"
            require(dry or len(inlets) == 1, f"{place}.pressure", stroke.pressure, remedy)
        remedy = "rubber with memory needs the stroke's speed in mm/s"
        require(scene.part.prony is None or known, f"{place}.speed", stroke.speed, remedy)
        for contact in scene.contacts:
            law = contact.friction_law
            remedy = f"the friction of contact '{contact.name}' depends on speed: give the speed of the stroke in mm/s"
            require(law is None or not law.depends_on_speed or known, f"{place}.speed", stroke.speed, remedy)

    parts = scene.accuracy.parts
    for contact in scene.contacts:
        remedy = (
            f"contact '{contact.name}' wears and may stick: its slip per cycle is known for whole strokes only; give 1"
        )
        whole = parts == 1 or not (contact.wears and scene.may_stick(contact))
        require(whole, "accuracy.parts", parts, remedy)

    rest = scene.program.rest
    remedy = "only rubber with memory changes during the rest: give [material.prony], or remove rest"
    require(scene.part.prony is not None or math.isinf(rest), "program.rest", rest, remedy)

    order = scene.accuracy.order
    why = why_not_order(scene, order)
    require(why is None, "accuracy.order", order, why or "")

    if scene.deactivation is not None:
        _refuse_with_deactivation(scene)


def why_not_order(scene: Any, order: int) -> str | None:
    """Reason why the elements of a ``Scene`` cannot have an order, with a remedy; None if they can.

    Stick and slip needs order 2 or 3: with element edges of a/25 the stick zone of ``verify partial_slip`` is 38 % too
    wide with order 1, and 1.2 % and 1.3 % with orders 2 and 3.
    """
    if order == 2:
        return None
    if scene.deactivation is not None:
        return (
            "must be 2 in a scene that deactivates elements: the transfer of the state to the remaining elements is "
            "written for order 2; remove [deactivation] for another order"
        )
    sticking = [contact.name for contact in scene.contacts if scene.may_stick(contact)]
    if order == 1 and sticking:
        return (
            f"must be 2 or 3 where friction may stick, as in contact '{sticking[0]}': tractions that are constant on "
            "each mesh edge oscillate with displacements of order 1; or set sticks = false for full sliding"
        )
    return None


def _refuse_with_deactivation(scene: Any) -> None:
    remedy = "must be 'never' in a scene that deactivates elements: such a scene is not remeshed"
    require(scene.wear.remesh == "never", "wear.remesh", scene.wear.remesh, remedy)
    remedy = "elements can be deactivated only in rubber without memory: remove [material.prony] or [deactivation]"
    require(scene.part.prony is None, "material.prony", scene.part.prony, remedy)
    remedy = "at least one contact must wear: the layers of elements lie below its edges"
    require(bool(scene.worn_edges), "contact.specific_wear_rate", 0.0, remedy)
    for name in ("across", "error"):
        value = getattr(scene.accuracy, name)
        remedy = "a scene that deactivates elements has one element edge in its layers: give accuracy.patch in mm"
        require(value is None, f"accuracy.{name}", value, remedy)
    edge = scene.accuracy.patch
    remedy = f"must be at least one element thick (accuracy.patch = {edge:g} mm)"
    require(scene.deactivation.depth >= edge, "deactivation.depth", scene.deactivation.depth, remedy)
