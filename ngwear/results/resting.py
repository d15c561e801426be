"""Where a part with room to move rests, when it moves over, and when it does not come back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ngwear.scene.holding import free_directions
from ngwear.scene.scene import Scene

Array = NDArray[np.float64]
Row = dict[str, Any]  # of the series

STROKE, TURNED = "stroke [-]", "section turned by [deg]"
NOTHING = "nothing"
PUSHES = 1e-6  # of the largest force: less is none
# Listed as tuned in tests/benchmarks/README.md: degrees, and radians per depth over the section's size.
TURNS, PER_DEPTH = 2.0, 10.0


def resting(scene: Scene, forces: Mapping[str, Array], turned: float) -> Row:
    """Columns of the series: the contact that pushes the part most along each free axis, and the section's angle."""
    free = free_directions(scene)
    row: Row = {_column(axis): _rests_on(scene, forces, axis) for axis in free}
    return row | {TURNED: turned} if free else row


def rests(scene: Scene, rows: Sequence[Row]) -> Row:
    """Entries of the summary: where it rests in each kind of stroke, and which stroke moves it over first."""
    out: Row = {}
    for axis in free_directions(scene) if rows else ():
        column = _column(axis)
        for stroke in scene.program.cycle:
            mine = [row for row in rows if row["kind [-]"] == stroke.name]
            out[f"{stroke.name}, {column[:-4]}"] = mine[-1][column]
        moves = [b[STROKE] for a, b in pairwise(rows) if a[column] != b[column]]
        out[f"first stroke that moves the part along {'xy'[axis]}"] = moves[0] if moves else None
    return out


def elsewhere(scene: Scene, rows: Sequence[Row]) -> list[str]:
    """Warnings of strokes that find the part at another wall, or turned, though only little wear lies between.

    One for each kind of stroke: of the step with the largest turn beyond what its wear explains, else of the first that
    finds it at another wall.
    """
    found = []
    for stroke in scene.program.cycle:
        mine = [row for row in rows if row["kind [-]"] == stroke.name and TURNED in row]
        steps = sorted(pairwise(mine), key=lambda step: _unexplained(scene, *step), reverse=True)
        moved = [step for step in steps if _unexplained(scene, *step) > 0.0]
        moved += [step for step in pairwise(mine) if _walls(scene, *step)]
        for before, after in moved[:1]:
            ways = [f"moves from {there} to {here}" for there, here in _walls(scene, before, after)]
            turn = abs(after[TURNED] - before[TURNED])
            ways += [f"turns by {turn:.2g} degrees"] if turn > TURNS else []
            between = f"from stroke {before[STROKE]} to {after[STROKE]}"
            found.append(
                f"stroke '{stroke.name}': {between} the part {' and '.join(ways)}, which so little wear "
                "does not explain: it creeps, or has snapped to another equilibrium; the wear before and after belongs "
                "to different states: hold the part, give it less room, or compare with a finer accuracy"
            )
    return found


def _unexplained(scene: Scene, before: Row, after: Row) -> float:
    """Degrees by which the part turns in a step beyond ``TURNS``, and beyond what the depth worn in it may turn it."""
    size = float(np.ptp(scene.part.outline.points, axis=0).max())
    worn = max(0.0, after["maximum depth [mm]"] - before["maximum depth [mm]"])
    return float(abs(after[TURNED] - before[TURNED]) - TURNS - np.degrees(PER_DEPTH * worn / size))


def _walls(scene: Scene, before: Row, after: Row) -> list[tuple[str, str]]:
    """Contacts on which the part rests in two rows, along each axis along which they differ."""
    pairs = [(before[_column(axis)], after[_column(axis)]) for axis in free_directions(scene)]
    return [(f"'{there}'", f"'{here}'") for there, here in pairs if there != here and NOTHING not in (there, here)]


def _column(axis: int) -> str:
    return f"rests along {'xy'[axis]} on [-]"


def _rests_on(scene: Scene, forces: Mapping[str, Array], axis: int) -> str:
    """Name of the contact whose pressure pushes the part most along an axis; "nothing" if none does."""
    push = {contact.name: abs(float(forces[contact.name][axis])) for contact in scene.contacts}
    name = max(push, key=lambda contact: push[contact])
    least = PUSHES * max(float(np.abs(force).max()) for force in forces.values())
    return name if push[name] > least else NOTHING
