"""What an iteration of Newton costs with 15 arms against one, and what the memory takes; seconds are printed only.

The arms meet the equilibrium as one summed tensor: 15 of them cost what one does. Each keeps a symmetric tensor of 6
numbers at every material point of a solid.

Also: python tests/benchmarks/test_cost_of_arms.py
"""

import statistics
import sys
import time

import numpy as np
import pytest

from ngwear.effects.elasticity import Elasticity
from ngwear.effects.viscosity import Viscosity
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.fields.kinematics import Solid
from ngwear.geometry.sheet import Sheet
from ngwear.materials import MooneyRivlin, PronySeries

ROUNDS = 9
RUBBER = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1500.0)


def block(arms, coarse=0.9):
    """About 6,000 tetrahedra."""
    series = PronySeries((0.2,) * arms, tuple(10.0 ** (k - arms // 2) for k in range(arms)))
    nowhere = np.empty((0, 3))
    size = {"thickness": 4.0, "track_radius": 16.5, "reach": 8.0, "beside": 8.0}
    body = Sheet(**size, seeds=nowhere, sizes=nowhere[:, 0], coarse=coarse)
    memory = Viscosity(RUBBER, series)
    problem = Problem(body, Solid(), [Elasticity(RUBBER), memory], supports=[FixedEdges(("bottom",))])
    problem.set_time_step(0.1)
    return problem, memory


def iteration(problem):
    """CPU seconds of one residual, tangent and factorisation."""
    residual = problem.state.vec.CreateVector()
    start = time.process_time()
    problem.residual(residual)
    assert problem.tangent() is not None
    return time.process_time() - start


def compare(rounds=ROUNDS, **how):
    """Ratio of CPU times, median of alternating rounds; tetrahedra; points; bytes of 15 arms."""
    few, many = block(1, **how), block(15, **how)
    for problem, _ in (few, many):
        iteration(problem)  # the first one also orders the unknowns
    ratios = []
    for k in range(rounds):
        pair = [iteration(problem) for problem, _ in ((few, many) if k % 2 else (many, few))]
        ratios.append(pair[1] / pair[0] if k % 2 else pair[0] / pair[1])
    problem, memory = many
    return statistics.median(ratios), problem.body.mesh.ne, problem.points.volumes.size, memory.relaxed.nbytes


def report(ratio, elements, size):
    """One line for people."""
    sys.stdout.write(
        f"\n{elements} tetrahedra, an iteration with 15 arms over one with 1, CPU time: {ratio:.3f}; "
        f"memory of 15 arms {size / 2**20:.1f} MB\n"
    )


@pytest.mark.parametrize(
    "how", [{"rounds": 1, "coarse": 2.5}, pytest.param({}, marks=pytest.mark.slow)], ids=["small", "whole"]
)
def test_fifteen_arms_take_six_doubles_each_at_every_point(how):
    ratio, elements, points, size = compare(**how)
    report(ratio, elements, size)
    assert size == 8 * 6 * 15 * points


if __name__ == "__main__":
    ratio, elements, _, size = compare()
    report(ratio, elements, size)
