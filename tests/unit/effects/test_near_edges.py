"""Contacts of a part with room to move: only edges that may touch are integrated, and the result is that of all."""

from dataclasses import replace

import numpy as np
import pytest

import ngwear as nw
from ngwear.effects import rigid_motion
from ngwear.loop.element_sizes import coarse_for_mounting, with_mounting_lengths
from ngwear.loop.mounting import unworn_body
from ngwear.loop.stage import Stage

SCENES = ["geometries/o_ring/scene.toml", "geometries/d_ring/scene.toml"]


def stage(scene, *, all_edges, monkeypatch):
    coarse = coarse_for_mounting(with_mounting_lengths(replace(scene, accuracy=nw.Accuracy.draft())))
    with monkeypatch.context() as patch:
        if all_edges:
            begin = rigid_motion.RigidMotion.__init__

            def init(self, directions, contacts, **kwargs):
                begin(self, directions, contacts, **kwargs)
                for contact in contacts:
                    contact.only_near = False

            patch.setattr(rigid_motion.RigidMotion, "__init__", init)
        return Stage(coarse, unworn_body(coarse, 6.0))


def residual_and_tangent(problem, vector, loads):
    """Of a state, after a solve has begun at the part at rest."""
    problem.set_loads(loads)
    problem.state.vec[:] = 0.0
    for term in problem.terms:
        term.prepare()
    problem.state.vec.FV().NumPy()[:] = vector
    out = problem.state.vec.CreateVector()
    problem.residual(out)
    matrix = problem.assemble()
    product = problem.state.vec.CreateVector()
    product.data = matrix * problem.state.vec
    return out.FV().NumPy().copy(), product.FV().NumPy().copy()


@pytest.mark.parametrize("path", SCENES)
def test_it_is_the_equilibrium_of_all_edges(path, monkeypatch):
    scene = nw.read_scene(path)
    near, every = (stage(scene, all_edges=some, monkeypatch=monkeypatch) for some in (False, True))
    problem = near.problem
    rng = np.random.default_rng(0)
    state = problem.state.vec.FV().NumPy()
    state[:] = 0.02 * rng.standard_normal(problem.space.ndof)
    for name, contact in near.contacts.items():
        touches = rng.random(len(contact.positions)) < 0.3
        ends = 0.02 * rng.standard_normal((len(touches), 2)) * touches[:, None]
        state[problem.part(contact.pressure_name)] = contact.pressure_vector(ends)
        if name in near.sticking:
            (traction,) = near.sticking[name].tractions
            contact.set_edge_values(problem.fields[traction], ends[:, 0])
    vector = state.copy()
    loads = near.stroke_loads(scene.program.cycle[-1])
    found = residual_and_tangent(problem, vector, loads)
    wanted = residual_and_tangent(every.problem, vector, loads)
    for value, reference in zip(found, wanted, strict=True):
        assert np.abs(value - reference).max() < 1e-12 * np.abs(reference).max()
    contacts = near.contacts.values()
    assert 0 < sum(contact.near.NumSet() for contact in contacts) < sum(len(c.positions) for c in contacts)


def test_a_surface_finds_the_edges_that_it_meets(monkeypatch):
    """An edge that was far at the beginning of a solve is added when the part comes near."""
    scene = nw.read_scene(SCENES[0])
    near = stage(scene, all_edges=False, monkeypatch=monkeypatch)
    problem, wall = near.problem, near.contacts["air wall"]
    problem.set_loads(near.stroke_loads(scene.program.cycle[-1]))
    for term in problem.terms:
        term.prepare()
    out = problem.state.vec.CreateVector()
    problem.residual(out)
    before = wall.near.NumSet()
    part = problem.part("displacement")
    x = slice(part.start, part.start + (part.stop - part.start) // 2)
    vertices = problem.body.mesh.nv
    problem.state.vec.FV().NumPy()[x][:vertices] -= 1.3
    problem.residual(out)
    assert wall.near.NumSet() > before
