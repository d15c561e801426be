"""A cost study as one paragraph of text."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from ngwear.error_estimates.convergence_order import relative
from ngwear.error_estimates.cost_study import Study
from ngwear.error_estimates.ladder import STOPPED, Ladder, Measurement, Setting
from ngwear.error_estimates.settings_search import Choice


def name_of(quantity: str) -> str:
    """Name of a quantity without its unit."""
    return quantity.split(" [")[0]


def per_cent(error: float) -> str:
    """An error in per cent, with two digits."""
    return f"{100 * error:.2g} %"


def setting_in_words(study: Study, setting: Setting) -> str:
    """A setting as text, such as ``element edge 0.05 mm, stress_error 0.1``."""
    return ", ".join(_labelled(ladder, i) for ladder, i in zip(study.ladders, setting, strict=True))


def change_in_words(study: Study, setting: Setting) -> str:
    """Changes of the scene by a setting, as text."""
    own = study.own
    changed = [k for k, i in enumerate(setting) if i != own[k]]
    if not changed:
        return "the scene as given"
    words = [_labelled(study.ladders[k], setting[k]) for k in changed]
    return ", ".join(words) + ("" if len(changed) == len(own) else ", the rest as given")


def _labelled(ladder: Ladder, level: int) -> str:
    """A value of a parameter as text, such as ``element edge 0.05 mm`` or ``stress_error 0.1``."""
    label = ladder.labels[level]
    return f"{ladder.name} {label}" if label[0].isdigit() and "arm" not in label else label


def paragraph(scene: str, study: Study, choices: Sequence[Choice], budget: float) -> str:
    """Results of the study as text."""
    runs = list(study.runs.values())
    done = sum(run.ok for run in runs)
    parts = [f"{scene}: {done} run{'' if done == 1 else 's'} took {study.spent:.0f} s of the {budget:g} s given."]
    parts.append(_own(study))
    if study.base != study.own and any(len(study.levels(k)) > 1 for k in range(1, len(study.ladders))):
        parts.append(
            f"To save time the other parameters were varied with {_labelled(study.ladders[0], study.base[0])}."
        )
    parts.append(_together(study))
    parts += _choices(study, choices)
    parts += _not_run(study)
    parts += _failed(study)
    return " ".join(part for part in parts if part)


def _own(study: Study) -> str:
    own, quantity = study.own, study.main
    run = study.runs.get(own)
    if run is None:
        seconds = study.left_out.get(own, math.nan)
        return "The scene as given was not run" + (
            f": it would take about {seconds:.0f} s." if seconds == seconds else "."
        )
    if not run.ok:
        return "The scene as given was not completed."
    text = f"As given ({setting_in_words(study, own)}) the scene takes {run.cpu:.3g} s of processor time"
    text += f" and gives a {name_of(quantity)} of {_valued(run, quantity)}"
    error = study.error(own, quantity)
    if not math.isfinite(error):
        lone = [
            ladder.name for k, ladder in enumerate(study.ladders) if not math.isfinite(study.part(k, own[k], quantity))
        ]
        return f"{text}; its error is not known, because no runs differ in {' or '.join(lone)}."
    text += f", with an error of about {per_cent(error)}"
    shares = {ladder.name: study.part(k, own[k], quantity) for k, ladder in enumerate(study.ladders)}
    if len(shares) > 1:
        ranked = sorted(shares, key=lambda name: -shares[name])
        text += ": " + ", ".join(f"{per_cent(shares[name])} by the {name}" for name in ranked)
    return f"{text}.{_others(study, own)}"


def _together(study: Study) -> str:
    """Whether the effects of the parameters add up, if that was tried."""
    run, quantity = study.runs.get(study.finest), study.main
    if run is None or not run.ok or study.finest == study.base:
        return ""
    off = per_cent(relative(study.added(quantity), run.values[quantity]))
    return (
        f"With all parameters at their finest the run gives {_valued(run, quantity)}; the sum of the single effects "
        f"agrees within {off}."
    )


def _valued(run: Measurement, quantity: str) -> str:
    """Value of a quantity with its unit."""
    return f"{run.values[quantity]:.4g} {quantity.rsplit('[', 1)[1].rstrip(']')}"


def _others(study: Study, setting: Setting) -> str:
    """Errors of other quantities of a run, if they are larger than that of the main one."""
    main = study.error(setting, study.main)
    errors = {q: study.error(setting, q) for q in study.quantities[1:]}
    worse = {q: e for q, e in errors.items() if math.isfinite(e) and e > max(2 * main, 1e-3)}  # what a user should know
    if not worse:
        return ""
    return " The error of the " + ", of the ".join(f"{name_of(q)} is {per_cent(e)}" for q, e in worse.items()) + "."


def _choices(study: Study, choices: Sequence[Choice]) -> list[str]:
    out = []
    for (setting, measured), alike in itertools.groupby(choices, key=lambda c: (c.setting, c.measured)):
        *first, last = (f"{100 * choice.target:g} %" for choice in alike)
        goals = f"{', '.join(first)} and {last}" if first else last
        goal = f"For {goals} of the {name_of(study.main)}"
        if setting is None:
            out.append(f"{goal}: not reached within the budget{_least(study)}.")
            continue
        words = change_in_words(study, setting)
        if measured:
            found = f"{study.runs[setting].cpu:.3g} s, error {per_cent(study.error(setting, study.main))}"
            out.append(f"{goal}: {words} ({found}).{_others(study, setting)}")
        else:
            seconds, error = study.seconds(setting), study.predicted_error(setting, study.main)
            out.append(
                f"{goal}: {words}, predicted {seconds:.3g} s and an error of {per_cent(error)}; there was no time left "
                "to run it."
            )
    return out


def _least(study: Study) -> str:
    front = study.front()
    return f"; the smallest error of a run is {per_cent(study.error(front[-1], study.main))}" if front else ""


def _differs(study: Study, setting: Setting) -> str:
    """The change of the base setting by a run, as text."""
    changed = [k for k, i in enumerate(setting) if i != study.base[k]]
    if len(changed) != 1:
        return setting_in_words(study, setting)
    return _labelled(study.ladders[changed[0]], setting[changed[0]])


def _not_run(study: Study) -> list[str]:
    if not study.left_out:
        return []
    missing = [
        f"{_differs(study, setting)} ({'takes longer' if math.isnan(seconds) else f'about {seconds:.0f} s'})"
        for setting, seconds in study.left_out.items()
    ]
    return [f"No time was left for {', '.join(missing)}."]


def _failed(study: Study) -> list[str]:
    failed: dict[str, list[Setting]] = {}
    for setting, run in study.runs.items():
        if not run.ok and run.status != STOPPED:
            failed.setdefault(run.message.splitlines()[0], []).append(setting)
    return [f"With {_alike(study, settings)} it gave up: {reason}." for reason, settings in failed.items()]


def _alike(study: Study, settings: Sequence[Setting]) -> str:
    """Settings by their common change of the base setting; without one, each by its own change."""
    first, *others = settings
    common = [k for k, i in enumerate(first) if i != study.base[k] and all(s[k] == i for s in others)]
    if others and common:
        words = " and ".join(_labelled(study.ladders[k], first[k]) for k in common)
        return f"{words}, in {len(settings)} settings,"
    return ", and with ".join(_differs(study, setting) for setting in settings)
