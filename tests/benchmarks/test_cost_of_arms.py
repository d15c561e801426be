"""What an iteration of Newton costs with 15 arms against one, and what the memory takes; seconds are printed only.

The arms meet the equilibrium as one summed tensor: 15 of them cost what one does. Each keeps a symmetric tensor of 6
numbers at every material point of a solid.

Also: python tests/benchmarks/test_cost_of_arms.py
"""

import statistics
import time

import numpy as np

from ngwear.effects.elasticity import Elasticity
from ngwear.effects.viscosity import Viscosity
from ngwear.equilibrium.problem import Problem, Support
from ngwear.fields.kinematics import Solid
from ngwear.geometry.sheet import Sheet
from ngwear.materials import MooneyRivlin, PronySeries

ROUNDS = 7
RUBBER = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1500.0)


def block(arms):
    """About 6,000 tetrahedra."""
    series = PronySeries((0.2,) * arms, tuple(10.0 ** (k - arms // 2) for k in range(arms)))
    nowhere = np.empty((0, 3))
    size = {"thickness": 4.0, "track_radius": 16.5, "reach": 8.0, "beside": 8.0}
    body = Sheet(**size, seeds=nowhere, sizes=nowhere[:, 0], coarse=1.3)
    memory = Viscosity(RUBBER, series)
    problem = Problem(body, Solid(), [Elasticity(RUBBER), memory], supports=[Support(("bottom",))])
    problem.set_time_step(0.1)
    return problem, memory


def iteration(problem):
    """CPU seconds of one residual, tangent and factorisation."""
    residual = problem.state.vec.CreateVector()
    start = time.process_time()
    problem.residual(residual)
    assert problem.tangent() is not None
    return time.process_time() - start


def test_fifteen_arms_cost_what_one_does():
    few, many = block(1), block(15)
    for arms, (problem, memory) in ((1, few), (15, many)):
        points = problem.points.volumes.size
        assert memory.relaxed.nbytes == 8 * 6 * arms * points
        assert memory.history.nbytes == 8 * 6 * points
    for problem, _ in (few, many):
        iteration(problem)  # the first one also orders the unknowns
    ratios = [iteration(many[0]) / iteration(few[0]) for _ in range(ROUNDS)]
    megabytes = many[1].relaxed.nbytes / 2**20
    elements = many[0].body.mesh.ne
    print(f"\n{elements} tetrahedra: 15 arms over 1, CPU time of an iteration {statistics.median(ratios):.3f}")
    print(f"memory of 15 arms {megabytes:.1f} MB: 6 doubles x 15 arms x {many[0].points.volumes.size} points")


if __name__ == "__main__":
    test_fifteen_arms_cost_what_one_does()
