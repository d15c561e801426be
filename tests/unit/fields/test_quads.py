import blocks
import ngsolve as ng
import numpy as np
import pytest
from ngsolve.meshes import MakeHexMesh
from test_material_points import MATERIAL, symbolic

from ngwear.effects.base import DISPLACEMENT, VOLUMETRIC_STRESS
from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.friction import FullSliding
from ngwear.equilibrium.newton import NewtonOptions
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance, relax
from ngwear.errors import MeshError
from ngwear.fields.element_shapes import Cells
from ngwear.fields.kinematics import Axisymmetric, PlaneStrain
from ngwear.geometry import nodal
from ngwear.geometry.outline import Outline
from ngwear.materials import NeoHooke
from ngwear.surfaces import Cylinder
from ngwear.verify import convergence, locking
from ngwear.verify.builders import meshed
from ngwear.verify.tangents import tangent_error

HALVED = {"quads": lambda i, j: False, "mixed": blocks.checkered}
KINEMATICS = {"plane strain": PlaneStrain(), "axisymmetric": Axisymmetric()}
by_mesh = pytest.mark.parametrize("halved", HALVED.values(), ids=HALVED)
by_kinematics = pytest.mark.parametrize("kinematics", KINEMATICS.values(), ids=KINEMATICS)
TIGHT = StepOptions(newton=NewtonOptions(tolerance=1e-11))


def problem(body, kinematics=KINEMATICS["plane strain"], *, order=2, supports=(), terms=()) -> Problem:
    return Problem(body, kinematics, [Elasticity(MATERIAL, order=order), *terms], supports=supports, order=order)


def set_waves(problem: Problem) -> None:
    """An admissible state with strains of some 10 %."""
    problem.fields[DISPLACEMENT].Set(ng.CF((0.1 * ng.sin(ng.x + ng.y), 0.1 * ng.cos(ng.x * ng.y))))
    problem.fields[VOLUMETRIC_STRESS].Set(ng.sin(ng.x))


def set_displacement(problem: Problem, function) -> None:
    """Give the displacement its values at the nodes."""
    body = problem.body
    body.set_nodal(problem.fields[DISPLACEMENT], function(body.node_places()))


def residual(problem: Problem) -> np.ndarray:
    out = problem.state.vec.CreateVector()
    problem.residual(out)
    return out.FV().NumPy().copy()


def energy(problem: Problem) -> float:
    strain = problem.points.strain(problem.state.vec.FV().NumPy())
    return float((problem.points.volumes * problem.terms[0].energy(strain)).sum())


def close(found, expected, tolerance=1e-12):
    np.testing.assert_allclose(found, expected, atol=tolerance * np.abs(expected).max(), rtol=0)


@by_mesh
@by_kinematics
@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize("moved", [False, True], ids=["as meshed", "outline moved"])
def test_points_give_what_ngsolve_gives(halved, kinematics, order, moved):
    body = blocks.Block(5, 4, image=blocks.wavy, halved=halved)
    at = problem(body, kinematics, order=order)
    if moved:
        body.deformation = ng.GridFunction(ng.VectorH1(body.mesh, order=2))
        body.deformation.Set(ng.CF((0.02 * ng.sin(3 * ng.y), 0.01 * ng.cos(2 * ng.x))))
        body.mesh.SetDeformation(body.deformation)
        body.moves += 1
        at.points.follow()
    set_waves(at)
    form, state = symbolic(at, at.terms[0]), at.state.vec
    assert energy(at) == pytest.approx(form.Energy(state), rel=1e-12)
    expected, found = state.CreateVector(), state.CreateVector()
    form.Apply(state, expected)
    close(residual(at), expected.FV().NumPy())
    form.AssembleLinearization(state)
    direction = state.CreateVector()
    direction.FV().NumPy()[:] = np.random.default_rng(1).normal(size=len(direction))
    expected.data, found.data = form.mat * direction, at.assemble() * direction
    close(found.FV().NumPy(), expected.FV().NumPy())


@by_mesh
@by_kinematics
def test_tangent_agrees_with_finite_differences(halved, kinematics):
    at = problem(blocks.Block(4, 3, image=blocks.wavy, halved=halved), kinematics)
    set_waves(at)
    assert tangent_error(at, np.random.default_rng(7)) < 1e-8


@by_mesh
def test_places_volumes_and_means_leave_out_what_fills_up(halved):
    body = blocks.Block(5, 4, image=blocks.wavy, halved=halved)
    for kinematics in KINEMATICS.values():
        points = problem(body, kinematics).points
        assert points.volumes.sum() == pytest.approx(ng.Integrate(kinematics.weight * ng.dx, body.mesh), rel=1e-13)
    corners = [[body.mesh[v].point for v in element.vertices] for element in body.mesh.Elements(ng.VOL)]
    kinds = {3: ng.TRIG, 4: ng.QUAD}
    for own, places, volumes in zip(corners, points.places, points.volumes, strict=True):
        rule = ng.IntegrationRule(kinds[len(own)], 4).points
        vertex_shapes = np.array([ng.fem.H1FE(kinds[len(own)], 1).CalcShape(*p) for p in rule])
        np.testing.assert_allclose(places[: len(rule)], vertex_shapes @ own, atol=1e-14)
        assert (volumes > 0).sum() == (volumes[: len(rule)] > 0).sum() == len(rule)
    np.testing.assert_allclose(points.radius, points.places[..., 1])
    areas = np.array(ng.Integrate(1, body.mesh, element_wise=True))
    np.testing.assert_allclose(points.centres, [np.mean(c, axis=0) for c in corners], atol=1e-13)
    quads = np.array([len(c) == 4 for c in corners])
    np.testing.assert_allclose(points.edges, np.sqrt(areas * np.where(quads, 1.0, 4 / np.sqrt(3))))


@by_mesh
def test_recovery_keeps_what_is_linear_in_the_elements_and_smooths_the_rest(halved):
    body = blocks.Block(5, 4, image=lambda x: x @ [[2.0, 0.3], [0.2, 1.0]], halved=halved)
    points = problem(body).points
    linear = points.places @ [[1.0, 0.5], [-2.0, 3.0]] + 1
    close(points.recovered(linear), linear, 1e-12)
    jumps = np.broadcast_to(np.arange(body.mesh.ne)[:, None, None], (*points.volumes.shape, 1))
    vertices = [[v.nr for v in element.vertices] for element in body.mesh.Elements(ng.VOL)]
    mean, area = np.zeros((2, body.mesh.nv))
    for value, corners, size in zip(range(body.mesh.ne), vertices, points.volumes.sum(axis=1), strict=True):
        mean[corners] += value * size
        area[corners] += size
    field = ng.GridFunction(ng.H1(body.mesh, order=1))
    field.vec.FV().NumPy()[:] = mean / area
    expected = [field(body.mesh(*p)) for p in points.places.reshape(-1, 2)]
    np.testing.assert_allclose(points.recovered(jumps).ravel(), expected, atol=1e-9)


@by_mesh
def test_nodal_values_come_back_and_set_a_displacement_exactly(halved):
    body = blocks.Block(4, 3, image=lambda x: x @ [[2.0, 0.3], [0.2, 1.0]], halved=halved)
    space = ng.H1(body.mesh, order=2)
    values = np.random.default_rng(3).normal(size=space.ndof)
    np.testing.assert_allclose(
        nodal.join(nodal.split(values, body.edges, body.quads), body.edges, body.quads), values, atol=1e-13
    )
    field = ng.GridFunction(space)
    field.vec.FV().NumPy()[:] = values
    found = [field(body.mesh(*p)) for p in body.node_places()]
    np.testing.assert_allclose(nodal.split(values, body.edges, body.quads), found, atol=1e-12)
    at = problem(body)
    set_displacement(at, lambda x: np.column_stack([x[:, 0] ** 2 - x[:, 0] * x[:, 1], 1 + x[:, 1] ** 2]))
    off = at.fields[DISPLACEMENT] - ng.CF((ng.x**2 - ng.x * ng.y, 1 + ng.y**2))
    assert ng.Integrate(off * off, body.mesh) < 1e-25


def test_a_biquadratic_displacement_is_set_exactly_on_parallelograms():
    slanted = np.array([[2.0, 0.3], [0.2, 1.0]])
    at = problem(blocks.Block(4, 3, image=lambda x: x @ slanted))
    back = np.linalg.inv(slanted)
    a, b = (back[0, k] * ng.x + back[1, k] * ng.y for k in range(2))
    set_displacement(at, lambda x: np.column_stack([np.prod(x @ back, axis=1) ** 2, (x @ back)[:, 0] ** 2]))
    off = at.fields[DISPLACEMENT] - ng.CF((a * a * b * b, a * a))
    assert ng.Integrate(off * off, at.body.mesh) < 1e-25


@by_mesh
def test_an_affine_displacement_of_the_outline_makes_a_homogeneous_stress(halved):
    body = blocks.Block(5, 4, image=blocks.wavy, halved=halved)
    at = problem(body, supports=[FixedEdges(blocks.SIDES)])
    slope = np.array([[0.05, 0.12], [-0.04, -0.03]])
    set_displacement(at, lambda x: x @ slope.T)
    exact = at.fields[DISPLACEMENT].vec.FV().NumPy().copy()
    free = np.fromiter(at.free, dtype=bool)
    at.state.vec.FV().NumPy()[free] += np.random.default_rng(2).uniform(-0.01, 0.01, free.sum())
    relax(at, TIGHT)
    close(at.fields[DISPLACEMENT].vec.FV().NumPy(), exact, 1e-9)
    strain = at.points.strain(at.state.vec.FV().NumPy())
    np.testing.assert_allclose(strain[..., :4], np.broadcast_to(slope.ravel(), strain[..., :4].shape), atol=1e-9)
    stress, _ = at.terms[0].response(strain, tangent=False)
    p = at.terms[0].split[1] * (np.linalg.det(np.eye(2) + slope) - 1)
    one, _ = at.terms[0].response(np.array([*slope.ravel(), 0.0, p]), tangent=False)
    np.testing.assert_allclose(stress[..., :5], np.broadcast_to(one[:5], stress[..., :5].shape), atol=1e-7)


def cut(n: int, halved) -> blocks.Block:
    """Square of 1 mm, distorted inside, 1 mm from the axis of the rings of the reference cases."""

    def image(x):
        off = 0.08 * np.sin(np.pi * x).prod(axis=1)
        return np.column_stack([0.8, 0.6]) + x + off[:, None] * np.cos(5 * x[:, ::-1])

    return blocks.Block(n, n, image=image, halved=halved)


@by_mesh
def test_displacements_converge_with_the_third_power_of_the_edge(halved):
    errors = [convergence.cut_error(cut(n, halved)) for n in (4, 8, 16)]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert (orders > convergence.LEAST_ORDER).all(), f"observed orders {orders}"


@by_mesh
def test_nothing_locks(halved):
    soft, stiff = (locking.cut_error(ratio, cut(5, halved)) for ratio in (1e2, 1e5))
    assert stiff < locking.GROWTH * soft
    assert stiff < locking.TOLERANCE


@by_mesh
@by_kinematics
def test_an_element_left_out_takes_its_own_share_along(halved, kinematics):
    shape = {"image": blocks.wavy, "halved": halved}
    whole = blocks.Block(5, 4, **shape)
    left_out = (0, 7, 8)
    rest = blocks.Block(5, 4, **shape, without=left_out)
    both = []
    for body in (whole, rest):
        at = problem(body, kinematics)
        set_displacement(at, lambda x: 0.05 * np.column_stack([np.sin(x.sum(axis=1)), np.cos(x.prod(axis=1))]))
        vertices = np.array(body.mesh.ngmesh.Coordinates())[:, :2]
        at.fields[VOLUMETRIC_STRESS].vec.FV().NumPy()[:] = np.sin(vertices[:, 0])
        both.append(at)
    strain = both[0].points.strain(both[0].state.vec.FV().NumPy())
    share = (both[0].points.volumes * both[0].terms[0].energy(strain)).sum(axis=1)
    assert energy(both[0]) - energy(both[1]) == pytest.approx(share[list(left_out)].sum(), rel=1e-10)
    stress, _ = both[0].terms[0].response(strain, tangent=False)
    forces = both[0].points.forces(stress)
    vertices = whole.mesh.nv
    of_those = np.zeros(both[0].space.ndof)
    np.add.at(of_those, both[0].points.unknowns[list(left_out)], forces[list(left_out)])
    expected = [(residual(both[0]) - of_those)[at.start : at.start + vertices] for at in _parts(both[0])]
    found = [residual(both[1])[at.start : at.start + vertices] for at in _parts(both[1])]
    close(np.array(found), np.array(expected), 1e-12)


def _parts(problem: Problem) -> list[slice]:
    """Where the unknowns at the vertices of ux, uy and p begin."""
    u, p = problem.part(DISPLACEMENT), problem.part(VOLUMETRIC_STRESS)
    half = (u.stop - u.start) // 2
    return [slice(u.start, u.start + half), slice(u.start + half, u.stop), p]


def test_elements_of_another_type_are_refused():
    with pytest.raises(MeshError, match=r"\[8\] corners"):
        Cells(MakeHexMesh(nx=1, ny=1, nz=1), 2)


def rolled(body) -> OutlineContact:
    """A roller under force that slides on a bonded block."""
    roller = Cylinder(centre=(0.0, 4.0), radius=2.0)
    contact = OutlineContact("roller", ("top",), roller, force_controlled=True, modulus=1.0)
    terms = [Elasticity(NeoHooke(shear=1.0, bulk_modulus=1000.0)), contact, FullSliding(contact, 0.3)]
    at = Problem(body, PlaneStrain(), terms, supports=[FixedEdges(("bottom",))])
    at.fields[contact.travel_name].vec[0] = 0.05
    advance(at, {"roller force [N]": 0.5, "roller slip": 1.0})
    assert residual(at)[at.part(DISPLACEMENT)] == pytest.approx(0.0, abs=1e-6)
    return contact


@pytest.fixture(scope="module")
def peak_on_triangles():
    seeds = np.column_stack([np.linspace(-0.6, 0.6, 25), np.full(25, 2.0)])
    return rolled(meshed(Outline.rectangle((-2.0, 2.0), (0.0, 2.0)), 0.3, seeds, 0.05)).peak()


@by_mesh
def test_contact_with_friction_is_solved(halved, peak_on_triangles):
    def image(x):
        return np.column_stack([4 * x[:, 0] - 2, 2 * (1 - (1 - x[:, 1]) ** 2)])

    contact = rolled(blocks.Block(60, 12, image=image, halved=halved))
    assert contact.peak() == pytest.approx(peak_on_triangles, rel=0.02)
