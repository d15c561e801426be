"""Reference cases, one a file: each module's ``run()`` returns its checks, or yields them as they are made.

A case's module docstring states the problem, the reference with its source, and the units. Modules are
imported when they are run; listing the cases loads no solver.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import ModuleType

from ngwear.errors import SceneError
from ngwear.verify.base import Check, Checks


@dataclass(frozen=True)
class Case:
    """A reference case, before its module is loaded.

    Parameters
    ----------
    module : str
        Whose ``run()`` makes the checks.
    seconds : float
        Processor time of ``ngwear verify CASE``, all processes, measured on one machine, of the longest to two
        digits [s]; 0 if not measured.
    compares : str
        What with what, in one line.
    quick : bool
        Whether it is one of those that run if no case is named.
    """

    module: str
    seconds: float
    compares: str
    quick: bool = False


CASES: dict[str, Case] = {
    "tangents": Case(
        "ngwear.verify.tangents", 4.5, "every term's tangent with finite differences of its residual", quick=True
    ),
    "convergence": Case(
        "ngwear.verify.convergence",
        12,
        "order of the displacement's error in L2 with theory, orders 1, 2 and 3",
        quick=True,
    ),
    "locking": Case(
        "ngwear.verify.locking", 2.3, "error at K/G = 1e5 with that at 1e2, on triangles and quadrilaterals", quick=True
    ),
    "memory": Case(
        "ngwear.verify.memory", 85, "relaxation, creep and oscillation with 1, 3 and 15 arms with closed forms"
    ),
    "remeshed_memory": Case(
        "ngwear.verify.remeshed_memory", 100, "memory carried through 100 unrelated meshes with a run on one mesh"
    ),
    "stroke_memory": Case(
        "ngwear.verify.stroke_memory", 87, "one solve a stroke with strokes resolved in time, and with jumps"
    ),
    "hertz": Case(
        "ngwear.verify.hertz", 3.9, "a line contact's half width, peak and pressure with Hertz's", quick=True
    ),
    "hunter": Case("ngwear.verify.hunter", 32, "friction of a cylinder on a viscoelastic half-plane with Hunter's"),
    "hunter_transient": Case(
        "ngwear.verify.hunter_transient",
        600,
        "the same slid in time with Hunter's, and its cost with the direct solve's",
    ),
    "three_arms": Case(
        "ngwear.verify.three_arms", 14, "the same with three arms with a boundary solution by Fourier's series"
    ),
    "p1a": Case(
        "ngwear.verify.p1a",
        1.8,
        "a sheet under a roller: force, half width and peak with those of four other programs",
        quick=True,
    ),
    "partial_slip": Case(
        "ngwear.verify.partial_slip",
        11,
        "stick zone and traction of a cylinder pushed and pulled with Cattaneo-Mindlin",
        quick=True,
    ),
    "partial_slip_wear": Case(
        "ngwear.verify.partial_slip_wear", 700, "wear of a contact that sticks in its middle with closed forms"
    ),
    "indentation": Case(
        "ngwear.verify.indentation", 59, "a ball 40 % deep in a sheet, 3D, with an independent solution on tetrahedra"
    ),
    "pin_on_plate": Case(
        "ngwear.verify.pin_on_plate", 650, "the shipped pin on a plate at seven speeds with what its source describes"
    ),
    "ring": Case(
        "ngwear.verify.ring", 1.4, "a thick-walled ring on a rod and under pressure with closed forms", quick=True
    ),
    "leak_pressure": Case(
        "ngwear.verify.leak_pressure",
        1.5,
        "what a squeezed block holds of a fluid with the squeeze's pressure",
        quick=True,
    ),
    "confined_ring": Case(
        "ngwear.verify.confined_ring", 10, "a ring in a closed groove: its own pressure and the fluid's"
    ),
    "extrusion_gap": Case(
        "ngwear.verify.extrusion_gap",
        2.5,
        "a block that comes into a gap with a row of cracks in closed form",
        quick=True,
    ),
    "o_ring_squeeze": Case("ngwear.verify.o_ring_squeeze", 8, "an O-ring between two plates with Lindley's formula"),
    "rolling_ring": Case(
        "ngwear.verify.rolling_ring", 14, "an O-ring that a rod rolls, with the couple that turns a ring"
    ),
    "block_on_ring": Case(
        "ngwear.verify.block_on_ring", 27, "a block worn over 3600 m with an implicit half-plane solver"
    ),
    "worn_cylinder": Case(
        "ngwear.verify.worn_cylinder", 24, "late wear under a cylinder with Archard's law's closed form"
    ),
    "fretting": Case(
        "ngwear.verify.fretting", 41, "10,000 cycles of steel on steel, both wearing, with published depths"
    ),
    "measured_profile": Case(
        "ngwear.verify.measured_profile",
        9.4,
        "the wear rate fitted to a disturbed profile with the one it was made of",
        quick=True,
    ),
    "stability_pair": Case(
        "ngwear.verify.stability_pair",
        6.7,
        "implicit wear at 10 critical steps, smooth, with explicit wear at 4, rippled",
        quick=True,
    ),
    "wear_laws": Case(
        "ngwear.verify.wear_laws", 61, "columns and a cylinder worn by laws beyond Archard's with closed forms"
    ),
    "notched_strip": Case(
        "ngwear.verify.notched_strip", 12, "bars that tear one by one, and a crack, with hand calculations"
    ),
    "lost_elements": Case(
        "ngwear.verify.lost_elements",
        2.2,
        "energy and residual without lost elements with the section meshed anew",
        quick=True,
    ),
    "tearing_off": Case(
        "ngwear.verify.no_loss", 11, "wear with elements that could be lost but are not with an explicit loop by hand"
    ),
    "material_book": Case(
        "ngwear.verify.material_book", 18, "areas lost by each cause with the section's, and numbers of looks a cycle"
    ),
    "torn_seal": Case(
        "ngwear.verify.torn_seal",
        10000,
        "an hour of the shipped section that loses elements with finer elements and jumps",
    ),
    "lubrication": Case(
        "ngwear.verify.lubrication",
        11,
        "friction heat and wear by tables over the distance with their integrals",
        quick=True,
    ),
    "sliding_roller": Case(
        "ngwear.verify.sliding_roller", 27, "a sliding roller to mu = 1 on coarser meshes with a fine one"
    ),
    "shaft_on_plate": Case(
        "ngwear.verify.shaft_on_plate", 97, "the shipped shaft: worn area with a closed form, jumps with 200 steps"
    ),
    "rod_seal": Case(
        "ngwear.verify.rod_seal", 41, "the shipped rod seal with what its source describes, and its books"
    ),
    "rod_seal_jumps": Case(
        "ngwear.verify.rod_seal_jumps", 140, "the rod seal by cycle jumps with each of its 200 strokes solved"
    ),
    "error_estimates": Case(
        "ngwear.verify.error_estimates", 0, "the errors that shipped scenes state with what finer runs show"
    ),
    "rod_seal_filled": Case(
        "ngwear.verify.rod_seal_filled", 91, "the rod seal of a rubber that remembers with the elastic one"
    ),
}

ALL = "all"
QUICK = tuple(name for name, case in CASES.items() if case.quick)
RESUMED = ("torn_seal",)  # with runs of a quarter of an hour and more

__all__ = ["ALL", "CASES", "QUICK", "Case", "Check", "Checks", "checks_of", "chosen", "listing", "verify"]


def verify(*cases: str, out: Path | str | None = None) -> Checks:
    """Compare with references that others derived.

    Parameters
    ----------
    *cases : str
        Their names, ``"all"`` for all; without any, those that together take about a minute.
    out : path or None
        Folder in which cases that take hours keep their runs, to go on with.

    Raises
    ------
    SceneError
        For a name that is no case.
    """
    folder = None if out is None else Path(out)
    return Checks(check for name in chosen(cases or None) for check in checks_of(name, folder))


def chosen(names: Iterable[str] | None = None) -> list[str]:
    """Return the named cases, every case for ``all``, the quick ones without names; errors as ``verify``."""
    asked = list(QUICK if names is None else names)
    for name in asked:
        if name != ALL and name not in CASES:
            raise SceneError("verify", name, f"no such case; known: {ALL}, {', '.join(CASES)}")
    return list(CASES) if ALL in asked else asked


def listing() -> list[str]:
    """Return a line for each case, the quick ones first: its name, the seconds that it takes, and what it compares."""
    seconds = {True: 0.0, False: 0.0}
    lines: dict[bool, list[str]] = {True: [], False: []}
    for name, case in CASES.items():
        seconds[case.quick] += case.seconds
        took = f"{case.seconds:7.0f} s" if case.seconds else "        ?"
        lines[case.quick].append(f"  {name:18s}{took}  {case.compares}")
    return [
        f"without a name, {seconds[True]:.0f} s of processor time:",
        *lines[True],
        f"by name, or by 'all', {seconds[False] / 3600:.1f} h of processor time:",
        *lines[False],
    ]


def checks_of(name: str, folder: Path | None = None) -> Iterator[Check]:
    """Run a case; yield its checks as they are made. With a folder a case that takes hours goes on with what is there.

    Errors as ``run``, if the folder cannot be used.
    """
    run = import_module(CASES[name].module).run
    yield from run(folder / name) if folder is not None and name in RESUMED else run()


class _Room(ModuleType):
    """The package as a callable, for it shares its name with the verb ``ngwear.verify``."""

    def __call__(self, *cases: str, out: Path | str | None = None) -> Checks:
        return verify(*cases, out=out)


sys.modules[__name__].__class__ = _Room
