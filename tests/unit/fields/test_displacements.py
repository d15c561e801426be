"""Displacements of orders 1 and 3: what a scene and a new mesh make of them."""

from dataclasses import replace

import ngsolve as ng
import pytest
from conftest import FINE, REMEMBERS

from ngwear.effects.base import DISPLACEMENT, VOLUMETRIC_STRESS
from ngwear.effects.elasticity import Elasticity
from ngwear.equilibrium.problem import Problem
from ngwear.equilibrium.state_transfer import transfer
from ngwear.error_estimates.cost_runs import wear_values
from ngwear.fields.displacements import displacements
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.loop.mounting import unworn_body
from ngwear.loop.run import run
from ngwear.loop.stage import Stage
from ngwear.materials import NeoHooke
from ngwear.scene.read_scene import read_scene
from ngwear.verify.builders import meshed

RUBBER = NeoHooke(shear=1.0, bulk_modulus=100.0)
FIELDS = {1: ng.CF((0.1 * ng.x, 0.2 * ng.y)), 2: ng.CF((0.1 * ng.x**2, 0.2 * ng.x * ng.y))}


def block(order, size):
    body = meshed(Outline.rectangle((0.0, 2.0), (0.0, 1.0)), size)
    return Problem(body, PlaneStrain(), [Elasticity(RUBBER, order=order)], order=order)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_unknowns_a_node(order):
    mesh = block(2, 0.5).body.mesh
    found = displacements(mesh, order).ndof
    assert found == 2 * {1: mesh.nv + mesh.ne, 2: mesh.nv + mesh.nedge, 3: mesh.nv + 2 * mesh.nedge + mesh.ne}[order]


@pytest.mark.parametrize(("order", "field"), [(1, 1), (2, 2), (3, 2)])
def test_a_new_mesh_gets_what_both_orders_can_show(order, field):
    old, new = block(order, 0.5), block(order, 0.3)
    old.fields[DISPLACEMENT].Set(FIELDS[field])
    stress = ng.x if order < 3 else ng.x**2
    old.fields[VOLUMETRIC_STRESS].Set(stress)
    (vector,) = transfer(old, [old.state.vec.FV().NumPy().copy()], new)
    new.state.vec.FV().NumPy()[:] = vector
    for name, exact in ((DISPLACEMENT, FIELDS[field]), (VOLUMETRIC_STRESS, stress)):
        off = new.fields[name] - exact
        assert ng.Integrate(ng.InnerProduct(off, off) * ng.dx, new.body.mesh) < 1e-20


@pytest.mark.parametrize("order", [1, 2, 3])
def test_pressures_given_at_both_ends_of_each_edge_are_found_there(sheet, order):
    scene = replace(sheet, accuracy=replace(sheet.accuracy, order=order))
    contact = Stage(scene, unworn_body(scene)).contacts["roller"]
    ends = contact.end_places()[..., 0] ** 2
    field = contact._state[contact.pressure_name]
    field.vec.FV().NumPy()[:] = contact.pressure_vector(ends)
    assert contact.end_pressures() == pytest.approx(ends, abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("changes", [(), REMEMBERS], ids=["elastic", "with memory"])
def test_orders_wear_the_sheet_alike(tmp_path, write_sheet, changes):
    """Order 3 to a thousandth, order 1 to a fiftieth, its contact's ends to an element."""
    found, sheet = {}, read_scene(write_sheet(tmp_path, *FINE, *changes))
    for order, error in ((1, 0.22), (2, 0.05), (3, 0.011)):
        scene = replace(sheet, accuracy=replace(sheet.accuracy, order=order, stress_error=error))
        result = run(scene)
        assert result.status == "completed"
        found[order] = wear_values(scene, result.summary, result.recorder.rows)
    for quantity, value in found[2].items():
        assert found[3][quantity] == pytest.approx(value, rel=1e-3), quantity
        within = {"abs": 2 * sheet.accuracy.patch} if "width" in quantity else {"rel": 2e-2}
        assert found[1][quantity] == pytest.approx(value, **within), quantity
