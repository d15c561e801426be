"""The description of ``explain`` as text."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from typing import Any

WIDTH = 118  # characters: a terminal of 120
BROUGHT = ("unknowns", "matrix entries", "memory [MB]")
MATTERS = {True: "matters", False: "does not matter", None: "cannot be judged from the scene"}


def lines(found: Mapping[str, Any]) -> Iterator[str]:
    """Lines of a description: each effect with its cost, each neglected effect with its verdict and numbers."""
    for name, value in found.items():
        if name in BROUGHT:
            continue
        if name == "effects":
            yield "effects, and the cost of each on the first mesh (without the factors of the matrix):"
            for effect, words in value.items():
                yield from _wrapped(f"{effect}: {words}", 2)
                yield f"      {_brought(found, effect)}"
        elif name == "absent":
            yield "whether neglected effects matter:"
            for effect, verdict in value.items():
                yield from _wrapped(f"{effect} {MATTERS[verdict['matters']]}: {verdict['verdict']}", 2)
                yield from (f"      {_row(n, v)}" for n, v in verdict.items() if n not in ("verdict", "matters"))
        elif isinstance(value, dict):
            yield f"{name}:"
            yield from (f"  {_row(key, item)}" for key, item in value.items())
        else:
            yield from _wrapped(f"{name}: {', '.join(value) if isinstance(value, list) else value}", 0)


def _brought(found: Mapping[str, Any], effect: str) -> str:
    unknowns, entries, memory = (found[key].get(effect, 0) for key in BROUGHT)
    if not unknowns and not memory:
        return "no unknown, no memory"
    parts = [f"{unknowns} unknowns, {entries} matrix entries" if unknowns else "no unknown"]
    return ", ".join([*parts, f"{memory:.3g} MB"])


def _row(name: str, value: Any) -> str:
    return f"{name:70s} {value:.4g}" if isinstance(value, float) else f"{name:70s} {value}"


def _wrapped(text: str, indent: int) -> list[str]:
    return textwrap.wrap(text, WIDTH, initial_indent=" " * indent, subsequent_indent=" " * (indent + 4))
