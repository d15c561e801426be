import ngsolve as ng
import numpy as np
import pytest
from netgen.geom2d import unit_square

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.friction import FullSliding
from ngwear.equilibrium.attempts import solve
from ngwear.equilibrium.linear import RESIDUAL_TOLERANCE, DirectSolver
from ngwear.equilibrium.newton import NewtonOptions, Outcome, iterate
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.errors import ConvergenceError, SceneError
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.materials import NeoHooke
from ngwear.surfaces import Plane
from ngwear.verify.builders import meshed

RUBBER = NeoHooke(shear=1.0, bulk_modulus=50.0)


def form(*, wind: float):
    mesh = ng.Mesh(unit_square.GenerateMesh(maxh=0.2))
    space = ng.H1(mesh, order=2, dirichlet="left")
    u, v = space.TnT()
    a = ng.BilinearForm(ng.grad(u) * ng.grad(v) * ng.dx + wind * ng.grad(u)[0] * v * ng.dx).Assemble()
    f = ng.LinearForm(v * ng.dx).Assemble()
    return space, a, f, ng.GridFunction(space)


@pytest.mark.parametrize(("wind", "symmetric"), [(0.0, True), (50.0, False)])
def test_solution_satisfies_the_equations(wind, symmetric):
    space, a, f, solution = form(wind=wind)
    values = a.mat.AsVector().FV().NumPy().copy()
    solver = DirectSolver(a.mat, space.FreeDofs(), symmetric=symmetric, stiff=slice(None))
    assert solver.factorise()
    assert solver.solve(f.vec, solution.vec) < 1e-12
    a.mat.AsVector().FV().NumPy()[:] = values  # the solver may have scaled it
    rest = (f.vec - a.mat * solution.vec).Evaluate().FV().NumPy()[list(space.FreeDofs())]
    assert np.abs(rest).max() < 1e-12 * np.abs(f.vec.FV().NumPy()).max() * len(rest)
    assert np.abs(solution.vec.FV().NumPy()[~np.array(list(space.FreeDofs()))]).max() == 0


def test_unsymmetric_matrix_is_not_sent_to_ldlt():
    space, a, _, _ = form(wind=50.0)
    assert DirectSolver(a.mat, space.FreeDofs(), symmetric=False, stiff=slice(None)).name in ("pardiso", "umfpack")


def test_ldlt_of_an_unsymmetric_matrix_is_found_out_by_its_residual():
    space, a, f, solution = form(wind=50.0)
    solver = DirectSolver(a.mat, space.FreeDofs(), symmetric=True, stiff=slice(None))
    assert not solver.factorise() or not solver.solve(f.vec, solution.vec) < RESIDUAL_TOLERANCE


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_singular_matrix_is_found_out():
    mesh = ng.Mesh(unit_square.GenerateMesh(maxh=0.3))
    space = ng.H1(mesh, order=1)
    u, v = space.TnT()
    a = ng.BilinearForm(ng.grad(u) * ng.grad(v) * ng.dx + 50 * ng.grad(u)[0] * v * ng.dx).Assemble()
    f = ng.LinearForm(v * ng.dx).Assemble()
    solver = DirectSolver(a.mat, space.FreeDofs(), symmetric=False, stiff=slice(None))
    assert not solver.factorise() or not solver.solve(f.vec, f.vec.CreateVector()) < RESIDUAL_TOLERANCE


def test_second_factorisation_follows_the_matrix():
    space, a, f, solution = form(wind=50.0)
    solver = DirectSolver(a.mat, space.FreeDofs(), symmetric=False, stiff=slice(None))
    assert solver.factorise()
    assert solver.solve(f.vec, solution.vec) < 1e-12
    before = solution.vec.FV().NumPy().copy()
    a.Assemble()
    a.mat.AsVector().FV().NumPy()[:] *= 2
    assert solver.factorise()
    assert solver.solve(f.vec, solution.vec) < 1e-12
    np.testing.assert_allclose(solution.vec.FV().NumPy(), before / 2, atol=1e-12)


def pressed(rectangle, *, held=("bottom",), friction=0.0, force_controlled=False, x=True):
    """A block with a plane above its top, ready to be pressed down by 0.1 mm."""
    body = meshed(rectangle(2.0, 1.0), 0.5)
    plane = Plane(point=(0.0, 1.0), normal_vector=(0.0, -1.0))
    contact = OutlineContact("lid", ("top",), plane, modulus=1.0, force_controlled=force_controlled)
    terms = [Elasticity(RUBBER), contact]
    if friction:
        terms.append(FullSliding(contact, friction))
    supports = [FixedEdges(held, x=x)] if held else []
    return Problem(body, PlaneStrain(), terms, supports=supports), contact


def test_friction_makes_the_problem_unsymmetric(rectangle):
    assert pressed(rectangle)[0].symmetric
    problem, _ = pressed(rectangle, friction=0.3)
    assert not problem.symmetric
    assert problem.tangent().name != "sparsecholesky"


def test_uniform_compression_matches_the_closed_form(rectangle):
    """Bottom free to slide: plane strain compression with J = lambda_x lambda_y found from zero side stress."""
    problem, contact = pressed(rectangle, x=False)
    problem.fields[DISPLACEMENT].Set((0, 0))
    pin = problem.free
    nodes = problem.body.outline
    corner = nodes.vertices[0, 0]
    pin[problem.part(DISPLACEMENT).start + int(corner)] = False
    work = advance(problem, {"lid approach [mm]": 0.1}, StepOptions(newton=NewtonOptions(tolerance=1e-10)))
    assert work.retries == 0
    low, high = 0.9, 1.3
    ly = 0.9

    def side(lx):
        def energy(lam):
            j = lam * ly
            return 0.5 * (j ** (-2 / 3) * (lam**2 + ly**2 + 1) - 3) + 25.0 * (j - 1) ** 2

        return (energy(lx + 1e-6) - energy(lx - 1e-6)) / 2e-6

    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if side(middle) < 0 else (low, middle)
    width = np.ptp(contact.profile().place[:, 0])
    assert width == pytest.approx(2 * low, rel=1e-5)
    force = contact.force()
    assert force[0] == pytest.approx(0.0, abs=1e-8)
    assert force[1] < 0, "the lid presses the block down"


def pushed_without_support(rectangle):
    problem, contact = pressed(rectangle, held=(), force_controlled=True)
    problem.fields[contact.travel_name].vec[:] = 1e-3
    return problem


def test_unheld_body_says_that_it_is_not_held(rectangle):
    problem = pushed_without_support(rectangle)
    problem.set_loads({"lid force [N]": 0.5})
    before = problem.state.vec.FV().NumPy().copy()
    report = solve(problem)
    assert report.outcome is Outcome.SINGULAR
    assert "is the body held" in str(report)
    assert (problem.state.vec.FV().NumPy() == before).all()


def test_unheld_body_makes_the_walk_give_up_with_the_reason(rectangle):
    problem = pushed_without_support(rectangle)
    with pytest.raises(ConvergenceError, match=r"(?s)lid force.*is the body held") as found:
        advance(problem, {"lid force [N]": 0.5})
    assert found.value.report.outcome is Outcome.SINGULAR


def test_surface_under_force_that_touches_nothing_is_singular(rectangle):
    problem, contact = pressed(rectangle, force_controlled=True)
    problem.fields[contact.travel_name].vec[:] = -0.5
    problem.set_loads({"lid force [N]": 1.0})
    report = solve(problem)
    assert report.outcome is Outcome.SINGULAR
    assert "touch" in str(report)


def test_force_is_carried(rectangle):
    problem, contact = pressed(rectangle, force_controlled=True)
    problem.fields[contact.travel_name].vec[:] = 1e-3
    advance(problem, {"lid force [N]": 0.7})
    assert contact.force()[1] == pytest.approx(-0.7, rel=1e-7)


def test_force_is_carried_by_a_curved_outline(rectangle):
    """The prescribed force is exact however coarse the polygon of the outline is."""
    angle = np.linspace(0, np.pi, 13)
    arc = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    corners = np.zeros(13, dtype=bool)
    corners[[0, -1]] = True
    dome = Outline(arc, ("dome",) * 12 + ("foot",), corners)
    plane = Plane(point=(0.0, 1.0), normal_vector=(0.0, -1.0))
    contact = OutlineContact("lid", ("dome",), plane, modulus=1.0, force_controlled=True)
    body = meshed(dome, 0.3)
    problem = Problem(body, PlaneStrain(), [Elasticity(RUBBER), contact], supports=[FixedEdges(("foot",))])
    problem.fields[contact.travel_name].vec[:] = 0.02
    advance(problem, {"lid force [N]": 0.2})
    assert contact.force()[1] == pytest.approx(-0.2, rel=1e-7)


def test_too_few_iterations_are_reported_and_the_state_put_back(rectangle):
    problem, _ = pressed(rectangle)
    problem.set_loads({"lid approach [mm]": 0.2})
    report = solve(problem, NewtonOptions(max_iterations=2))
    assert report.outcome is Outcome.TOO_MANY_ITERATIONS
    assert report.iterations == 2 * 2  # two, and two more with softer contacts
    assert "smaller load steps" in str(report)
    assert np.abs(problem.state.vec.FV().NumPy()).max() == 0


def test_folded_first_guess_is_reported(rectangle):
    problem, _ = pressed(rectangle)
    problem.fields[DISPLACEMENT].Set((0, -1.5 * ng.y))
    report = solve(problem)
    assert report.outcome is Outcome.BAD_START


def test_an_element_that_would_turn_inside_out_is_said_with_its_place(rectangle):
    problem, _ = pressed(rectangle)
    problem.set_loads({"lid approach [mm]": 2.0})
    report = iterate(problem, NewtonOptions())
    assert report.outcome is Outcome.FOLDED
    x, y = report.place
    assert f"an element at ({x:.4g}, {y:.4g}) of the undeformed section would turn inside out" in str(report)
    assert [x, y] in problem.points.centres.tolist()


def test_newton_converges_quadratically(rectangle):
    problem, _ = pressed(rectangle)
    problem.set_loads({"lid approach [mm]": 0.1})
    report = solve(problem, NewtonOptions(tolerance=1e-11))
    assert report.converged
    a, b, c = (x for x in report.corrections[-4:-1])
    assert c < b < a
    assert c < 20 * b**2 or c < 1e-13


def test_crushing_beyond_the_height_gives_up_at_the_last_equilibrium(rectangle):
    problem, _ = pressed(rectangle)
    with pytest.raises(ConvergenceError, match=r"no equilibrium between \d+\.\d% and"):
        advance(problem, {"lid approach [mm]": 1.2}, StepOptions(first=0.5, smallest=0.05))
    reached = problem.get_loads()["lid approach [mm]"]
    assert 0 < reached < 1.0
    again = solve(problem)
    assert again.converged
    assert again.iterations <= 2, "the state is the equilibrium of the loads that are left"


def test_unknown_load_is_refused_and_the_known_ones_named(rectangle):
    problem, _ = pressed(rectangle)
    with pytest.raises(SceneError, match=r"piston.*known: \['lid approach \[mm\]'\]"):
        problem.set_loads({"piston": 1.0})
