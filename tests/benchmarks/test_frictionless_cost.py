"""A scene without friction pays nothing for friction existing: P1a through the program against the same by hand.

Two processes (``frictionless.py``) solve in turn, A B B A ..., each on one thread. Unknowns, solver, Newton iterations
and force must be the same; the ratio of the median CPU times is printed.

Also: python tests/benchmarks/test_frictionless_cost.py [ROUNDS]
"""

import os
import statistics
import subprocess
import sys
from pathlib import Path

import pytest

SUBJECT = Path(__file__).parent / "frictionless.py"
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NGS_NUM_THREADS"), "1")
KINDS = ("scene", "hand")


def start(kind):
    """A process that is ready to solve."""
    command = [sys.executable, str(SUBJECT), kind]
    pipe = subprocess.PIPE
    return subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True, env={**os.environ, **ONE_THREAD})


def ask(process):
    """One solve: CPU seconds, iterations and force."""
    process.stdin.write("solve\n")
    process.stdin.flush()
    seconds, *same = process.stdout.readline().split()
    return float(seconds), tuple(same)


def compare(rounds):
    """What each process says of itself, its CPU seconds a solve, and all its other answers."""
    processes = {kind: start(kind) for kind in KINDS}
    try:
        facts = {kind: process.stdout.readline().split() for kind, process in processes.items()}
        seconds, answers = {kind: [] for kind in KINDS}, {kind: set() for kind in KINDS}
        for k in range(rounds):
            for kind in KINDS if k % 2 else reversed(KINDS):
                took, same = ask(processes[kind])
                seconds[kind].append(took)
                answers[kind].add(same)
    finally:
        for process in processes.values():
            process.stdin.close()
            process.wait()
            process.stdout.close()
    return facts, seconds, answers


def report(facts, seconds, answers):
    """One line for people."""
    median = {kind: statistics.median(seconds[kind]) for kind in KINDS}
    ratios = [a / b for a, b in zip(*seconds.values(), strict=True)]
    low, _, high = statistics.quantiles(ratios, n=4)
    unknowns, solver, symmetric = facts["scene"]
    ((iterations, force),) = answers["scene"]
    return (
        f"{unknowns} unknowns, {solver}, symmetric {symmetric}, {iterations} iterations, {float(force):.4f} N/mm; "
        f"CPU seconds a solve {median['scene']:.4f} (scene), {median['hand']:.4f} (by hand), "
        f"ratio {median['scene'] / median['hand']:.3f}, half of the rounds within {low:.3f} to {high:.3f}"
    )


@pytest.mark.slow
def test_scene_without_friction_is_the_problem_without_friction(capsys):
    facts, seconds, answers = compare(rounds=2)
    with capsys.disabled():
        print(f"\n{report(facts, seconds, answers)}")  # noqa: T201
    assert facts["scene"] == facts["hand"]
    assert facts["scene"][2] == "True", "LDL^T"
    assert answers["scene"] == answers["hand"], "iterations and force, to the last bit"
    assert len(answers["hand"]) == 1


if __name__ == "__main__":
    print(report(*compare(int(sys.argv[1]) if len(sys.argv) > 1 else 40)))  # noqa: T201
