"""The command line: run, verify, explain, cost, plot, compare."""

from __future__ import annotations

import argparse
import json
import logging
import os
import sys
from pathlib import Path
from typing import Any

from ngwear.errors import NgwearError, ResultError
from ngwear.files.version import VERSION

OK, BAD_INPUT, GAVE_UP = 0, 2, 3
SECOND_PROCESS = (
    "ngwear.error_estimates.coarser_runs",
    "ngwear.plots.wear",
    "h5py",
    "matplotlib.backends.backend_agg",
)  # modules that the second process of a run needs


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="ngwear", description="Friction and abrasive wear of rubber parts.")
    parser.add_argument("--version", action="version", version=f"ngwear {VERSION}")
    commands = parser.add_subparsers(dest="command", required=True)
    run = commands.add_parser("run", help="simulate a scene to its last stroke")
    run.add_argument("scene", type=Path, metavar="SCENE.toml")
    run.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for the results")
    run.add_argument("--resume", action="store_true", help="continue the run in DIR")
    run.add_argument("--quiet", action="store_true", help="no progress bar")
    run.add_argument(
        "--alone",
        action="store_true",
        help="no coarser runs: the error of the mesh is estimated for a part with room to move only",
    )
    run.add_argument(
        "--accuracy",
        metavar="PRESET|ERROR",
        help="draft, engineering or reference, or the allowed relative error of the depth, such as 0.01; replaces the "
        "accuracy in the scene",
    )
    run.set_defaults(do=_run)
    verify = commands.add_parser("verify", help="compare with closed-form solutions and published results")
    verify.add_argument("cases", nargs="*", metavar="CASE")
    verify.add_argument("--list", action="store_true", help="list the cases and their seconds, and run none")
    verify.add_argument("--json", action="store_true")
    keeps = "folder for the runs of torn_seal (hours), to continue them; use a new folder after a change of the code"
    verify.add_argument("--out", type=Path, metavar="DIR", help=keeps)
    verify.set_defaults(do=_verify, again="the cases start again; torn_seal continues if --out was given")
    explain = commands.add_parser("explain", help="list the effects that a scene simulates and those that it neglects")
    explain.add_argument("scene", type=Path, metavar="SCENE.toml")
    explain.add_argument("--json", action="store_true")
    explain.add_argument(
        "--assume",
        nargs="+",
        default=(),
        metavar="NAME=VALUE",
        help="constants that no scene gives, such as oil_viscosity=1e-7 (MPa s); a wrong name lists all names",
    )
    explain.set_defaults(do=_explain)
    cost = commands.add_parser("cost", help="compare settings: error and computing time of each")
    cost.add_argument("scene", type=Path, metavar="SCENE.toml")
    cost.add_argument("--budget", type=float, required=True, metavar="SECONDS", help="wall time for all runs")
    cost.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        help="folder for table, figure and runs; runs that are already there are used",
    )
    cost.add_argument("--json", action="store_true")
    cost.add_argument("--quiet", action="store_true", help="no progress bar")
    cost.set_defaults(do=_cost, again="the same command with the same --out continues")
    plot = commands.add_parser("plot", help="draw the figures of a finished run")
    plot.add_argument("folder", type=Path, metavar="DIR")
    instead = plot.add_mutually_exclusive_group()
    instead.add_argument("--against", type=Path, metavar="DIR", help="compare with another run of the same outline")
    instead.add_argument(
        "--animate", action="store_true", help="also draw evolution.gif, an animation of outline and pressure"
    )
    which = (
        "draw only the loaded section, coloured by this field, such as 'mean pressure'; a wrong name lists all names"
    )
    instead.add_argument("--field", metavar="NAME", help=which)
    plot.set_defaults(do=_plot)
    compare = commands.add_parser(
        "compare", help="compare a measured profile with the worn edge of a run; fit the wear rate"
    )
    compare.add_argument("folder", type=Path, metavar="DIR")
    compare.add_argument("profile", type=Path, metavar="PROFILE.csv", help="columns 'x [mm]' and 'z [mm]', or [µm]")
    compare.add_argument(
        "--edges", nargs="+", default=(), metavar="NAME", help="measured edges; default: all worn edges"
    )
    slid = compare.add_mutually_exclusive_group()
    slid.add_argument(
        "--strokes", type=float, metavar="N", help="number of strokes of the measured part; default: that of the run"
    )
    slid.add_argument("--distance", type=float, metavar="MM", help="sliding distance of the measured part")
    compare.add_argument(
        "--upside-down", action="store_true", help="the heights of the profile point into the material"
    )
    compare.add_argument("--mirrored", action="store_true", help="the profile was measured in the opposite direction")
    compare.add_argument("--json", action="store_true")
    compare.set_defaults(do=_compare)
    return parser


def main(arguments: list[str] | None = None) -> int:
    """Run one command; return 0 if it is completed, 2 for bad input, 3 if the computation gave up."""
    logging.basicConfig(level=logging.WARNING, format="ngwear: %(message)s")
    options = _parser().parse_args(arguments)
    try:
        code = options.do(options)
        sys.stdout.flush()
        return code
    except NgwearError as error:
        print(f"ngwear: {error}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print(f"ngwear: interrupted; {getattr(options, 'again', 'continue with --resume')}", file=sys.stderr)
        return 130
    except BrokenPipeError:  # the program that reads the output, such as head, has closed it
        os.dup2(
            os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno()
        )  # else Python reports the closed pipe again at its end
        return 141


def _run(options: argparse.Namespace) -> int:
    from ngwear.parallel.workers import Worker

    worker = None if options.alone else Worker(*SECOND_PROCESS)  # loads its libraries at the same time as this process
    from ngwear.files.result_folder import COMPLETED
    from ngwear.scene.read_scene import read_scene

    scene = read_scene(options.scene)  # errors in the scene are reported before the solver is loaded
    from ngwear.error_estimates.run import run

    result = run(
        scene,
        out=options.out,
        accuracy=options.accuracy,
        alone=options.alone,
        resume=options.resume,
        progress=not options.quiet,
        throw=False,
        worker=worker,
    )
    if result.status != COMPLETED:
        print(f"ngwear: gave up: {result.message}", file=sys.stderr)
        print(f"ngwear: the results up to that stroke are in {options.out}", file=sys.stderr)
        return GAVE_UP
    if options.quiet:
        for warning in result.summary.get("warnings", []):
            print(f"ngwear: warning: {warning}", file=sys.stderr)
        return OK
    print(result)
    print(f"results and figures: {options.out}")
    return OK


def _print_table(values: dict[str, Any]) -> None:
    for name, value in values.items():
        if isinstance(value, dict | list):
            continue
        print(f"{name:45s} {value:.6g}" if isinstance(value, float) else f"{name:45s} {value}")


def _verify(options: argparse.Namespace) -> int:
    """Print each check as soon as it is done, so that none is lost if the process is stopped."""
    from tqdm import tqdm

    from ngwear.verify import checks_of, chosen, listing

    if options.list:
        print("\n".join(listing()))
        return OK
    passed, opening = True, "["
    with tqdm(chosen(options.cases or None), unit="case", disable=not sys.stderr.isatty(), leave=False) as bar:
        for name in bar:
            bar.set_description(name)
            for check in checks_of(name, options.out):
                passed = passed and check.passed
                line = opening + json.dumps(check.as_dict(), indent=2) if options.json else str(check)
                bar.write(line, file=sys.stdout)
                sys.stdout.flush()
                opening = ","
    if options.json:
        print("[]" if opening == "[" else "]")
    return OK if passed else GAVE_UP


def _explain(options: argparse.Namespace) -> int:
    from tqdm import tqdm

    from ngwear.explanation.assumptions import Assumed
    from ngwear.scene.read_scene import read_scene

    scene, assumed = read_scene(options.scene), Assumed().replaced(options.assume)
    from ngwear.explanation.explain import explain

    shown = sys.stderr.isatty()
    with tqdm(total=100, desc="mounting for contact pressures", unit="%", disable=not shown, leave=False) as bar:
        found = explain(scene, assumed=assumed, on_mount=lambda done: bar.update(round(100 * done) - bar.n))
    print(found.json if options.json else found)
    return OK


def _cost(options: argparse.Namespace) -> int:
    from ngwear.error_estimates.cost import cost
    from ngwear.scene.read_scene import read_scene

    scene = read_scene(options.scene)
    found = cost(scene, budget=options.budget, folder=options.out, progress=not options.quiet)
    if not any(run.ok for run in found.study.runs.values()):
        print(f"ngwear: gave up: {found.paragraph}", file=sys.stderr)
        return GAVE_UP
    if options.json:
        print(json.dumps(found.as_dict(), indent=2))
        return OK
    print(found.paragraph)
    for choice, written in zip(found.choices, found.written, strict=True):
        if written:
            values = [
                f"{k} = {v:.6g}" if isinstance(v, float) else f"{k} = {json.dumps(v)}" for k, v in written.items()
            ]
            print(f"for {100 * choice.target:g} %: {', '.join(values)}")
    if options.out is not None:
        print(f"table and figure: {options.out}")
    return OK


def _plot(options: argparse.Namespace) -> int:
    from ngwear.plots.compare import compare
    from ngwear.plots.pin import is_pin_run, plot_pin
    from ngwear.plots.wear import plot, plot_section

    pin = is_pin_run(options.folder)
    if options.field is not None:
        if pin:
            raise ResultError(f"{options.folder} is a run of a pin: it has no loaded section")
        print(plot_section(options.folder, field=options.field))
        return OK
    if pin and options.animate:
        raise ResultError(f"{options.folder} is a run of a pin: it has no wear to animate")
    draw = plot_pin if pin else plot
    for path in [compare(options.folder, options.against)] if options.against else draw(options.folder):
        print(path)
    if options.animate:
        from ngwear.plots.animation import animate

        print(animate(options.folder, progress=sys.stderr.isatty()))
    return OK


def _compare(options: argparse.Namespace) -> int:
    from ngwear.plots.measured import draw_measured
    from ngwear.profiles.comparison import compare_profile

    comparison = compare_profile(
        options.folder,
        options.profile,
        edges=options.edges,
        strokes=options.strokes,
        distance=options.distance,
        upside_down=options.upside_down,
        mirrored=options.mirrored,
    )
    files = comparison.write(options.folder), draw_measured(comparison, options.folder)
    numbers = comparison.as_dict()
    if options.json:
        print(json.dumps(numbers, indent=2))
        return OK
    notes = numbers.pop("notes")
    _print_table(numbers)
    for note in notes:
        print(f"note: {note}")
    for path in files:
        print(path)
    return OK
