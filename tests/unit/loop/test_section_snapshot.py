"""Stress, stretch and places of kept sections against closed forms, through a run's result file."""

import math
from dataclasses import replace

import h5py
import ngsolve as ng
import numpy as np
import pytest

from ngwear.errors import ConvergenceError
from ngwear.fields.element_nodes import ElementNodes
from ngwear.loop.run import GAVE_UP, run
from ngwear.loop.stepper import Stepper
from ngwear.materials import MooneyRivlin
from ngwear.results.kept_sections import KeptSections
from ngwear.results.result_file import read_result
from ngwear.results.section import Section
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Support
from ngwear.scene.contact import Contact
from ngwear.scene.options import Save
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Plane, rod
from ngwear.verify.builders import meshed
from ngwear.verify.closed_forms import expanding_pressure

C10, C01 = 0.6, 0.15
RUBBER = MooneyRivlin(c10=C10, c01=C01, bulk_modulus=1500.0)
G = 2 * (C10 + C01)


def section_of(scene, folder):
    run(scene, out=folder, figures=False)
    return Section.of(KeptSections.of(read_result(folder)).at().section)


def scene_of(outline, order=2, **rest):
    accuracy = Accuracy(patch=0.5, coarse=0.5, mounting=0.5, order=order)
    program = Program(cycle=(Stroke("stroke", travel=1.0),), strokes=1)
    return Scene("block", Part(outline, RUBBER), program=program, accuracy=accuracy, **rest)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_squeezed_block_has_uniform_stress(rectangle, tmp_path, order):
    """Neither friction nor hold across: sigma_x = 0, and the stretches are 1 / l, l and 1 with l = 0.8."""
    top = Contact("plate", edges=("top",), surface=Plane(point=(0.0, 1.6), normal_vector=(0.0, -1.0)), refine=True)
    supports = (Support(edges=("bottom",), x=False), Support(edges=("left",), y=False))
    scene = scene_of(rectangle(4.0, 2.0, 8, 4), order, contacts=(top,), supports=supports, axisymmetric=False)
    section = section_of(scene, tmp_path / "out")
    x2, y2 = 1 / 0.64, 0.64
    stress = {k: 2 * C10 * v - 2 * C01 / v for k, v in (("x", x2), ("y", y2), ("z", 1.0))}
    xx, yy, xy, zz = section.stress.T
    assert yy == pytest.approx(stress["y"] - stress["x"], rel=3e-3)
    assert zz == pytest.approx(stress["z"] - stress["x"], rel=3e-3)
    assert xx == pytest.approx(0.0, abs=3e-3)
    assert xy == pytest.approx(0.0, abs=3e-3)
    assert section.stretch == pytest.approx(1.25, rel=2e-3)
    assert section.points.max(axis=0) == pytest.approx([5.0, 1.6], rel=2e-3)
    assert section.contacts["plate"].pressure == pytest.approx(stress["x"] - stress["y"], rel=3e-3)
    a, b, c = stress["x"], stress["y"], stress["z"]
    mises = math.sqrt(0.5 * ((a - b) ** 2 + (b - c) ** 2 + (c - a) ** 2))
    assert section.field("von mises stress") == pytest.approx(mises, rel=5e-3)
    assert section.field("maximum principal stress") == pytest.approx(0.0, abs=3e-3)
    assert section.field("minimum principal stress [MPa]") == pytest.approx(stress["y"] - stress["x"], rel=3e-3)
    assert section.field("maximum shear stress") == pytest.approx(0.5 * (a - b), rel=3e-3)
    assert section.field("mean pressure") == pytest.approx((3 * a - (a + b + c)) / 3, rel=3e-3)


def test_ring_on_a_rod_has_hoop_stress(rectangle, tmp_path):
    """A long ring from 5 to 10 mm of radius on a rod of 6 mm, held axially: Rivlin's solution of large strain."""
    outline = rectangle(2.0, 5.0, 4, 10).moved(np.tile([0.0, 5.0], (28, 1)))
    contact = Contact("rod", edges=("bottom",), surface=rod(12.0), refine=True)
    section = section_of(
        scene_of(outline, contacts=(contact,), supports=(Support(edges=("left", "right"), y=False),)), tmp_path / "out"
    )
    place = section.points[: len(section.stress)]
    r, radius = place[:, 1], np.sqrt(place[:, 1] ** 2 - 11.0)
    hoop = (r / radius) ** 2
    pressure = np.array([expanding_pressure(G, a, 10.0, b) for a, b in zip(radius, r, strict=True)])
    xx, yy, _, zz = section.stress.T
    assert -yy == pytest.approx(pressure, abs=0.02)
    assert zz - yy == pytest.approx(G * (hoop - 1 / hoop), abs=0.02)
    assert xx - yy == pytest.approx(2 * C10 * (1 - 1 / hoop) - 2 * C01 * (1 - hoop), abs=0.02)
    assert section.stretch == pytest.approx(np.sqrt(hoop), rel=5e-3)
    assert section.contacts["rod"].place[:, 1] == pytest.approx(6.0, abs=1e-4)


def test_surface_under_force_stands_where_the_part_is(finished):
    for snapshot in KeptSections.of(read_result(finished)).snapshots:
        section = Section.of(snapshot.section)
        roller = section.contacts["roller"]
        on = roller.pressure > 0.05
        place = roller.place[on] - roller.moved
        assert np.hypot(place[:, 0] - 2.0, place[:, 1] - 3.99) == pytest.approx(2.0, abs=0.01)
        assert roller.moved[0] == pytest.approx(0.0, abs=1e-9)
        assert roller.moved[1] < -0.02


def test_edges_follow_a_curved_outline(circle):
    """Midpoints lie on the circle, not on its chords."""
    body = meshed(circle(60), 0.3)
    nodes = ElementNodes(body.mesh)
    place = nodes.values(ng.CF((ng.x, ng.y)))
    section = Section.of(
        {
            "points [mm]": place,
            "displacement [mm]": np.zeros_like(place),
            "triangles": nodes.triangles,
            "quadrilaterals": nodes.quadrilaterals,
            "stress xx, yy, xy, zz [MPa]": np.zeros((body.mesh.nv, 4)),
            "maximum principal stretch [-]": np.ones(body.mesh.nv),
        }
    )
    border = section.border
    assert np.hypot(*place[border].reshape(-1, 2).T) == pytest.approx(1.0, abs=1e-4)
    assert len(border) == len(body.outline.names)
    (loop,) = section.loops()
    assert len(loop) == len(border)


def test_sections_are_kept_new_at_marks_and_worn(tmp_path, sheet):
    run(replace(sheet, save=Save(strokes=(2,))), out=tmp_path / "out", figures=False)
    kept = KeptSections.of(read_result(tmp_path / "out"))
    assert [s.stroke for s in kept.snapshots] == [0, 2, 4]
    assert {v.dtype.kind + str(v.dtype.itemsize) for s in kept.snapshots for v in s.section.values()} == {"f4", "i4"}


def test_names_in_the_file_hold_no_slash(finished):
    with h5py.File(finished / "result.h5") as h5:
        for group in h5["strokes"].values():
            if "section" in group:
                assert all(isinstance(item, h5py.Dataset) for item in group["section"].values())


def test_run_that_gives_up_keeps_its_last_section(tmp_path, sheet, monkeypatch):
    advance = Stepper.advance

    def fails(self, state):
        if state.strokes == 2:
            raise ConvergenceError("on purpose")
        return advance(self, state)

    monkeypatch.setattr(Stepper, "advance", fails)
    result = run(sheet, out=tmp_path / "out", figures=False, throw=False)
    assert result.status == GAVE_UP
    kept = KeptSections.of(read_result(tmp_path / "out"))
    assert [s.stroke for s in kept.snapshots] == [0, 2]
    new, last = (Section.of(s.section) for s in kept.snapshots)
    assert last.contacts["roller"].moved[1] < new.contacts["roller"].moved[1] - 1e-3


def test_section_without_equilibrium_is_left_out(tmp_path, sheet, monkeypatch):
    def fails(*_):
        raise ConvergenceError("on purpose")

    monkeypatch.setattr(Stepper, "advance", fails)
    monkeypatch.setattr(Stepper, "solve_next_cycle", fails)
    result = run(sheet, out=tmp_path / "out", figures=False, throw=False)
    assert result.status == GAVE_UP
    assert [s.stroke for s in KeptSections.of(read_result(tmp_path / "out")).snapshots] == [0]


def test_fluid_wets_the_edges_that_it_reaches(tmp_path, seal):
    scene = replace(seal, accuracy=Accuracy.preset("draft"), save=Save())
    state = Stepper(scene).start()
    outward, inward = (Section.of(report.section) for report in state.reports)
    assert (outward.fluid_pressure, inward.fluid_pressure) == (0.0, 2.0)
    x, y = inward.points[inward.wetted[2.0][:, 1]].T
    assert x.max() > 4.8
    assert x.min() > 3.3
    assert y.max() > 14.5
