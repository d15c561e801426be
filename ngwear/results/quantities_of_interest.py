"""Quantities of interest of a run, by the names of their errors; runs are compared by them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ngwear.results.recorder import EDGE, LEAK, WITHOUT_STEPS
from ngwear.scene.program import whole_name

Rows = list[dict[str, Any]]

DEPTH, AREA, LOST = "maximum depth [-]", "worn area [-]", "area lost in all [-]"
PEAK, WIDTH, FRICTION = "peak pressure [-]", "contact width [-]", "friction force [-]"
LEAKS = "leak pressure [-]"  # only if the scene asks for it
RUN_COLUMNS = {
    DEPTH: "maximum depth [mm]",
    AREA: "area removed from the outline [mm^2]",
    LOST: "area lost in all [mm^2]",  # only if elements are deactivated
}
DEPTH_BY_MESH = "maximum depth by mesh [-]"  # of the depth without the error that the wear steps state
STROKE_ERRORS = {"peak pressure": PEAK, "contact width": WIDTH, "friction force": FRICTION}
BY_TIME_STEP = "by the time step [-]"  # ending of a name: part of the error of a quantity
BY_HALVED = "by halved elements [-]"  # the same: what elements of half the edges say of the mesh alone
BY_FRICTION = "by friction left out [-]"  # the same: what friction would change that the part does not bear
BY_FLUID = "by fluid let in [-]"  # the same: what a fluid would change that a contact just holds
APART = (BY_FRICTION, BY_FLUID)  # parts that are added, and for which no finer level is chosen
# The last half of the run was chosen on the filled seal (``verify error_estimates``); 17 strokes average out scatter.
PLACES = 17  # number of strokes in the last half of the run at which histories are compared


def quantities(rows: Rows) -> dict[str, dict[str, list[float]]]:
    """Histories over the last half of a run, by name of the error and name of the quantity.

    Each history has ``PLACES`` values, interpolated between solved strokes; solves without wear are not used. For a
    stroke in parts it is the mean over the parts. The friction force of a step belongs to the middle of the step.
    """
    solved = _solved(rows)
    parts = {part: [row for row in solved if row["kind [-]"] == part] for part in dict.fromkeys(map(_part, solved))}
    steps = parts[_part(solved[-1])]  # where all strokes of a step have worn
    places = _places(solved)

    def history(column: str, of: Rows) -> Any:
        return np.interp(places, [row["stroke [-]"] for row in of], [row[column] for row in of])

    columns = {error: column for error, column in RUN_COLUMNS.items() if column in steps[-1]}
    out = {error: {column: history(column, steps).tolist()} for error, column in columns.items()}
    for kind in dict.fromkeys(map(whole_name, parts)):
        mine = [of for part, of in parts.items() if whole_name(part) == kind]
        for error, column in _of_stroke(mine[-1][-1]):
            mean = np.mean([history(column, of) for of in mine], axis=0)
            out.setdefault(error, {})[f"{kind}: {column}"] = mean.tolist()
    return out


def compared(rows: Rows) -> dict[str, dict[str, list[float]]]:
    """As ``quantities``, by which a run is compared with coarser ones, and the depth by the mesh alone."""
    solved = _solved(rows)
    steps = [row for row in solved if _part(row) == _part(solved[-1])]
    depth = np.interp(_places(solved), [row["stroke [-]"] for row in steps], [row[WITHOUT_STEPS] for row in steps])
    return quantities(rows) | {DEPTH_BY_MESH: {WITHOUT_STEPS: depth.tolist()}}


def element_edge(rows: Rows) -> float:
    """Mean element edge in contact over the last half of a run [mm]; 0 without contact."""
    late = [row for row in rows if row["stroke [-]"] >= 0.5 * rows[-1]["stroke [-]"]]
    edges = [row[column] for row in late for column in row if column.endswith(EDGE) and row[column] > 0]
    return float(np.mean(edges)) if edges else 0.0


def _solved(rows: Rows) -> Rows:
    return [row for row in rows if row["strokes in one solve [-]"] > 0 or row["stroke [-]"] == 0]


def _places(solved: Rows) -> Any:
    """Numbers of strokes at which histories are read."""
    return np.linspace(0.5, 1.0, PLACES) * solved[-1]["stroke [-]"]


def _of_stroke(row: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Name of the error, and column, of each quantity of a single stroke."""
    for words, error in STROKE_ERRORS.items():
        yield from ((error, c) for c in row if f" {words} " in c and not c.endswith("[-]"))
    if LEAK in row:
        yield LEAKS, LEAK


def _part(row: dict[str, Any]) -> str:
    return row["kind [-]"]
