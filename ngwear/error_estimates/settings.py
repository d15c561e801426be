"""Parameters of a scene that trade computing time for error, as ladders of values, and the scene at any of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

from ngwear.error_estimates.ladder import Ladder, Setting
from ngwear.materials import Folding
from ngwear.scene.accuracy import ORDERS
from ngwear.scene.checks import why_not_order
from ngwear.scene.pin_scene import PinScene
from ngwear.scene.scene import Scene

# Ladders: factors of 2 where the error falls with the value, wide enough that all three targets may lie in between.
MESH = (4.0, 2.0, 1.0, 0.5, 0.25, 0.125)  # times the scene's element edge
JUMPS = (16.0, 4.0, 1.0, 0.25, 0.0625)  # times its wear_error: the jump changes with the square root
STRESS = (4.0, 2.0, 1.0, 0.5, 0.25)  # times its stress_error
BLOCK = (0.6, 0.8, 1.0, 1.15, 1.4, 2.0)  # times the block's reach, as far as the track leaves room
PARTS = (1, 2, 4, 8)  # of a stroke
FOLDING = (0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6, 0.0)  # each that keeps another arm is a rung
HIGHER_ORDER = 0.25  # of what order 1 differs from order 2 by: order 2 errs less, by 1/4 and 1/200 on seal and shaft
EACH_BEGINS = 0.02  # wear_error from which jumps are coarsened in a scene that solves each stroke: the default
AnyScene = Scene | PinScene


@dataclass(frozen=True)
class Parameter:
    """A ladder, and the function that sets one of its values in a scene."""

    ladder: Ladder
    apply: Callable[[Any, float], Any]


def parameters(scene: AnyScene) -> tuple[Parameter, ...]:
    """Parameters that influence the error of the scene, the mesh first.

    Load increments are not among them. In full sliding the equilibrium does not depend on the load path; with stick and
    slip it hardly does: with increments of a quarter the clamp force of the shipped torn seal is the same to 1e-5
    (``tests/unit/error_estimates/test_cost_runs.py``, slow). Only memory has a time step.
    """
    if isinstance(scene, PinScene):
        return _pin_parameters(scene)
    found = [_mesh(scene)]
    if scene.worn_edges and scene.program.strokes > 2 * len(scene.program.cycle):
        found.append(_jumps(scene))
    if scene.deactivation is None:
        found.append(_stress(scene))
    found += _orders(scene)
    if scene.arms is not None:
        found.append(_time_step(scene))
    if scene.part.prony is not None:
        found += _arms(scene.accuracy.folding_error, lambda tolerance: _foldings_of_wear(scene, tolerance))
    return tuple(found)


def with_setting(scene: AnyScene, varied: Sequence[Parameter], setting: Setting) -> Any:
    """The scene with a setting.

    Raises
    ------
    SceneError
        If the scene cannot have it.
    """
    for parameter, level in zip(varied, setting, strict=True):
        if level != parameter.ladder.own:
            scene = parameter.apply(scene, parameter.ladder.values[level])
    return scene


def changes(scene: AnyScene, other: AnyScene) -> dict[str, Any]:
    """Changes of a scene file that turn one scene into another, by place; empty if they are equal."""
    tables = {"accuracy": "mesh"} if isinstance(scene, PinScene) else {"accuracy": "accuracy", "wear": "wear"}
    found: dict[str, Any] = {}
    for table, attribute in tables.items():
        old, new = getattr(scene, attribute), getattr(other, attribute)
        places = {field.name: getattr(new, field.name) for field in fields(new)}
        found |= {f"{table}.{name}": value for name, value in places.items() if value != getattr(old, name)}
    return found


def _scaled(
    name: str,
    column: str,
    own: float,
    factors: Sequence[float],
    cost_exponent: float,
    *,
    unit: str = "",
    below: float = float("inf"),
    smooth: bool = True,
) -> Ladder:
    """Ladder of multiples of the scene's value."""
    values = [own * factor for factor in factors if factor == 1.0 or own * factor < below]
    return Ladder(
        name=name,
        column=column,
        values=tuple(values),
        labels=tuple(f"{value:.4g}{unit}" for value in values),
        own=values.index(own),
        cost_exponent=cost_exponent,
        smooth=smooth,
    )


def _mesh(scene: Scene) -> Parameter:
    """All element edges times one factor; those of the mounting mesh only as far as necessary."""
    if scene.accuracy.across is not None:
        ladder = _scaled("element edge", "element edge over contact width [-]", 1 / scene.accuracy.across, MESH, 1.2)
        ladder = replace(ladder, labels=tuple(f"{1 / value:.3g} elements across" for value in ladder.values))
        return Parameter(ladder, lambda scene, edge: replace(scene, accuracy=replace(scene.accuracy, across=1 / edge)))
    ladder = _scaled("element edge", "element edge [mm]", scene.accuracy.lengths.patch, MESH, 1.2, unit=" mm")

    def apply(scene: Scene, patch: float) -> Scene:
        old = scene.accuracy.lengths
        coarse, mounting = old.coarse * patch / old.patch, max(old.mounting, patch)
        return replace(scene, accuracy=replace(scene.accuracy, patch=patch, coarse=coarse, mounting=mounting))

    return Parameter(ladder, apply)


def _jumps(scene: Scene) -> Parameter:
    """Tolerances of the cycle jump; the last value solves each stroke."""
    each = scene.wear.step == "each"
    start = EACH_BEGINS if each else scene.accuracy.tolerances.wear_error
    values = [start * factor for factor in JUMPS if start * factor < 1] + [0.0]
    ladder = Ladder(
        name="jumps over strokes",
        column="accuracy.wear_error [-]",
        values=tuple(values),
        labels=(*(f"wear_error {value:.4g}" for value in values[:-1]), "each stroke solved"),
        own=len(values) - 1 if each else values.index(start),
        cost_exponent=0.5,
        most_solves=scene.program.strokes,
    )

    def apply(scene: Scene, error: float) -> Scene:
        if error == 0:
            return replace(scene, wear=replace(scene.wear, step="each"))
        wear = replace(scene.wear, step="jump")
        old = scene.accuracy.tolerances
        depth = old.depth_error if old.depth_error == 1.0 else min(1.0, old.depth_error * error / old.wear_error)
        accuracy = replace(scene.accuracy, wear_error=error, longest_jump=None, depth_error=depth)
        return replace(scene, wear=wear, accuracy=accuracy)

    return Parameter(ladder, apply)


def _stress(scene: Scene) -> Parameter:
    own = scene.accuracy.tolerances.stress_error
    ladder = _scaled("stress criterion", "accuracy.stress_error [-]", own, STRESS, 0.3, below=1.0)
    ladder = replace(ladder, labels=tuple(f"stress_error {label}" for label in ladder.labels))
    return Parameter(ladder, lambda scene, error: replace(scene, accuracy=replace(scene.accuracy, stress_error=error)))


def _orders(scene: Scene) -> list[Parameter]:
    """Element orders, on about the same mesh; the value is one over the order.

    If order m has a stress error of e on a mesh, order k has about e^(k/m): so ``stress_error`` is changed with the
    order. Otherwise order 1 would use a much finer mesh.

    Measured with ``ngwear run`` on the shipped scenes, with ``stress_error`` 0.224, 0.05 and 0.0112 for orders 1, 2 and
    3; errors of maximum depth and peak pressure against order 3. Shaft: 3.7, 4.2 and 6.7 s CPU time; errors of order 1
    0.21 % and 1.1 %, of order 2 0.001 % and 0.01 %. Seal: 21, 30 and 56 s (order 3 with 0.05); errors of order 1 1.1 %
    and 3.1 %, of order 2 0.27 % and 0.3 %. Order 1 locates the ends of a contact only to one element: the contact width
    of the seal has an error of 17 %. At equal error order 2 is the fastest: on the shaft with edges of 0.1 mm the error
    of the depth is 0.02 % in 2.1 s with order 2, and 0.05 % in 2.8 s with order 3.
    """
    orders = [order for order in ORDERS if why_not_order(scene, order) is None]
    if len(orders) < 2:
        return []
    ladder = Ladder(
        name="element order",
        column="one over the element order [-]",
        values=tuple(1 / order for order in orders),
        labels=tuple(f"order {order}" for order in orders),
        own=orders.index(scene.accuracy.order),
        cost_exponent=1.0,
        smooth=False,
        remaining=HIGHER_ORDER,
    )

    def apply(scene: Scene, value: float) -> Scene:
        old, order = scene.accuracy, round(1 / value)
        error = old.tolerances.stress_error ** (order / old.order)
        return replace(scene, accuracy=replace(old, order=order, stress_error=error))

    return [Parameter(ladder, apply)]


def _time_step(scene: Scene) -> Parameter:
    """Parts of a stroke, each with its own solve; the value is one over their number."""
    parts = sorted({*PARTS, scene.accuracy.parts})
    ladder = Ladder(
        name="time step",
        column="time step over stroke [-]",
        values=tuple(1 / n for n in parts),
        labels=tuple(f"{n} part{'' if n == 1 else 's'} a stroke" for n in parts),
        own=parts.index(scene.accuracy.parts),
        cost_exponent=0.9,
        smooth=False,
    )
    return Parameter(ladder, lambda s, step: replace(s, accuracy=replace(s.accuracy, parts=round(1 / step))))


def _refolded(scene: Scene, tolerance: float) -> Scene:
    return replace(scene, accuracy=replace(scene.accuracy, folding_error=tolerance))


def _foldings_of_wear(scene: Scene, tolerance: float) -> list[Folding]:
    folding = _refolded(scene, tolerance).folding
    return [] if folding is None else [folding]


def _arms(own: float, folded: Callable[[float], Sequence[Folding]], *, needed: bool = False) -> list[Parameter]:
    """Values of folding_error that differ in the relaxation times kept, of which at least one if ``needed``."""
    found: dict[tuple[tuple[float, ...], ...], float] = {}
    for tolerance in (own, *FOLDING):
        kept = tuple(f.kept.times for f in folded(tolerance))
        if all(kept) or not needed:
            found.setdefault(kept, tolerance)
    values = sorted(found.values(), reverse=True)
    if len(values) < 2 or own not in values:
        return []
    counts = [max(len(f.kept.times) for f in folded(value)) for value in values]
    labels = [f"{n} arm{'' if n == 1 else 's'}" for n in counts]
    if len(set(labels)) < len(labels):
        labels = [f"{label} (folding_error {value:.4g})" for label, value in zip(labels, values, strict=True)]
    ladder = Ladder(
        name="arms of the memory",
        column="accuracy.folding_error [-]",
        values=tuple(values),
        labels=tuple(labels),
        own=values.index(own),
        cost_exponent=0.05,
        smooth=False,
    )

    def apply(scene: AnyScene, tolerance: float) -> AnyScene:
        if isinstance(scene, PinScene):
            return replace(scene, mesh=replace(scene.mesh, folding_error=tolerance))
        return _refolded(scene, tolerance)

    return [Parameter(ladder, apply)]


def _pin_parameters(scene: PinScene) -> tuple[Parameter, ...]:
    mesh, series = scene.mesh, scene.pin.series

    def edges(scene: PinScene, patch: float) -> PinScene:
        return replace(scene, mesh=replace(scene.mesh, patch=patch, coarse=mesh.coarse * patch / mesh.patch))

    def block(scene: PinScene, shortness: float) -> PinScene:
        reach = 1 / shortness
        return replace(scene, mesh=replace(scene.mesh, reach=reach, beside=mesh.beside * reach / mesh.reach))

    found = [
        Parameter(_scaled("element edge", "element edge [mm]", mesh.patch, MESH[1:-1], 2.0, unit=" mm"), edges),
        Parameter(
            _scaled("column of the memory", "column of the memory [mm]", mesh.column, MESH[1:-1], 0.7, unit=" mm"),
            lambda scene, column: replace(scene, mesh=replace(scene.mesh, column=column)),
        ),
        Parameter(_block_ladder(scene), block),
    ]
    return (*found, *_arms(mesh.folding_error, lambda t: _foldings(scene, series, t), needed=True))


def _foldings(scene: PinScene, series: Any, tolerance: float) -> list[Folding]:
    mesh = replace(scene.mesh, folding_error=tolerance)
    return [mesh.folding(series, speed) for speed in scene.speeds]


def _block_ladder(scene: PinScene) -> Ladder:
    """Half length of the block over the sheet's thickness; the value is one over it, so that it decreases."""
    mesh, room = scene.mesh, scene.pin.track_radius / scene.pin.thickness
    factors = [f for f in BLOCK if f <= 1 or (f * mesh.beside < room and f * mesh.reach < math.pi * room)]
    reaches = [mesh.reach * factor for factor in factors]
    return Ladder(
        name="size of the block",
        column="thickness over the block's reach [-]",
        values=tuple(1 / r for r in reaches),
        labels=tuple(f"reach {r:.3g}" for r in reaches),
        own=factors.index(1.0),
        cost_exponent=0.7,
        smooth=False,
    )
