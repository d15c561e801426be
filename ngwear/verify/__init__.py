"""Reference cases, one a file: each module's ``run()`` returns its checks, or yields them as they are made.

A case's module docstring states the problem, the reference with its source, and the units. Modules are
imported when they are run; listing the cases loads no solver.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib import import_module
from pathlib import Path

from ngwear.errors import SceneError
from ngwear.verify.base import Check

CASES: dict[str, str] = {
    "tangents": "ngwear.verify.tangents",
    "convergence": "ngwear.verify.convergence",
    "locking": "ngwear.verify.locking",
    "memory": "ngwear.verify.memory",
    "remeshed_memory": "ngwear.verify.remeshed_memory",
    "stroke_memory": "ngwear.verify.stroke_memory",
    "hertz": "ngwear.verify.hertz",
    "hunter": "ngwear.verify.hunter",
    "hunter_transient": "ngwear.verify.hunter_transient",
    "three_arms": "ngwear.verify.three_arms",
    "p1a": "ngwear.verify.p1a",
    "partial_slip": "ngwear.verify.partial_slip",
    "partial_slip_wear": "ngwear.verify.partial_slip_wear",
    "indentation": "ngwear.verify.indentation",
    "pin_on_plate": "ngwear.verify.pin_on_plate",
    "ring": "ngwear.verify.ring",
    "leak_pressure": "ngwear.verify.leak_pressure",
    "block_on_ring": "ngwear.verify.block_on_ring",
    "worn_cylinder": "ngwear.verify.worn_cylinder",
    "fretting": "ngwear.verify.fretting",
    "measured_profile": "ngwear.verify.measured_profile",
    "stability_pair": "ngwear.verify.stability_pair",
    "wear_laws": "ngwear.verify.wear_laws",
    "notched_strip": "ngwear.verify.notched_strip",
    "lost_elements": "ngwear.verify.lost_elements",
    "tearing_off": "ngwear.verify.no_loss",
    "material_book": "ngwear.verify.material_book",
    "torn_seal": "ngwear.verify.torn_seal",
    "lubrication": "ngwear.verify.lubrication",
    "sliding_roller": "ngwear.verify.sliding_roller",
    "shaft_on_plate": "ngwear.verify.shaft_on_plate",
    "rod_seal": "ngwear.verify.rod_seal",
    "rod_seal_jumps": "ngwear.verify.rod_seal_jumps",
    "error_estimates": "ngwear.verify.error_estimates",
    "rod_seal_filled": "ngwear.verify.rod_seal_filled",
}

RESUMED = ("torn_seal",)  # with runs of a quarter of an hour and more

__all__ = ["CASES", "Check", "checks_of", "chosen", "verify"]


def verify(names: Iterable[str] | None = None) -> list[Check]:
    """Run the named cases, or all of them, and return their checks.

    Raises
    ------
    SceneError
        For a name that is no case.
    """
    return [check for name in chosen(names) for check in checks_of(name)]


def chosen(names: Iterable[str] | None = None) -> list[str]:
    """Return the named cases, or all of them; errors as ``verify``."""
    out = list(CASES) if names is None else list(names)
    for name in out:
        if name not in CASES:
            raise SceneError("verify", name, f"no such case; known: {', '.join(CASES)}")
    return out


def checks_of(name: str, folder: Path | None = None) -> Iterator[Check]:
    """Run a case; yield its checks as they are made. With a folder a case that takes hours goes on with what is there.

    Errors as ``run``, if the folder cannot be used.
    """
    run = import_module(CASES[name]).run
    yield from run(folder / name) if folder is not None and name in RESUMED else run()
