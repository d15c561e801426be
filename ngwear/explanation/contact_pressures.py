"""Contact pressures of an unworn scene, on a coarse mesh: mounted once, and each kind of stroke solved once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.errors import NgwearError
from ngwear.geometry.body import Body
from ngwear.loop.mounting import MAY_COME, mount, unworn_body
from ngwear.loop.refinement import required_sizes
from ngwear.loop.stage import Stage
from ngwear.scene.contact import Contact
from ngwear.scene.program import Stroke
from ngwear.scene.scene import Scene

Array = NDArray[np.float64]
POINTS = 12  # of the background in each triangle: ``fields.background_mesh.RULE``
# Pressures are wanted to a tenth or so, and in seconds.
COARSER = 4.0  # than the layers of a scene that deactivates elements, which are as fine everywhere


@dataclass(frozen=True)
class Strip:
    """One connected contact zone in one stroke.

    Attributes
    ----------
    contact : Contact
    stroke : Stroke
    load : float
        Normal force per length normal to the section [N/mm].
    width : float
        Width along the deformed outline [mm].
    peak : float
        Highest Cauchy pressure [MPa].
    place : tuple of float
        Deformed position of its middle [mm].
    """

    contact: Contact
    stroke: Stroke
    load: float
    width: float
    peak: float
    place: tuple[float, float]

    @property
    def pressure(self) -> float:
        """Mean pressure [MPa]."""
        return self.load / self.width


@dataclass(frozen=True)
class Pressing:
    """Contact zones of all kinds of stroke of an unworn scene; ``missing`` is the reason if there are none.

    ``states`` are the equilibria, one for each kind of stroke, on the mounting mesh, which is coarser than that of a
    run: contact widths have an error of up to one element at each end, and peak pressures are too low.
    """

    strips: tuple[Strip, ...] = ()
    missing: str = ""
    states: tuple[Array, ...] = ()


def press(scene: Scene, stage: Stage | None = None, *, on_mount: Callable[[float], None] | None = None) -> Pressing:
    """Mount a scene on its mounting mesh, and solve one stroke of each kind, without memory and wear.

    Parameters
    ----------
    scene : Scene
    stage : Stage or None
        The scene on its mounting mesh, if it exists already; its state is overwritten.
    on_mount : callable or None
        Called with the completed fraction.
    """
    report = on_mount or (lambda fraction: None)
    try:
        if scene.deactivation is not None:
            scene, stage = _plain(scene), None
        stage = stage or Stage(scene, unworn_body(scene))
        mount(stage, report)
        vector = stage.problem.state.vec.FV().NumPy()
        strips, states, kinds = [], [], _kinds(scene)
        for i, stroke in enumerate(kinds):
            stage.begin(vector)
            for friction in stage.frictions.values():
                friction.coefficient.set_state(0.0, stroke.speed)
            advance(stage.problem, stage.stroke_loads(stroke), StepOptions(first=0.125))
            states.append(vector.copy())
            strips += [strip for spec in scene.contacts for strip in _strips(stage, spec, stroke)]
            report(0.7 + 0.3 * (i + 1) / len(kinds))
    except NgwearError as error:
        return Pressing(missing=str(error).partition("\n")[0])
    return Pressing(tuple(strips), states=tuple(states))


def _plain(scene: Scene) -> Scene:
    """The scene without deactivation, on a coarser mesh."""
    lengths = scene.accuracy.lengths
    edge = COARSER * lengths.patch
    mounting, coarse = max(edge, lengths.mounting), max(edge, lengths.coarse)
    accuracy = replace(scene.accuracy, patch=edge, mounting=mounting, coarse=coarse)
    return replace(scene, deactivation=None, accuracy=accuracy)


def _kinds(scene: Scene) -> list[Stroke]:
    """Strokes of the cycle that differ in direction, pressure or speed."""
    found: dict[tuple[float, str, float | None], Stroke] = {}
    for stroke in scene.program.cycle:
        found.setdefault((stroke.direction, repr(stroke.pressure), stroke.speed), stroke)
    return list(found.values())


def _strips(stage: Stage, spec: Contact, stroke: Stroke) -> list[Strip]:
    profile = stage.contacts[spec.name].profile()
    found = []
    for zone in profile.zones():
        load = float(profile.load[zone.nodes].sum())
        middle = 0.5 * (zone.start + zone.end)
        if load > 0 and zone.width > 0:
            found.append(Strip(spec, stroke, load, zone.width, zone.peak, (float(middle[0]), float(middle[1]))))
    return found


def history_points(stage: Stage, states: Sequence[Array]) -> int:
    """Number of material points of a scene's memory, on a mesh for the contacts found here.

    A run has more points if stresses on the finer mesh require it.
    """
    if not states:
        return POINTS * stage.body.mesh.ne
    return POINTS * Body(stage.body.contour, required_sizes(stage, list(states), reach=MAY_COME)).mesh.ne
