"""Mesh the unworn section and mount the part, before the first stroke."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ngwear.effects.base import DISPLACEMENT
from ngwear.equilibrium.stepping import StepOptions, Work, advance, relax
from ngwear.errors import ConvergenceError, SceneError
from ngwear.geometry.body import Body
from ngwear.loop.refinement import mounting_field, required_sizes, unworn_outline
from ngwear.loop.stage import Stage
from ngwear.loop.state import State
from ngwear.materials import PronySeries
from ngwear.scene.boundary import FLUID
from ngwear.scene.scene import Scene
from ngwear.wear.archard import critical_distance

if TYPE_CHECKING:
    from ngwear.effects.fluid_pressure import FluidPressure
    from ngwear.geometry.element_body import ElementBody

log = logging.getLogger(__name__)

MAY_COME = 5.0  # element edges in the contact: gap within which the outline may come into contact later


def warn_if_unstable(scene: Scene) -> None:
    """Warn if explicit wear steps are too long: the pressure then oscillates from node to node."""
    wear, cycle = scene.wear, scene.program.cycle
    rate = max((c.wear_rate.highest for c in scene.contacts), default=0.0)
    critical = critical_distance(scene.accuracy.lengths.patch, rate, scene.part.material.plane_strain_modulus)
    longest = max(s.travel for s in cycle)
    if wear.scheme == "explicit" and longest > critical:
        warnings.warn(
            f"explicit wear over {longest:.4g} mm a step is unstable: the pressure oscillates from node to node beyond "
            f"{critical:.4g} mm; use scheme = 'implicit', or shorter strokes",
            RuntimeWarning,
            stacklevel=3,
        )


def unworn_body(scene: Scene, across: float | None = None) -> Body | ElementBody:
    """The unworn section, meshed for mounting; ``across`` as in ``mounting_field``."""
    if scene.deactivation is not None:
        from ngwear.loop import lost_elements

        return lost_elements.element_body(scene)
    return Body(unworn_outline(scene), mounting_field(scene, across))


def mount(stage: Stage, on_mount: Callable[[float], None], way: Callable[..., Work] | None = None) -> Work:
    """Move the surfaces to their places, without fluid pressure; ``on_mount`` is called with the completed fraction.

    ``way(target, options, on_step=...)`` changes the loads; default ``stepping.advance``.

    Raises
    ------
    ConvergenceError
        If no equilibrium is found.
    """
    problem = stage.problem
    loads = stage.mounted_loads()

    def report(fraction: float, _: Any) -> None:
        on_mount(0.7 * fraction)

    if not stage.floats and stage.stretched_guess():
        problem.set_loads(loads)
        try:
            return relax(problem, StepOptions(first=1 / 64), on_step=report)  # a guess: begin with care
        except ConvergenceError as error:
            log.info("%s: mounting by interference instead", error)
            problem.state.vec[:] = 0.0
    # A part with room to move is held between its surfaces on the way; stretched off its shaft it would tip over.
    problem.set_loads(stage.first_touch())
    try:
        way = way or partial(advance, problem)
        return way(loads, StepOptions(first=1 / 8), on_step=report)  # grows while it is easy
    except ConvergenceError as error:
        unheld = "nothing" in str(error)  # the part has no support
        advice = "" if unheld else "; lower force, interference or friction"
        raise error.with_words(f"no equilibrium found under the mounting load{advice}: ") from None


def refuse_useless(state: State) -> None:
    """SceneError if a contact or an inlet takes no part in any stroke."""
    _refuse_idle_contacts(state)
    _refuse_closed_inlets(state)


def _refuse_idle_contacts(state: State) -> None:
    """SceneError if a surface that should wear the part touches it in no stroke."""
    problem = state.stage.problem
    for spec in state.stage.scene.contacts:
        contact = state.stage.contacts[spec.name]
        pressed = any(p.vector[problem.part(contact.pressure_name)].max() > 0 for p in state.phases)
        if spec.wears and not pressed:
            raise SceneError(
                f"contact '{spec.name}'.surface",
                spec.surface,
                "touches its edges in no stroke, so that nothing wears; move it closer or give a force",
            )


def _refuse_closed_inlets(state: State) -> None:
    """SceneError if an inlet lies, in each stroke with pressure, in a pocket that a contact closes."""
    stage, cycle = state.stage, state.stage.scene.program.cycle
    vector = stage.problem.state.vec.FV().NumPy()
    keep = vector.copy()
    for name, fluid in stage.fluids.items():
        closing: list[str | None] = []
        for stroke, phase in zip(cycle, state.phases, strict=True):
            if stroke.pressure_at(name) > 0:
                vector[:] = phase.vector
                closing.append(_closing(stage, fluid))
        vector[:] = keep
        if closing and all(closing):
            place = "fluid.inlet" if name == FLUID else f"fluid.inlet.{name}"
            remedy = f"lies in a pocket that the contact '{closing[0]}' closes on both sides: no fluid comes in there"
            raise SceneError(place, list(fluid.inlet), f"{remedy}; name edges on the sealed side")


def _closing(stage: Stage, fluid: FluidPressure) -> str | None:
    """Name of the contact that closes a pocket around all open edges of the fluid's inlet in the present state."""
    from ngwear.effects.pockets import contact_pressures, pockets

    names, contacts = stage.body.outline.names, list(stage.contacts.values())
    comes_in = np.isin(names, fluid.inlet) & (contact_pressures(stage.body, contacts).max(axis=0) == 0)
    for pocket in pockets(stage.body, stage.problem.fields[DISPLACEMENT], contacts):
        if comes_in.any() and not comes_in[np.isin(np.arange(len(names)), pocket.edges, invert=True)].any():
            return pocket.contact
    return None


def give_memory(state: State, scene: Scene, arms: PronySeries) -> None:
    """Start the memory of the rubber after refinement, from the mounted part at rest without fluid pressure."""
    from ngwear.fields.background_mesh import Background
    from ngwear.loop.memory_over_cycles import CycleMemory

    (first, *_), phase = scene.program.cycle, state.phases[0]
    body, shares = state.stage.body, state.stage.friction_shares
    field = required_sizes(state.stage, [p.vector for p in state.phases], reach=MAY_COME)
    background = Background(Body(body.contour, field))
    state.stage = stage = Stage(scene, body, background, shares)
    stage.problem.state.vec.FV().NumPy()[:] = phase.vector
    stage.begin(phase.vector)
    stage.problem.set_loads(stage.stroke_loads(first))
    for term in stage.problem.terms:
        term.refresh()
    state.work.add(advance(stage.problem, stage.mounted_loads()))
    durations = [stroke.duration for stroke in scene.program.cycle]
    if stage.memory is not None:
        mounted = stage.memory.stress()
        state.memory = CycleMemory(background, arms, durations, mounted=mounted, rest=scene.program.rest)
