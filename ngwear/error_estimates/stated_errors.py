"""What a run states of its errors: totals, and a warning where one is large."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ngwear.results.quantities_of_interest import AREA, BY_HALVED, DEPTH, PEAK

LARGE = 0.25  # relative error from which a result is not one to decide by


def at_least_by_halved(errors: Mapping[str, float]) -> dict[str, float]:
    """Total errors, each at least its part ``BY_HALVED``; only those that have this part."""
    parts = {name: error for name, error in errors.items() if name.endswith(BY_HALVED)}
    totals = {f"{name.removesuffix(BY_HALVED)}[-]": error for name, error in parts.items()}
    return {name: max(errors.get(name, 0.0), error) for name, error in totals.items()}


def state_errors(summary: dict[str, Any], errors: Mapping[str, float]) -> None:
    """Write the errors into the summary of a run; those of its main results that are large become warnings."""
    summary["error estimates"] = dict(errors)
    for name in (DEPTH, AREA, PEAK):
        if errors.get(name, 0.0) > LARGE:
            says = (
                f"the stated error of the {name[:-4]} is {100 * errors[name]:.0f} %: its mesh or steps are too coarse"
            )
            summary["warnings"].append(f"{says}; take a finer accuracy")
