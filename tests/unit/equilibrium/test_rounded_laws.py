"""Laws rounded off lead to the same equilibrium as those with corners; so does a part that moves over to a wall."""

import ngsolve as ng
import numpy as np
import pytest

import ngwear as nw
from ngwear.effects.rounding import Rounding
from ngwear.equilibrium import attempts
from ngwear.equilibrium.newton import NewtonOptions, Outcome, Report, iterate
from ngwear.geometry.outline import Outline
from ngwear.loop.stepper import Stepper
from ngwear.surfaces import Plane

MODULUS, PRESSURE, ROOM = 1.0, 0.3, 0.2


def scene():
    """A block that friction holds on a table and that the fluid pushes over to the wall on its left."""
    table = nw.Contact(
        "table",
        edges=["bottom"],
        surface=Plane(point=(0.0, 0.02), normal_vector=(0.0, 1.0)),
        slides=False,
        friction=0.1,
    )
    lid = nw.Contact("lid", edges=["top"], surface=Plane(point=(0.0, 0.98), normal_vector=(0.0, -1.0)), slides=False)
    wall = nw.Contact("wall", edges=["left"], surface=Plane(point=(-ROOM, 0.0), normal_vector=(1.0, 0.0)), slides=False)
    stroke = {"travel": 1.0, "pressure": PRESSURE}
    return nw.Scene(
        "block",
        nw.Part(
            Outline.rectangle((0.0, 2.0), (0.0, 1.0)), material=nw.NeoHooke(shear=MODULUS, bulk_modulus=100 * MODULUS)
        ),
        contacts=[table, lid, wall],
        axisymmetric=False,
        fluid=nw.Fluid(edges=["right"], inlet=["right"]),
        program=nw.Program(strokes=2, cycle=[nw.Stroke("out", direction=-1, **stroke)]),
        accuracy=nw.Accuracy(patch=0.2, coarse=0.5, mounting=0.2),
    )


def solved():
    stepper = Stepper(scene())
    return stepper.start().stage


@pytest.mark.parametrize("width", [0.1, 2.0])
def test_the_rounded_corner_is_the_derivative_of_its_square_and_the_corner_elsewhere(width):
    section = Outline.rectangle((0.0, 1.0), (0.0, 1.0))
    assert len(section.points) == 4
    rounding, x = Rounding(MODULUS), ng.Parameter(0.0)
    rounding.set(width)
    positive, square = rounding.positive(x), rounding.square(x)
    mesh = ng.Mesh(_unit_square())

    def at(value, expression):
        x.Set(value)
        return expression(mesh(0.5, 0.5))

    for value in (-2 * width, -0.5 * width, 0.3 * width, 3 * width):
        step = 1e-5 * width
        slope = (at(value + step, square) - at(value - step, square)) / (2 * step)
        assert slope == pytest.approx(2 * at(value, positive), abs=1e-6 * width)
        if abs(value) > width:
            assert at(value, positive) == max(0.0, value)


def _unit_square():
    from netgen.geom2d import unit_square

    return unit_square.GenerateMesh(maxh=1.0)


def test_rounded_laws_end_at_the_equilibrium_of_the_laws_with_corners(monkeypatch):
    stage = solved()
    problem = stage.problem
    start = problem.state.vec.FV().NumPy().copy()
    stage.begin(start)
    problem.set_loads({"fluid pressure [MPa]": 1.2 * PRESSURE, "table approach [mm]": 0.01})
    assert attempts.solve(problem).converged
    plain = {name: contact.force() for name, contact in stage.contacts.items()}

    def only_damped(problem, options):
        return iterate(problem, options) if options.damped else Report(Outcome.STALLED)

    monkeypatch.setattr(attempts, "iterate", only_damped)
    problem.state.vec.FV().NumPy()[:] = start
    report = attempts.solve(problem)
    assert report.converged
    assert report.rounded
    for name, contact in stage.contacts.items():
        assert contact.force() == pytest.approx(plain[name], abs=1e-6 * PRESSURE)


def test_a_part_moves_over_to_the_wall_and_no_spring_is_left():
    stage = solved()
    problem = stage.problem
    problem.state.vec[:] = 0.0
    assert attempts._move_over(problem, NewtonOptions(damped=True)).converged
    residual = problem.state.vec.CreateVector()
    problem.residual(residual)
    assert np.abs(residual.FV().NumPy()).max() < 1e-6 * PRESSURE
    assert stage.contacts["wall"].force()[0] > 0.5 * PRESSURE


def test_the_fluid_goes_along_with_a_part_that_moves_over_and_is_put_back_if_that_fails(monkeypatch):
    stage = solved()
    problem, fluid = stage.problem, stage.fluids["fluid"]
    where, hold_back = [], attempts._hold_back
    monkeypatch.setattr(
        attempts, "_hold_back", lambda held, strength: (where.append(fluid.on_edges), hold_back(held, strength))
    )
    left = fluid.on_edges
    fluid.on_edges = 0.0 * left
    problem.state.vec[:] = 0.0
    assert attempts._move_over(problem, NewtonOptions(damped=True)).converged
    assert not where[0].any()
    assert where[-1] == pytest.approx(left, abs=0.01), "nobody but the way itself has put it there"

    def fails(problem, options):
        if options.damped:
            fluid.on_edges = 0.0 * left
        return Report(Outcome.STALLED)

    before = fluid.on_edges
    monkeypatch.setattr(attempts, "iterate", fails)
    assert not attempts.solve(problem).converged
    assert fluid.on_edges == pytest.approx(before)


def test_a_way_ends_where_much_stronger_springs_are_needed(monkeypatch):
    """Springs of 1/16 hold the part; from then on none does, however stiff: it is not tried up to the stiffest."""
    problem = solved().problem
    tried: list[float] = []
    hold_back = attempts._hold_back
    monkeypatch.setattr(
        attempts, "_hold_back", lambda where, strength: (tried.append(strength), hold_back(where, strength))
    )

    def holds_to_a_sixteenth(problem, options):
        bears = min(tried) >= 1 / 16 and tried[-1] == min(tried)
        return Report(Outcome.CONVERGED if bears else Outcome.STALLED, iterations=1)

    monkeypatch.setattr(attempts, "iterate", holds_to_a_sixteenth)
    monkeypatch.setattr(attempts, "FAILURES", 100)
    report = attempts._move_over(problem, NewtonOptions(damped=True), rises=64.0)
    assert not report.converged
    assert min(tried[:-1]) == pytest.approx(1 / 64)
    assert 1.0 < max(tried[3:]) <= 64 / 16
    assert tried[-1] == 0.0
