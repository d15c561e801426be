"""Start states on another mesh."""

import ngsolve as ng
import numpy as np
import pytest

from ngwear.effects.base import DISPLACEMENT
from ngwear.equilibrium.state_transfer import LOWEST_JACOBIAN, unfold
from ngwear.loop.element_sizes import coarse_for_mounting, with_mounting_lengths
from ngwear.loop.mounting import unworn_body
from ngwear.loop.stage import Stage


@pytest.fixture
def problem(ring):
    scene = coarse_for_mounting(with_mounting_lengths(ring))
    return Stage(scene, unworn_body(scene, ring.accuracy.across)).problem


def least(problem):
    problem.points.follow()
    return problem.jacobians().min()


def test_an_inverted_element_is_refilled(problem):
    vector = problem.state.vec.FV().NumPy()
    mesh, size = problem.body.mesh, problem.body.size
    inside = max(
        range(mesh.nv), key=lambda i: np.linalg.norm(problem.body.contour.points - mesh.vertices[i].point, axis=1).min()
    )
    vector[inside] = 0.5 * size
    assert least(problem) < 0
    unfold(problem)
    assert least(problem) > LOWEST_JACOBIAN
    assert abs(vector[inside]) < 0.05 * size


@pytest.mark.parametrize("radius", [1.02, 1.05, 1.1, 1.2])
def test_a_state_that_is_crushed_along_its_outline_remains(problem, radius):
    """A harmonic extension of a section that is bent around about its own radius would unbend it, or fold it."""
    points, u = problem.body.contour.points, problem.fields[DISPLACEMENT]
    middle_x, middle_y = points.mean(axis=0)
    radius *= np.abs(points[:, 1] - middle_y).max()
    x, y = ng.x - middle_x, ng.y - middle_y
    u.Set(ng.CF(((radius + y) * ng.sin(x / radius) - x, (radius + y) * ng.cos(x / radius) - radius - y)))
    bent, squeezed = u.vec.FV().NumPy().copy(), least(problem)
    assert 0 < squeezed < LOWEST_JACOBIAN
    unfold(problem)
    assert least(problem) >= squeezed
    assert np.linalg.norm(u.vec.FV().NumPy() - bent) < 0.5 * np.linalg.norm(bent)
