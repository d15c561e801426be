"""Seals that nobody drew, at random: writes them as scenes, runs each, and says what became of it.

A seed and an index give one seal, always the same: ``foreign_sections.py`` draws its section, this file the rest. The
part has no support; it lies between two surfaces and two walls, with room or without. A run may be completed, refused
or given up; it may not be completed without a warning and wrong. What is checked:

- no node of the deformed outline lies inside a surface;
- the outline does not cross itself;
- no pressure along a contact alternates from node to node;
- all forces along the axis add up to zero;
- with ``--check``, a run with elements half as long finds the same depth and the same peak pressure, within what is
  stated, or 5 %: else the answer counts as wrong, whatever the run warns of.

Usage: python foreign.py [--seed N] [--count 60] [--only INDEX] [--check] [--out DIR]
"""

import argparse
import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from foreign_sections import KINDS, Room, Shape
from shapely import Polygon

from ngwear.errors import ResultError
from ngwear.results.result_file import ResultFile, read_result
from ngwear.results.section import Section
from ngwear.scene.accuracy import PRESETS

STROKES, TRAVEL = 2000, 20.0
INSIDE, INSIDE_SHARE = 1e-3, 0.01  # a node may lie so far inside a surface: mm, and share of the mesh edge
WORN_BY, LAST = ("rod", "bore"), 2  # surfaces that wear the part; cycles in the series' last rows
ALTERNATES, IMBALANCE, DIFFERS = 0.1, 1e-5, 0.05
# A run whose errors nobody reads takes less than half of the time.
NO_ERRORS = """
import sys, ngwear
from ngwear.loop.run import run
found = run(ngwear.read_scene(sys.argv[1]), out=sys.argv[2], throw=False, figures=False)
sys.exit(0 if found.status == "completed" else 3)
"""
COMPARED = ("maximum depth", "peak pressure")
WRONG, CRASHED, LIMIT, GAVE_UP = "silent wrong answer", "crashed", "time limit", "gave up"
REFUSED, WARNED, COMPLETED = "refused", "completed, warned", "completed"
OUTCOMES = (WRONG, CRASHED, LIMIT, GAVE_UP, REFUSED, WARNED, COMPLETED)
COLUMNS = {"index": 5, "kind": 9, "G": 5, "p/G": 5, "friction": 9, "squeeze": 7, "clearance": 9, "became": 19, "s": 4}
SHORT = 160  # characters of a message in the table


@dataclass(frozen=True)
class Seal:
    """One seal: section, surfaces, rubber and loads; lengths in mm, stresses in MPa."""

    index: int
    kind: str
    shape: Shape
    inner: float
    outer: float
    walls: tuple[float, float]
    clearance: tuple[float, float]
    squeeze: float
    modulus: float
    pressure: float
    friction: tuple[float, float]
    wear_rate: float
    listed: bool

    @property
    def name(self) -> str:
        """Name of its folder."""
        return f"{self.index:03d}_{self.kind.lower().replace('-', '_')}"

    @property
    def row(self) -> dict[str, str]:
        """What the table says about the seal itself."""
        return {
            "index": f"{self.index}",
            "kind": self.kind,
            "G": f"{self.modulus:.2f}",
            "p/G": f"{self.pressure / self.modulus:.2f}",
            "friction": "/".join(f"{mu:.2f}" for mu in self.friction),
            "squeeze": f"{100 * self.squeeze:.0f} %",
            "clearance": "/".join(f"{room:.2f}" for room in self.clearance),
        }


def draw(seed: int, index: int) -> Seal:
    """The seal with this index."""
    rng = np.random.default_rng((seed, index))
    kind = list(KINDS)[index % len(KINDS)]
    radius = 0.5 * float(np.exp(rng.uniform(np.log(4.0), np.log(200.0))))
    height = rng.uniform(max(1.5, 0.03 * radius), min(8.0, 1.2 + 0.3 * radius))
    overlap = height * rng.uniform(0.08, 0.2 if kind == "rectangle" else 0.3)
    share = rng.uniform(0.8, 0.9) if kind in ("lip", "wiper") else rng.uniform(0.3, 0.7)
    inner = min(share * overlap, 0.12 * radius)
    tip = min(float(np.exp(rng.uniform(np.log(0.03), np.log(0.3)))), 0.08 * height)
    room = Room(height, inner, overlap - inner, tip)
    drawn = KINDS[kind](rng, room)
    shape = replace(drawn, points=np.round(drawn.points + np.array([0.0, radius - inner]), 5))
    shore = rng.uniform(50.0, 95.0)
    modulus = 0.0981 * (56 + 7.66 * shore) / (0.137505 * (254 - 2.54 * shore)) / 3  # Gent 1958: Young's modulus over 3
    pressure = 0.0 if kind == "wiper" or rng.random() < 0.1 else min(35.0, modulus * 10 ** rng.uniform(-1.0, 1.0))
    low, high = float(shape.points[:, 0].min()), float(shape.points[:, 0].max())
    air, sealed = (float(free) for free in rng.uniform(0.0, 2.0, 2) * (rng.random(2) > 0.25))
    sealed += max(0.0, shape.groove_width(radius, radius + room.gland) - (high - low) - air - sealed)
    friction = tuple(float(mu) for mu in rng.uniform(0.0, 0.5, 2) * (rng.random(2) > 0.1))
    mean = 0.5 * pressure + 3 * modulus * overlap / height  # rough mean of the contact pressure
    return Seal(
        index=index,
        kind=kind,
        shape=shape,
        inner=radius,
        outer=radius + room.gland,
        walls=(low - air, high + sealed),
        clearance=(air, sealed),
        squeeze=overlap / height,
        modulus=modulus,
        pressure=pressure,
        friction=friction,
        wear_rate=rng.uniform(2e-3, 6e-3) / (mean * STROKES * TRAVEL),
        listed=index // len(KINDS) % 2 == 1,
    )


def write(seal: Seal, folder: Path, across: float) -> Path:
    """Write scene and contour, as a user would; return the scene's path."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "contour.toml").write_text(seal.shape.contour(seal.kind))
    path = folder / "scene.toml"
    path.write_text(_scene(seal, across))
    return path


def _scene(seal: Seal, across: float) -> str:
    """The scene as TOML."""
    piston = seal.kind == "D-ring"
    inner, outer = ("groove bottom", "bore") if piston else ("rod", "groove bottom")
    surfaces = [
        (inner, not piston, (0, -1), f'type = "rod", diameter = {2 * seal.inner:.6g}'),
        (outer, piston, (0, 1), f'type = "bore", diameter = {2 * seal.outer:.6g}'),
        ("air wall", False, (-1, 0), f'type = "plane", point = [{seal.walls[0]:.6g}, 0.0], normal = [1.0, 0.0]'),
        ("sealed wall", False, (1, 0), f'type = "plane", point = [{seal.walls[1]:.6g}, 0.0], normal = [-1.0, 0.0]'),
    ]
    surfaces.sort(key=lambda surface: not surface[1])
    lines = ["[scene]", f'name = "{seal.kind} {seal.index}"', 'kind = "axisymmetric"']
    lines += ["[contour]", 'file = "contour.toml"', "[material]", 'model = "mooney-rivlin"']
    lines += [f"c10 = {0.4 * seal.modulus:.6g}", f"c01 = {0.1 * seal.modulus:.6g}"]
    lines += [f"bulk_modulus = {max(2000.0, 200 * seal.modulus):.6g}"]
    for name, slides, direction, surface in surfaces:
        lines += ["[[contact]]", f'name = "{name}"', f"surface = {{ {surface} }}"]
        lines += [f"edges = {json.dumps(seal.shape.facing(direction))}"] if seal.listed else []
        lines += [f"friction = {seal.friction[not slides]:.4g}"]
        lines += [f"specific_wear_rate = {seal.wear_rate:.4g}" if slides else "slides = false"]
    if seal.shape.inlet:
        edges = list(dict.fromkeys(seal.shape.names))
        lines += ["[fluid]", f"edges = {json.dumps(edges)}", f"inlet = {json.dumps(seal.shape.inlet)}"]
    lines += ["[program]", f"strokes = {STROKES}"]
    for name, direction, pressure in (("outward", -1, 0.0), ("inward", 1, seal.pressure)):
        lines += ["[[program.stroke]]", f'name = "{name}"', f"direction = {-direction if piston else direction}"]
        lines += [f"travel = {TRAVEL}", f"pressure = {pressure:.4g}"]
    return "\n".join([*lines, "[accuracy]", f"across = {across}"]) + "\n"


def run(scene: Path, out: Path, limit: float, *options: str, errors: bool = True) -> tuple[str, str]:
    """Run a scene in a process of its own, with its errors or without: what became of it, and its message."""
    command = [sys.executable, "-m", "ngwear", "run", str(scene), "--out", str(out), "--quiet", *options]
    command = command if errors else [sys.executable, "-c", NO_ERRORS, str(scene), str(out)]
    pipes = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
    process = subprocess.Popen(command, **pipes, text=True, start_new_session=True)
    try:
        _, said = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return LIMIT, ""
    if "Traceback" in said or process.returncode not in (0, 2, 3):
        *_, last = ["no message", *said.strip().splitlines()]
        return CRASHED, f"code {process.returncode}: {last}"
    if process.returncode == 0:
        warnings = json.loads((out / "summary.json").read_text())["warnings"]
        return (WARNED, warnings[0]) if warnings else (COMPLETED, "")
    text = said.removeprefix("ngwear: ").removeprefix("gave up: ").partition("\nngwear: ")[0].strip()
    return (REFUSED if process.returncode == 2 else GAVE_UP), text


def cause(message: str) -> str:
    """A message in short: its first line without loads and advice, then the first clause of its second line."""
    first, _, second = message.partition("\n")
    for left_out in (r" of the load step to {.*}", r" found under .*load(; lower [^:]*)?: no equilibrium"):
        first = re.sub(left_out, "", first)
    second = re.split(r"; | \(iterations|: |\n", second)[0]
    short = f"{first}: {second}" if second else first
    return short if len(short) <= SHORT else f"{short[: SHORT - 1]}…"


def faults(result: ResultFile) -> list[str]:
    """What is wrong with a completed run, by its last cycle."""
    found = []
    for kind in result.kinds:
        kept = [snapshot for snapshot in result.snapshots if snapshot.kind == kind and snapshot.section]
        section = Section.of(kept[-1].section)
        found += [f"{kind}: {fault}" for fault in (*inside(section, result), *alternating(section)) if fault]
        loops = [Polygon(section.points[loop.ravel()]) for loop in section.loops()]
        found += [f"{kind}: the outline crosses itself" for loop in loops if not loop.is_valid]
    forces = [values for name, values in result.series.items() if " force x [" in name]
    largest = np.abs([values for name, values in result.series.items() if " force " in name]).max(axis=0)
    worst = float((np.abs(np.sum(forces, axis=0)) / np.maximum(largest, 1e-12)).max())
    return found + [f"forces along x leave {worst:.1g} of the largest"] * (worst > IMBALANCE)


def inside(section: Section, result: ResultFile) -> list[str]:
    """Surfaces that nodes of the deformed outline lie in, and how deep."""
    nodes = section.points[section.border]
    resting = INSIDE + INSIDE_SHARE * np.linalg.norm(nodes[:, 2] - nodes[:, 0], axis=1)
    # A solve of strokes that wear ends inside by what they wear: no more than the last cycles have.
    worn = np.ptp(result.series["maximum depth [mm]"][-LAST * len(result.kinds) :])
    found = []
    for name, surface in result.surfaces.items():
        allowed = resting + worn * (name in WORN_BY)
        depth = -np.asarray(surface.gap(nodes[..., 0], nodes[..., 1])) - allowed[:, None]
        row, column = np.unravel_index(np.argmax(depth), depth.shape)
        if depth[row, column] > 0:
            x, y = nodes[row, column]
            deep = depth[row, column] + allowed[row]
            found.append(f"a node at ({x:.3f}, {y:.3f}) is {deep:.4f} mm inside '{name}'")
    return found


def alternating(section: Section) -> list[str]:
    """Contacts with a pressure that goes up and down twice in four mesh edges, by more than a share of its peak."""
    found = []
    for name, contact in section.contacts.items():
        steps = np.diff(contact.pressure)
        joined = np.zeros(len(steps), dtype=bool)
        neighbours = contact.edges[np.abs(np.diff(contact.edges, axis=1).ravel()) == 1]
        joined[neighbours.min(axis=1)] = True
        steps = np.where(joined, steps, 0.0) * (-1.0) ** np.arange(len(steps))
        peak = contact.pressure.max(initial=0.0)
        if len(steps) < 4 or peak == 0:
            continue
        windows = np.lib.stride_tricks.sliding_window_view(steps, 4)
        worst = float(np.maximum(windows.min(axis=1), (-windows).min(axis=1)).max())
        if worst > ALTERNATES * peak:
            found.append(f"the pressure of '{name}' alternates by {100 * worst / peak:.0f} % of its peak")
    return found


def disagreement(coarse: Path, fine: Path) -> list[str]:
    """Quantities in which two runs differ by more than the first one's stated error, or 5 % if that is less.

    Stated errors are shares of the first run's own values.
    """
    one, other = (json.loads((folder / "summary.json").read_text()) for folder in (coarse, fine))
    found = []
    for what in COMPARED:
        column = next(name for name in one if name.startswith(f"{what} ["))
        stated = one["error estimates"].get(f"{what} [-]") or 0.0
        off = abs(one[column] - other[column]) / max(abs(one[column]), 1e-12)
        if off > max(DIFFERS, stated):
            found.append(f"{what} is off by {100 * off:.0f} %, stated {100 * stated:.1f} %")
    return found


def became(seal: Seal, options: argparse.Namespace) -> dict[str, str]:
    """Run one seal; its row of the table."""
    folder = options.out / seal.name
    across = PRESETS[options.accuracy]
    scene = write(seal, folder, across)
    start = time.perf_counter()
    outcome, said = run(scene, folder / "result", options.limit, "--accuracy", options.accuracy)
    seconds = time.perf_counter() - start
    if outcome in (COMPLETED, WARNED):
        try:
            wrong, off = faults(read_result(folder / "result")), []
        except ResultError as error:
            wrong, off = [str(error)], []
        if options.check:
            finer = write(seal, folder / "finer", 2 * across)
            how, _ = run(finer, folder / "finer" / "result", 4 * options.limit, errors=False)
            ended = how in (COMPLETED, WARNED)
            off = disagreement(folder / "result", folder / "finer" / "result") if ended else []
            said += "" if ended else f" (not compared: finer, {how})"
        if wrong or off:
            silent = off or outcome == COMPLETED  # what is stated is promised, whatever else is warned of
            outcome, said = WRONG if silent else outcome, "; ".join([*wrong, *off, *([said] if said else [])])
    return seal.row | {"became": outcome, "s": f"{seconds:.0f}", "message": said}


def line(row: dict[str, str]) -> str:
    """A row as text."""
    return " ".join([*(f"{row[name]:{width}s}" for name, width in COLUMNS.items()), cause(row["message"])]).rstrip()


def main() -> None:
    """Print a row as soon as it is known, then the table with the worst first, then the counts."""
    parser = argparse.ArgumentParser(description="Run seals that nobody drew, and say what became of each.")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--only", type=int, metavar="INDEX", help="this seal alone")
    parser.add_argument("--accuracy", choices=PRESETS, default="draft")
    parser.add_argument("--check", action="store_true", help="also run with elements half as long, and compare")
    parser.add_argument("--jobs", type=int, default=1, help="seals at the same time")
    parser.add_argument("--limit", type=float, default=300.0, metavar="SECONDS", help="time limit of a seal")
    parser.add_argument("--out", type=Path, default=Path("out/foreign"), metavar="DIR")
    options = parser.parse_args()
    rows, head = [], line({name: name for name in COLUMNS} | {"message": "message"})
    sys.stderr.write(f"{head}\n")
    with ThreadPoolExecutor(options.jobs) as pool:
        which = range(options.count) if options.only is None else [options.only]
        for done in as_completed([pool.submit(became, draw(options.seed, i), options) for i in which]):
            rows.append(done.result())
            sys.stderr.write(f"{line(rows[-1])}\n")
    rows.sort(key=lambda row: (OUTCOMES.index(row["became"]), int(row["index"])))
    with (options.out / "table.csv").open("w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, [*COLUMNS, "message"])
        table.writeheader()
        table.writerows(rows)
    kinds = [row["became"] for row in rows]
    counts = ", ".join(f"{kinds.count(outcome)} {outcome}" for outcome in OUTCOMES if outcome in kinds)
    sys.stdout.write("\n".join([head, *map(line, rows), f"{len(rows)} seals: {counts}"]) + "\n")


if __name__ == "__main__":
    main()
