"""Points followed through a moving mesh, and values kept on a mesh that never changes."""

import ngsolve as ng
import numpy as np
import pytest

from ngwear.effects.elasticity import Elasticity
from ngwear.effects.viscosity import Viscosity
from ngwear.equilibrium.problem import Problem
from ngwear.errors import SceneError
from ngwear.fields.background_mesh import Background, Seat
from ngwear.fields.kinematics import Axisymmetric, PlaneStrain
from ngwear.fields.locator import Locator
from ngwear.geometry.outline import Outline
from ngwear.materials import NeoHooke, PronySeries
from ngwear.verify.builders import meshed

RUBBER = NeoHooke(shear=1.0, bulk_modulus=100.0)
ARMS = PronySeries((0.5, 0.5), (0.1, 10.0))
RNG = np.random.default_rng(2)


@pytest.fixture
def body(circle):
    """A disc of radius 1 about (0, 2)."""
    return meshed(circle(60, centre=(0.0, 2.0)), 0.3)


def places(mesh, mapped):
    return np.stack([np.asarray(c(mapped)) for c in (ng.x, ng.y)], axis=-1).reshape(-1, 2)


def in_disc(n, radius):
    angle, r = RNG.uniform(0, 2 * np.pi, n), radius * np.sqrt(RNG.uniform(0, 1, n))
    return np.stack([r * np.cos(angle), 2 + r * np.sin(angle)], axis=1)


def shrunk(contour, depth, over):
    """The outline with its upper part worn by up to ``depth``."""
    points = contour.points.copy()
    height = np.clip((points[:, 1] - (3 - over)) / over, 0, 1)
    points[:, 1] -= depth * height
    return Outline(points, contour.names, contour.corners)


def test_points_are_found_in_a_mesh_that_has_moved_with_its_outline(body):
    points = in_disc(3000, 0.999)
    locator = Locator(body.mesh, points)
    body.move_to(shrunk(body.contour, 0.15, 0.8))
    locator.follow(points)
    inside = points[:, 1] < 2 + np.sqrt(1 - points[:, 0] ** 2) - 0.16
    assert locator.inside[inside].all()
    assert places(body.mesh, locator.mapped)[locator.inside] == pytest.approx(points[locator.inside], abs=1e-9)
    assert not locator.inside.all(), "some have been worn away"
    lost = ~locator.inside
    off = np.linalg.norm(places(body.mesh, locator.mapped)[lost] - points[lost], axis=1)
    assert off.max() < 0.2, "each of them stands for a point near by"
    body.move_to(body.base)
    locator.follow(points)
    assert places(body.mesh, locator.mapped)[locator.inside] == pytest.approx(points[locator.inside], abs=1e-9)


def test_a_place_does_not_depend_on_the_way_there(body):
    """A resumed run starts its searches afresh and shall end with the same bits."""
    points = in_disc(500, 0.95)
    followed = Locator(body.mesh, points)
    for depth in (0.05, 0.1, 0.15):
        body.move_to(shrunk(body.base, depth, 0.8))
        followed.follow(points)
    afresh = Locator(body.mesh, points)
    for name in ("x", "y", "nr"):
        assert (followed.mapped[name] == afresh.mapped[name]).all()


def test_quadratic_values_pass_from_the_background_to_a_body_unchanged(body, circle):
    background = Background(meshed(circle(60, centre=(0.0, 2.0)), 0.25))
    problem = Problem(body, PlaneStrain(), [Elasticity(RUBBER)])
    seat = Seat(
        background,
        body=body,
        kinematics=PlaneStrain(),
        points=problem.points,
        displacement=problem.fields["displacement"],
    )
    body.move_to(shrunk(body.contour, 0.1, 0.8))
    problem.points.follow()

    def values(at):
        x, y = np.moveaxis(at, -1, 0)
        return np.stack([1 + x - 2 * y, x * x, x * y], axis=-1)

    found, wanted = seat.at_points(values(background.places)), values(problem.points.places)
    inner = np.linalg.norm(problem.points.places - (0, 2), axis=-1) < 0.6  # elements with straight edges
    assert found[inner] == pytest.approx(wanted[inner], abs=1e-10)
    assert found == pytest.approx(wanted, abs=5e-3)


@pytest.mark.parametrize("kinematics", [PlaneStrain(), Axisymmetric()])
def test_strain_at_the_background_is_the_body_s(body, kinematics):
    problem = Problem(body, kinematics, [Elasticity(RUBBER)])
    problem.fields["displacement"].Set(ng.CF((0.1 * ng.x + 0.02 * ng.y, -0.05 * ng.x + 0.2 * ng.y)))
    seat = Seat(
        Background(body),
        body=body,
        kinematics=kinematics,
        points=problem.points,
        displacement=problem.fields["displacement"],
    )
    strain = seat.strain().reshape(-1, 6)
    assert strain[:, :4] == pytest.approx(np.tile([0.1, 0.02, -0.05, 0.2], (len(strain), 1)), abs=1e-9)
    y, x = seat.background.places[..., 1].ravel(), seat.background.places[..., 0].ravel()
    hoop = (-0.05 * x + 0.2 * y) / y if kinematics.axisymmetric else np.zeros_like(y)
    assert strain[:, 4] == pytest.approx(hoop, abs=1e-9)
    assert (strain[:, 5] == 0).all()


def test_memory_passes_to_another_mesh_by_a_shared_background_only(body, circle):
    background = Background(body)
    old, new = (Viscosity(RUBBER, ARMS, background=background) for _ in range(2))
    first = Problem(body, PlaneStrain(), [Elasticity(RUBBER), old])
    first.fields["displacement"].Set(ng.CF((0.1 * ng.x, 0)))
    first.set_time_step(0.1)
    first.commit()
    other = meshed(circle(60, centre=(0.0, 2.0)), 0.2)
    second = Problem(other, PlaneStrain(), [Elasticity(RUBBER), new])
    new.take(old)
    assert (new.relaxed == old.relaxed).all()
    for problem in (first, second):
        problem.set_time_step(0.2)
    assert new.history.mean(axis=(0, 1)) == pytest.approx(old.history.mean(axis=(0, 1)), rel=1e-6)
    assert len(new.history) == other.mesh.ne != len(old.history)
    assert second.points is not None
    with pytest.raises(SceneError, match="background of both"):
        new.take(Viscosity(RUBBER, ARMS))
