"""A cost study as a table, one row for each run, and as JSON."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from ngwear.error_estimates.cost_study import Study
from ngwear.error_estimates.cost_text import name_of
from ngwear.error_estimates.ladder import Setting, labels_of
from ngwear.error_estimates.settings_search import Choice


def finite(number: float | None) -> float | None:
    """The number, or None if it is nan or infinite, which JSON does not have."""
    return None if number is None or not math.isfinite(number) else number


def kind_of(study: Study, setting: Setting) -> str:
    """Name of the ladder to which a run belongs; "all" for the base, "combination" for others."""
    changed = [k for k, i in enumerate(setting) if i != study.base[k]]
    if not changed:
        return "all"
    return study.ladders[changed[0]].name if len(changed) == 1 else "combination"


def table(study: Study) -> list[dict[str, Any]]:
    """One row for each run, in their order; columns are named ``"quantity [unit]"``."""
    front, rows = set(study.front()), []
    for setting, run in study.runs.items():
        row: dict[str, Any] = {"ladder [-]": kind_of(study, setting)}
        row |= {ladder.column: ladder.values[i] for ladder, i in zip(study.ladders, setting, strict=True)}
        row |= {
            "status [-]": run.status,
            "reason [-]": "" if run.ok else run.message.replace("\n", " "),
            "CPU time [s]": round(run.cpu, 3),
            "wall time [s]": round(run.wall, 3),
            "peak memory [MB]": round(run.memory, 1),
            "solves [-]": run.solves,
            "on the front [-]": int(setting in front),
        }
        for quantity in study.quantities:
            row[quantity] = run.values.get(quantity, "")
            row[f"error of {name_of(quantity)} [-]"] = _known(study.error(setting, quantity)) if run.ok else ""
            row[f"error of {name_of(quantity)} on its ladder [-]"] = _on_ladder(study, setting, quantity)
        rows.append(row)
    return rows


def _known(error: float | None) -> float | str:
    found = finite(error)
    return "" if found is None else found


def _on_ladder(study: Study, setting: Setting, quantity: str) -> float | str:
    changed = [k for k, i in enumerate(setting) if i != study.base[k]]
    if len(changed) != 1:
        return ""
    k = changed[0]
    return _known(study.level_error(k, setting[k], quantity))


def as_dict(study: Study, choices: Sequence[Choice]) -> dict[str, Any]:
    """Ladders with errors and orders, Pareto front, recommendations, and settings not run; for ``cost.json``."""
    return {
        "main quantity": study.main,
        "spent [s]": round(study.spent, 1),
        "ladders": [_ladder(study, k) for k in range(len(study.ladders))],
        "runs": [_run(study, setting) for setting in study.runs],
        "front": [labels_of(study.ladders, setting) for setting in study.front()],
        "recommended": [_choice(study, choice) for choice in choices],
        "not run": [
            {"setting": labels_of(study.ladders, s), "wall time, predicted [s]": finite(seconds)}
            for s, seconds in study.left_out.items()
        ],
    }


def _ladder(study: Study, k: int) -> dict[str, Any]:
    ladder, levels = study.ladders[k], study.levels(k)
    return {
        "name": ladder.name,
        "column": ladder.column,
        "the scene's": ladder.labels[ladder.own],
        "reference": ladder.labels[max(levels)] if levels else None,
        "errors against the reference [-]": {
            quantity: {ladder.labels[i]: finite(study.level_error(k, i, quantity)) for i in levels}
            for quantity in study.quantities
        },
        "estimated error of the reference [-]": {q: finite(study.own_error(k, q)) for q in study.quantities},
        "observed order [-]": {quantity: study.order(k, quantity) for quantity in study.quantities},
    }


def _run(study: Study, setting: Setting) -> dict[str, Any]:
    run = study.runs[setting]
    return {
        "ladder": kind_of(study, setting),
        "setting": labels_of(study.ladders, setting),
        "status": run.status,
        "message": run.message,
        "CPU time [s]": round(run.cpu, 3),
        "wall time [s]": round(run.wall, 3),
        "peak memory [MB]": round(run.memory, 1),
        "solves": run.solves,
        "values": dict(run.values),
        "errors [-]": {q: finite(study.error(setting, q)) for q in study.quantities} if run.ok else {},
    }


def _choice(study: Study, choice: Choice) -> dict[str, Any]:
    if choice.setting is None:
        return {"target [-]": choice.target, "setting": None, "answer": "not reached within the budget"}
    error = study.error if choice.measured else study.predicted_error
    return {
        "target [-]": choice.target,
        "setting": labels_of(study.ladders, choice.setting),
        "values": {ladder.column: ladder.values[i] for ladder, i in zip(study.ladders, choice.setting, strict=True)},
        "answer": "measured" if choice.measured else "predicted from the ladders, not run",
        "CPU time [s]": round(study.seconds(choice.setting), 3),
        "errors [-]": {quantity: finite(error(choice.setting, quantity)) for quantity in study.quantities},
    }
