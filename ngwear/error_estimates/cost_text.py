"""A study in one paragraph."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from ngwear.error_estimates.convergence_order import relative
from ngwear.error_estimates.cost_study import Study
from ngwear.error_estimates.ladder import STOPPED, Ladder, Measurement, Setting
from ngwear.error_estimates.settings_search import Choice


def name_of(quantity: str) -> str:
    """Without the unit."""
    return quantity.split(" [")[0]


def per_cent(error: float) -> str:
    """Two digits."""
    return f"{100 * error:.2g} %"


def setting_in_words(study: Study, setting: Setting) -> str:
    """Such as ``element edge 0.05 mm, stress_error 0.1``."""
    return ", ".join(_labelled(ladder, i) for ladder, i in zip(study.ladders, setting, strict=True))


def change_in_words(study: Study, setting: Setting) -> str:
    """A setting by what it changes in the scene."""
    own = study.own
    changed = [k for k, i in enumerate(setting) if i != own[k]]
    if not changed:
        return "the scene as it stands"
    words = [_labelled(study.ladders[k], setting[k]) for k in changed]
    return ", ".join(words) + ("" if len(changed) == len(own) else ", the rest as it stands")


def _labelled(ladder: Ladder, rung: int) -> str:
    """Such as ``element edge 0.05 mm`` or ``stress_error 0.1``."""
    label = ladder.labels[rung]
    return f"{ladder.name} {label}" if label[0].isdigit() and "arm" not in label else label


def paragraph(scene: str, study: Study, choices: Sequence[Choice], budget: float) -> str:
    """What the study has found, in plain words."""
    runs = list(study.runs.values())
    done = sum(run.ok for run in runs)
    parts = [f"{scene}: {done} run{'' if done == 1 else 's'} took {study.spent:.0f} s of the {budget:g} s given."]
    parts.append(_own(study))
    if study.base != study.own and any(len(study.rungs(k)) > 1 for k in range(1, len(study.ladders))):
        parts.append(f"To save time the other knobs were tried with {_labelled(study.ladders[0], study.base[0])}.")
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
        return "The scene as it stands was not run" + (
            f": it would take about {seconds:.0f} s." if seconds == seconds else "."
        )
    if not run.ok:
        return "The scene as it stands did not reach its end."
    text = f"As the scene stands ({setting_in_words(study, own)}) it takes {run.cpu:.3g} s of processor time"
    text += f" and finds a {name_of(quantity)} of {_valued(run, quantity)}"
    error = study.error(own, quantity)
    if not math.isfinite(error):
        lone = [
            ladder.name for k, ladder in enumerate(study.ladders) if not math.isfinite(study.part(k, own[k], quantity))
        ]
        return f"{text}; how far that is off is not known, for want of runs that differ in {' or '.join(lone)}."
    text += f", off by about {per_cent(error)}"
    shares = {ladder.name: study.part(k, own[k], quantity) for k, ladder in enumerate(study.ladders)}
    if len(shares) > 1:
        ranked = sorted(shares, key=lambda name: -shares[name])
        text += ": " + ", ".join(f"{per_cent(shares[name])} by the {name}" for name in ranked)
    return f"{text}.{_others(study, own)}"


def _together(study: Study) -> str:
    """Whether the errors of the knobs add up, where that was tried."""
    run, quantity = study.runs.get(study.finest), study.main
    if run is None or not run.ok or study.finest == study.base:
        return ""
    off = per_cent(relative(study.added(quantity), run.values[quantity]))
    return (
        f"All knobs at their finest together find {_valued(run, quantity)}; single effects add up to that within {off}."
    )


def _valued(run: Measurement, quantity: str) -> str:
    """With its unit."""
    return f"{run.values[quantity]:.4g} {quantity.rsplit('[', 1)[1].rstrip(']')}"


def _others(study: Study, setting: Setting) -> str:
    """What else a user reads of this run is off by, if it is more than the main quantity."""
    main = study.error(setting, study.main)
    errors = {q: study.error(setting, q) for q in study.quantities[1:]}
    worse = {q: e for q, e in errors.items() if math.isfinite(e) and e > max(2 * main, 1e-3)}  # what a user should know
    if not worse:
        return ""
    return " There the " + ", the ".join(f"{name_of(q)} is off by {per_cent(e)}" for q, e in worse.items()) + "."


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
                f"{goal}: {words}, by the ladders {seconds:.3g} s and an error of {per_cent(error)}; there was no "
                "time left to run it."
            )
    return out


def _least(study: Study) -> str:
    front = study.front()
    return f"; the least error of a run is {per_cent(study.error(front[-1], study.main))}" if front else ""


def _differs(study: Study, setting: Setting) -> str:
    """A run on a ladder by what it changes in the base."""
    changed = [k for k, i in enumerate(setting) if i != study.base[k]]
    if len(changed) != 1:
        return setting_in_words(study, setting)
    return _labelled(study.ladders[changed[0]], setting[changed[0]])


def _not_run(study: Study) -> list[str]:
    if not study.left_out:
        return []
    told_ones = [
        f"{_differs(study, setting)} ({'takes longer' if math.isnan(seconds) else f'about {seconds:.0f} s'})"
        for setting, seconds in study.left_out.items()
    ]
    return [f"No time was left for {', '.join(told_ones)}."]


def _failed(study: Study) -> list[str]:
    failed: dict[str, list[Setting]] = {}
    for setting, run in study.runs.items():
        if not run.ok and run.status != STOPPED:
            failed.setdefault(run.message.splitlines()[0], []).append(setting)
    return [f"With {_alike(study, settings)} it gave up: {reason}." for reason, settings in failed.items()]


def _alike(study: Study, settings: Sequence[Setting]) -> str:
    """Settings by what all of them change in the base, else each by what it changes."""
    first, *others = settings
    common = [k for k, i in enumerate(first) if i != study.base[k] and all(s[k] == i for s in others)]
    if others and common:
        words = " and ".join(_labelled(study.ladders[k], first[k]) for k in common)
        return f"{words}, in {len(settings)} settings,"
    return ", and with ".join(_differs(study, setting) for setting in settings)
