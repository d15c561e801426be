"""What each effect brings, and that a scene without it pays nothing for it: unknowns, memory, assembly, total time.

A sheet under a roller is mounted and slid to and fro, once with an effect and once without. The one without is asked
for in two processes: one never had the effect, the other ran the scene with the effect and then took it out
(``dataclasses.replace``). In a round both run at once, each on one thread of a core of its own, and once more with
cores exchanged: what other tenants of the machine do to its speed, up and down, they do to both. Printed are CPU times
of a run, medians of the rounds, and that of the ratios of both runs' times in each round with its 95 % interval.

Usage: python price_of_absence.py [ROUNDS] [EFFECT ...]
       python price_of_absence.py --subject never | removed EFFECT
       python price_of_absence.py --facts never | removed EDGE
"""

import hashlib
import json
import os
import pickle
import statistics
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

from scipy.stats import quantile_test

ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NGS_NUM_THREADS"), "1")
KINDS = ("never", "removed")
ROUNDS, ASSEMBLIES = 12, 5

# The modules that belong to each effect alone; wear is the loop itself.
FRICTION = ("effects.friction", "effects.coefficient", "effects.ripples", "effects.stick_slip", "loop.slip_over_cycles")
MODULES = {
    "friction": FRICTION,
    "stick-slip": ("effects.stick_slip", "loop.slip_over_cycles"),
    "fluid pressure": ("effects.fluid_pressure",),
    "memory": (
        "effects.memory",
        "effects.stroke_memory",
        "effects.viscosity",
        "loop.memory_over_cycles",
        "loop.time_step_error",
        "fields.background_mesh",
    ),
    "wear": (),
    "law of wear": ("effects.pressure_wear",),
    "wear of the surface": ("loop.counter_surface",),
    "lost elements": ("loop.lost_elements", "geometry.element_body", "geometry.layers"),
}
QUICK = tuple(effect for effect in MODULES if effect != "stick-slip")  # whose scene takes longer than all the others


def pair(effect, edge=0.1):
    """The scene with the effect, and without, on elements of so many mm."""
    from ngwear.geometry.outline import Outline
    from ngwear.laws import PowerWear
    from ngwear.materials import MooneyRivlin, PronySeries
    from ngwear.scene.accuracy import Accuracy
    from ngwear.scene.boundary import Fluid, Support
    from ngwear.scene.contact import Contact
    from ngwear.scene.deactivation import Deactivation
    from ngwear.scene.options import Wear
    from ngwear.scene.part import Part
    from ngwear.scene.program import Program, Stroke
    from ngwear.scene.scene import Scene
    from ngwear.surfaces import Cylinder

    forth = Stroke(name="forth", travel=10.0, speed=20.0)
    back = Stroke(name="back", travel=10.0, speed=20.0, direction=-1.0)
    roller = Contact(name="roller", edges=("top",), surface=Cylinder(centre=(0.0, 6.75), radius=5.0), refine=True)
    bare = Scene(
        name="sheet",
        part=Part(
            Outline.rectangle((-5.0, 5.0), (0.0, 2.0)), material=MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1000.0)
        ),
        contacts=(roller,),
        supports=(Support(edges=("bottom",)),),
        program=Program(cycle=(forth, back), strokes=2),
        accuracy=Accuracy(patch=edge, coarse=5 * edge, mounting=edge),
        wear=Wear(step="each", remesh="never"),
        axisymmetric=False,
    )

    def rolled(scene, **changes):
        return replace(scene, contacts=(replace(scene.contacts[0], **changes),))

    worn = rolled(bare, specific_wear_rate=1e-5)
    sealed = replace(back, pressure=0.1)
    rubbed = rolled(bare, friction=0.3)
    pairs = {
        "friction": (rubbed, bare),
        "stick-slip": (rolled(rubbed, sticks=True), rubbed),
        "fluid pressure": (
            replace(
                bare,
                fluid=Fluid(edges=("right", "top"), inlet=("right",)),
                program=replace(bare.program, cycle=(forth, sealed)),
            ),
            bare,
        ),
        "memory": (replace(bare, part=replace(bare.part, prony=PronySeries((0.5, 0.4, 0.3), (0.1, 1.0, 10.0)))), bare),
        "wear": (worn, bare),
        "law of wear": (rolled(worn, wear_law=PowerWear(exponent=1.5)), worn),
        "wear of the surface": (rolled(worn, counter_wear_rate=1e-6), worn),
        "lost elements": (replace(worn, deactivation=Deactivation(depth=max(0.3, edge))), worn),
    }
    return pairs[effect]


def without(effect, scene, bare):
    """The scene with the effect taken out again, by hand."""
    contact = {
        "friction": {"friction": 0.0},
        "stick-slip": {"sticks": None},
        "wear": {"specific_wear_rate": 0.0},
        "law of wear": {"wear_law": None},
        "wear of the surface": {"counter_wear_rate": 0.0},
    }
    if effect in contact:
        return replace(scene, contacts=(replace(scene.contacts[0], **contact[effect]),))
    if effect == "fluid pressure":
        dry = tuple(replace(stroke, pressure=0.0) for stroke in scene.program.cycle)
        return replace(scene, fluid=None, program=replace(scene.program, cycle=dry))
    return replace(scene, part=replace(scene.part, prony=None), deactivation=None)


def run(scene):
    """Mount and slide: CPU seconds, and the state at the end."""
    from ngwear.loop.stepper import Stepper

    stepper, start = Stepper(scene), time.process_time()
    state = stepper.start()
    while not stepper.finished(state):
        state = stepper.advance(state)
    return time.process_time() - start, state


def facts(state):
    """Unknowns, matrix entries, bytes at the material points and in the state that is kept, solver, and the result."""
    from ngwear.files.archive import packed
    from ngwear.loop.checkpoint import FORMAT, classes

    problem = state.stage.problem
    stored = packed(state.to_data(), FORMAT, classes(state.stage.scene))
    matrix = problem.assemble()
    vector = problem.state.vec.FV().NumPy().tobytes()
    return {
        "unknowns": problem.space.ndof,
        "matrix entries": matrix.nze,
        "bytes at points": problem.points.nbytes,
        "bytes of the state": sum(array.nbytes for array in stored.values()),
        "symmetric": problem.symmetric,
        "result": hashlib.sha256(vector).hexdigest()[:16],
    }


def assembly(state):
    """Median CPU seconds of a residual and a tangent."""
    problem = state.stage.problem
    out = problem.state.vec.CreateVector()
    seconds = []
    for _ in range(ASSEMBLIES):
        start = time.process_time()
        problem.residual(out)
        problem.assemble()
        seconds.append(time.process_time() - start)
    return statistics.median(seconds)


def loaded(effect):
    """Which of the effect's modules this process has loaded."""
    return [name for name in MODULES[effect] if f"ngwear.{name}" in sys.modules]


def all_facts(kind, edge):
    """Facts of the quick effects' scenes without them, in one process: never had them, or had each and took it out."""
    told, seen = {}, {}
    for effect in QUICK:
        present, scene = pair(effect, edge)
        if kind == "removed":
            told[effect] = {"present": facts(run(present)[1]), "absent": facts(run(without(effect, present, scene))[1])}
            continue
        same = pickle.dumps(scene)
        if same not in seen:
            seen[same] = facts(run(scene)[1])
        told[effect] = {"absent": seen[same], "loaded": loaded(effect)}
    print(json.dumps(told))  # noqa: T201


def subject(kind, effect):
    """Answer every line, a core's number, with a run of the scene without the effect; the first answers tell facts."""
    present, scene = pair(effect)
    cores = sorted(os.sched_getaffinity(0)) if hasattr(os, "sched_setaffinity") else []
    told = {}
    if kind == "removed":
        seconds, state = run(present)
        told["present"] = {**facts(state), "assembly": assembly(state), "total": seconds}
        scene = without(effect, present, scene)
    _, state = run(scene)
    told["absent"] = facts(state)
    told["loaded"] = loaded(effect)
    tell = sys.stdout
    print(json.dumps(told), file=tell, flush=True)
    for line in sys.stdin:
        if cores:
            os.sched_setaffinity(0, {cores[int(line) % len(cores)]})
        seconds, state = run(scene)
        print(json.dumps([seconds, assembly(state), facts(state)["result"]]), file=tell, flush=True)


def compare(effect, rounds):
    """What both processes tell of an effect, and their CPU seconds a run."""
    command = [sys.executable, str(Path(__file__).resolve()), "--subject"]
    pipe, environment = subprocess.PIPE, {**os.environ, **ONE_THREAD}
    told, runs, processes = {}, {kind: [] for kind in KINDS}, {}
    try:
        for kind in KINDS:
            processes[kind] = subprocess.Popen(
                [*command, kind, effect], stdin=pipe, stdout=pipe, text=True, env=environment
            )
            told[kind] = json.loads(processes[kind].stdout.readline())
        for _ in range(rounds):
            for cores in ((0, 1), (1, 0)):
                for kind, core in zip(KINDS, cores, strict=True):
                    processes[kind].stdin.write(f"{core}\n")
                    processes[kind].stdin.flush()
                for kind in KINDS:
                    runs[kind].append(json.loads(processes[kind].stdout.readline()))
    finally:
        for process in processes.values():
            process.stdin.close()
            process.wait()
            process.stdout.close()
    return told, runs


def compare_facts(edge):
    """What two processes tell of the quick effects: that never had them, and that took them out."""
    environment = {**os.environ, **ONE_THREAD}
    told = {}
    for kind in KINDS:
        command = [sys.executable, str(Path(__file__).resolve()), "--facts", kind, str(edge)]
        told[kind] = json.loads(subprocess.run(command, env=environment, check=True, capture_output=True).stdout)
    return told


def row(effect, told, runs):
    """A line of the table."""
    present, absent = told["removed"]["present"], told["never"]["absent"]
    median = {kind: [statistics.median(r[i] for r in runs[kind]) for i in (0, 1)] for kind in KINDS}
    both_cores = {kind: [a[0] + b[0] for a, b in zip(runs[kind][::2], runs[kind][1::2], strict=True)] for kind in KINDS}
    ratios = [a / b for a, b in zip(both_cores["removed"], both_cores["never"], strict=True)]
    ratio = statistics.median(ratios)
    interval = quantile_test(ratios, q=ratio).confidence_interval()  # none of fewer than six
    spread = f"{interval.low:.3f} to {interval.high:.3f}"
    kilobytes = [
        (f["bytes at points"] + f["bytes of the state"] + 12 * f["matrix entries"]) / 1024 for f in (present, absent)
    ]
    return (
        f"| {effect} | {present['unknowns']} / {absent['unknowns']} | {kilobytes[0]:.0f} / {kilobytes[1]:.0f} "
        f"| {1e3 * present['assembly']:.1f} / {1e3 * median['never'][1]:.1f} "
        f"| {present['total']:.2f} / {median['never'][0]:.2f} | {ratio:.3f} ({spread}) |"
    )


def main(arguments):
    """Print the table."""
    rounds = int(arguments[0]) if arguments else ROUNDS
    print("| effect, with / without | unknowns | memory [kB] | assembly [ms] | total [s] | removed over never |")  # noqa: T201
    print("|---|---|---|---|---|---|")  # noqa: T201
    for effect in arguments[1:] or MODULES:
        print(row(effect, *compare(effect, rounds)), flush=True)  # noqa: T201


if __name__ == "__main__":
    if sys.argv[1:2] == ["--subject"]:
        subject(*sys.argv[2:])
    elif sys.argv[1:2] == ["--facts"]:
        all_facts(sys.argv[2], float(sys.argv[3]))
    else:
        main(sys.argv[1:])
