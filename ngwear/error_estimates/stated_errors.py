"""What a run states of its errors: totals, and a warning where one is large."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ngwear.results.quantities_of_interest import APART, AREA, BY_FLUID, BY_FRICTION, BY_HALVED, DEPTH, PEAK

LARGE = 0.25  # relative error from which a result is not one to decide by
COARSE = "its mesh or steps are too coarse; take a finer accuracy"
BECAUSE = {
    BY_FRICTION: "most of it is by the friction that the part does not bear; lower the friction",
    BY_FLUID: "most of it is by the fluid that a contact just holds; take a finer accuracy, or more squeeze there",
}


def with_parts(errors: Mapping[str, float]) -> dict[str, float]:
    """Total errors that have parts: each at least its part ``BY_HALVED``, and with its parts that stand ``APART``."""
    out: dict[str, float] = {}
    for part in (BY_HALVED, *APART):
        for name in (name for name in errors if name.endswith(part)):
            total = f"{name.removesuffix(part)}[-]"
            known = out.get(total, errors.get(total, 0.0))
            out[total] = max(known, errors[name]) if part == BY_HALVED else known + errors[name]
    return out


def state_errors(summary: dict[str, Any], errors: Mapping[str, float]) -> None:
    """Write the errors into the summary of a run; those of its main results that are large become warnings."""
    summary["error estimates"] = dict(errors)
    for name in (DEPTH, AREA, PEAK):
        error = errors.get(name, 0.0)
        if error > LARGE:
            parts = {part: errors.get(f"{name[:-4]} {part}", 0.0) for part in APART}
            why = next((BECAUSE[part] for part, of in parts.items() if of > 0.5 * error), COARSE)
            summary["warnings"].append(f"the stated error of the {name[:-4]} is {100 * error:.0f} %: {why}")
