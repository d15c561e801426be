"""The table at the end of a run: quantities with their errors, and cost of the run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

SAME_ERROR = {
    "worn volume": "worn area",
    "penetration": "maximum depth",
}  # quantities with the same relative error as another one
# Its error is relative to the highest one; that of a stroke is shown relative to its own.
PEAK = "peak pressure [MPa]"
TOOK = ("solves", "retries", "remeshes", "elements", "wall time [s]", "CPU time [s]", "peak memory [MB]")
NOT_FOUND = {
    "strokes",
    "Newton iterations",
    "unknowns",
    "element edge in the contact [mm]",
    "error asked for [-]",
    "peak error asked for [-]",
    "CPU time of all levels [s]",
    *TOOK,
}


def closing_table(summary: Mapping[str, Any]) -> str:
    """A summary as text: name with unit, value, and estimated relative error if there is one.

    Parameters
    ----------
    summary : mapping
        Contents of ``summary.json``.
    """
    return "\n".join(_lines(summary))


def _lines(summary: Mapping[str, Any]) -> Iterator[str]:
    strokes = f" after {summary['strokes']:g} strokes" if summary.get("strokes") else ""
    yield f"{summary['scene']}: {summary['status']}{strokes} ({summary['message']})"
    errors = summary.get("error estimates", {})
    for name, value in summary.items():
        if isinstance(value, int | float) and name not in NOT_FOUND and " of the " not in name:
            error = _error(name.split(" [")[0], errors)
            if error is not None and name.endswith(PEAK) and value > 0:
                error *= max(1.0, summary[PEAK] / value)
            yield f"  {name:50s} {value:<12.6g}" + ("" if error is None else f" ± {100 * error:.2g} %")
    for name, value in errors.items():
        quantity = name.removesuffix(" [-]")
        if name.endswith(("width [-]", "force [-]")):
            yield f"  {quantity:50s} {'':12s} ± {100 * value:.2g} %"
    took = [f"{name.split(' [')[0]} {summary[name]:g}{_unit(name)}" for name in TOOK if name in summary]
    if took:
        yield f"  {', '.join(took)}"
    yield from (f"  warning: {warning}" for warning in summary.get("warnings", ()))


def _error(quantity: str, errors: Mapping[str, float]) -> float | None:
    """The error of a quantity, or of its kind, such as of a peak pressure in one stroke."""
    if quantity.startswith("first"):
        return None
    for error, value in errors.items():
        whole = error.removesuffix(" [-]")
        kinds = [whole, *(other for other, same in SAME_ERROR.items() if same == whole)]
        if any(quantity == kind or quantity.endswith(f" {kind}") for kind in kinds):
            return value
    return None


def _unit(name: str) -> str:
    return f" {name.removesuffix(']').rpartition(' [')[2]}" if name.endswith("]") else ""
