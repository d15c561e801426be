import ngsolve as ng
import numpy as np
import pytest

from ngwear.effects.base import DISPLACEMENT, VOLUMETRIC_STRESS
from ngwear.effects.elasticity import Elasticity
from ngwear.equilibrium.problem import Problem
from ngwear.fields.kinematics import Axisymmetric, PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.materials import MooneyRivlin
from ngwear.verify.builders import meshed, quarter_ring

MATERIAL = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1000.0)


def symbolic(problem: Problem, elasticity: Elasticity) -> ng.BilinearForm:
    """The same energy as NGSolve differentiates it."""
    trial = dict(zip(problem.names, problem.space.TrialFunction(), strict=True))
    u, p = trial[DISPLACEMENT], trial[VOLUMETRIC_STRESS]
    F = ng.Id(2) + ng.Grad(u)
    hoop = problem.kinematics.hoop_stretch(u)
    j = ng.Det(F) * hoop
    i1 = ng.InnerProduct(F, F) + hoop**2
    i2 = ng.Det(F) ** 2 + hoop**2 * ng.InnerProduct(F, F)
    pointwise, rest = elasticity.split
    iso = elasticity.material.isochoric_energy(j ** (-2 / 3) * i1, j ** (-4 / 3) * i2)
    psi = iso + pointwise / 2 * (j - 1) ** 2 + p * (j - 1) - p * p / (2 * rest)
    form = ng.BilinearForm(problem.space)
    rules = {kind: ng.IntegrationRule(kind, 2 * max(elasticity.order, 2)) for kind in (ng.TRIG, ng.QUAD)}
    form += ng.Variation((psi * problem.kinematics.weight).Compile() * ng.dx(intrules=rules))
    return form


@pytest.mark.parametrize("kinematics", [PlaneStrain(), Axisymmetric()], ids=["plane strain", "axisymmetric"])
@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("moved", [False, True], ids=["as meshed", "outline moved"])
def test_points_give_what_ngsolve_gives(kinematics, order, moved):
    body = meshed(quarter_ring(2.0, 4.0), 0.7)
    elasticity = Elasticity(MATERIAL, order=order)
    problem = Problem(body, kinematics, [elasticity], order=order)
    if moved:
        before = body.contour
        shift = np.outer(np.sin(before.points[:, 0]), [0.02, 0.01]) * ~before.corners[:, None]
        body.move_to(Outline(before.points + shift, before.names, before.corners))
    problem.fields[DISPLACEMENT].Set(ng.CF((0.2 * ng.sin(ng.x + ng.y), 0.1 * ng.cos(ng.x * ng.y))))
    problem.fields[VOLUMETRIC_STRESS].Set(ng.sin(ng.x))
    form = symbolic(problem, elasticity)
    state = problem.state.vec
    expected, found = state.CreateVector(), state.CreateVector()
    form.Apply(state, expected)
    problem.residual(found)
    scale = np.abs(expected.FV().NumPy()).max()
    np.testing.assert_allclose(found.FV().NumPy(), expected.FV().NumPy(), atol=1e-12 * scale)
    form.AssembleLinearization(state)
    direction = state.CreateVector()
    direction.FV().NumPy()[:] = np.random.default_rng(1).normal(size=len(direction))
    expected.data = form.mat * direction
    found.data = problem.assemble() * direction
    scale = np.abs(expected.FV().NumPy()).max()
    np.testing.assert_allclose(found.FV().NumPy(), expected.FV().NumPy(), atol=1e-12 * scale)
    strain = problem.points.strain(state.FV().NumPy())
    energy = (problem.points.volumes * elasticity.energy(strain)).sum()
    assert energy == pytest.approx(form.Energy(state), rel=1e-12)


def test_a_model_curved_in_its_invariants_has_its_whole_tangent():
    class Curved(MooneyRivlin):
        def isochoric_energy(self, i1_bar, i2_bar):
            a, b = i1_bar - 3, i2_bar - 3
            return self.c10 * (a + 0.1 * a**2) + self.c01 * (b + 0.2 * a * b + 0.05 * b**2)

        def isochoric_slopes(self, i1_bar, i2_bar):
            a, b = i1_bar - 3, i2_bar - 3
            first = self.c10 * (1 + 0.2 * a) + self.c01 * 0.2 * b, self.c01 * (1 + 0.2 * a + 0.1 * b)
            return *first, 0.2 * self.c10 + 0 * a, 0.2 * self.c01 + 0 * a, 0.1 * self.c01 + 0 * a

    elasticity = Elasticity(Curved(c10=0.6, c01=0.15, bulk_modulus=20.0))
    rng = np.random.default_rng(2)
    strain = rng.uniform(-0.2, 0.2, (50, 6))
    stress, slope = elasticity.response(strain, tangent=True)
    step = 1e-6
    for k in range(6):
        change = step * np.eye(6)[k]
        by_energy = (elasticity.energy(strain + change) - elasticity.energy(strain - change)) / (2 * step)
        np.testing.assert_allclose(stress[:, k], by_energy, atol=1e-7)
        ahead, behind = (elasticity.response(strain + s * change, tangent=False)[0] for s in (1, -1))
        np.testing.assert_allclose(slope[:, k], (ahead - behind) / (2 * step), atol=1e-6)
