"""Every accepted solve is looked at: overlap, pressures that alternate, imbalance, crushed elements, blow-by."""

from dataclasses import replace

import ngsolve as ng
import numpy as np
import pytest

import ngwear as nw
from ngwear.geometry.outline import Outline
from ngwear.loop.run import run
from ngwear.loop.solution_checks import _uneven_stretch, findings
from ngwear.loop.stepper import Stepper
from ngwear.surfaces import Plane

PUSHED = 0.05  # mm


@pytest.fixture(scope="module")
def scene():
    """A block on a fixed foot, pushed down by a plate; the plate's contact lists the top only."""
    outline = Outline.rectangle((0.0, 2.0), (0.0, 1.0))
    plate = Plane(point=(0.0, 1.0 - PUSHED), normal_vector=(0.0, -1.0))
    return nw.Scene(
        "pushed block",
        nw.Part(outline, material=nw.NeoHooke(shear=1.0, bulk_modulus=100.0)),
        contacts=[nw.Contact("plate", edges=["top"], surface=plate, refine=True)],
        axisymmetric=False,
        supports=[nw.Support(edges=["bottom"])],
        program=nw.Program(strokes=1, cycle=[nw.Stroke("out", direction=1, travel=1.0)]),
        accuracy=nw.Accuracy(patch=0.1, coarse=0.5, mounting=0.2),
    )


@pytest.fixture(scope="module")
def solved(scene):
    state = Stepper(scene).start()
    return state.stage, state.reports[-1]


def found(stage, report, **changes):
    profiles, forces = report.contacts | changes.get("contacts", {}), report.forces | changes.get("forces", {})
    stroke = changes.get("stroke", stage.scene.program.cycle[0])
    return {f.key: f for f in findings(stage, profiles, forces, stroke, worn=changes.get("worn", False))}


def test_a_good_solve_has_no_finding(solved):
    assert found(*solved) == {}
    assert solved[1].findings == ()


def test_an_edge_that_no_contact_names_is_found_inside_a_surface(scene):
    deep = Plane(point=(2.0 + 1e-9, 0.0), normal_vector=(-1.0, 0.0))  # bulges into it under the plate
    beside = nw.Contact("stop", edges=["left"], surface=deep)
    result = run(replace(scene, contacts=[*scene.contacts, beside]), figures=False)
    (warning,) = result.summary["warnings"]
    assert "lies 0.0659 mm inside the surface" in warning
    assert "contact 'stop'" in warning
    assert "name it there" in warning


def test_without_edges_any_may_touch(scene):
    stop = nw.Contact("stop", surface=Plane(point=(2.0 + 1e-9, 0.0), normal_vector=(-1.0, 0.0)))
    with_stop = replace(scene, contacts=[*scene.contacts, stop])
    assert with_stop.contacts[1].edges == ("bottom", "right", "top", "left")
    result = run(with_stop, figures=False)
    assert result.summary["warnings"] == []
    assert abs(result.records.rows[-1]["stop force x [N/mm]"]) > 1e-3


def test_a_pressure_that_alternates_is_found(solved):
    stage, report = solved
    profile = report.contacts["plate"]
    sign = (-1.0) ** np.arange(len(profile.pressure))
    rough = replace(profile, pressure=profile.pressure * (1 + 0.5 * sign))
    alternating = found(stage, report, contacts={"plate": rough})["zigzag plate"]
    assert alternating.amount == pytest.approx(0.5 * np.median(profile.pressure), rel=0.5)
    assert "take smaller elements" in alternating.sentence
    bent = profile.pressure * (1 + 0.5 * np.sin(np.linspace(0, 9, len(sign))))
    assert found(stage, report, contacts={"plate": replace(profile, pressure=bent)}) == {}


@pytest.mark.parametrize("loads", [(0.5, 0.8, 0.5, 1.0, 0.6), (0.0, 1.0, 0.0, 1.0, 0.0), (0.8, 1.0, 0.85, 1.0, 0.0)])
def test_a_pressure_that_goes_up_and_down_twice_on_five_nodes_is_found(solved, loads):
    """Wherever the five nodes are, in a contact that closes as well; a smaller ripple is not."""
    stage, report = solved
    profile = report.contacts["plate"]
    k, peak = len(profile.t), profile.pressure.max()
    closing = np.vstack([profile.edges, [k - 1, 0]])
    some = replace(profile, edges=closing, mean=np.append(profile.mean, 0.0))
    for first in (3, k - 2):
        rough = np.zeros(k)
        rough[(first + np.arange(5)) % k] = peak * np.array(loads)
        assert "zigzag plate" in found(stage, report, contacts={"plate": replace(some, pressure=rough)})
    even = np.zeros(k)
    even[3:8] = peak * np.array([0.95, 1.0, 0.95, 1.0, 0.95])
    assert found(stage, report, contacts={"plate": replace(some, pressure=even)}) == {}
    nothing = replace(some, pressure=1e-300 * rough)
    assert found(stage, report, contacts={"plate": nothing}) == {}


@pytest.mark.parametrize(("longer", "told"), [(0.15, True), (0.05, False)])
def test_a_stretch_that_goes_up_and_down_from_edge_to_edge_is_found(solved, longer, told):
    """Where the contact bears more than half of its peak; beside it, it wears little. Only of a surface that wears."""
    stage, report = solved
    profile = report.contacts["plate"]
    k = len(profile.t)
    ways = np.diff(profile.place, axis=0)
    bell = replace(profile, pressure=np.exp(-(np.linspace(-3, 3, k) ** 2)))
    for first, bears in ((k // 2, True), (1, False)):
        uneven = ways.copy()
        uneven[first] *= 1 + longer
        place = np.vstack([profile.place[:1], profile.place[0] + np.cumsum(uneven, axis=0)])
        rough = list(_uneven_stretch("plate", replace(bell, place=place)))
        assert len(rough) == (told and bears)
        for finding in rough:
            assert finding.amount == pytest.approx(longer / 2, rel=0.2)
            assert np.linalg.norm(finding.places[1, :2] - profile.reference[first : first + 2].mean(axis=0)) < 1e-9
        assert found(stage, report, contacts={"plate": replace(profile, place=place)}) == {}


def test_forces_that_do_not_balance_are_found(scene, solved):
    stage, report = solved
    unheld = replace(scene, supports=[nw.Support(edges=["bottom"], x=False)])
    stage_unheld = Stepper(unheld).start().stage
    assert set(found(stage_unheld, report, forces={"plate": np.array([1e-3, -1.0])})) == {"balance x"}
    assert found(stage, report, forces={"plate": np.array([1e-3, -1.0])}) == {}  # a support may carry it


def test_a_crushed_element_is_found(solved):
    stage, report = solved
    vector = stage.problem.state.vec.FV().NumPy()
    keep = vector.copy()
    vector[stage.problem.part("displacement")] *= 12.0
    crushed = found(stage, report)
    vector[:] = keep
    assert "crushed" in crushed
    assert "of its volume" in crushed["crushed"].sentence


def test_a_contact_that_carries_less_than_the_fluid_is_found(scene):
    low = 2.0  # MPa, more than the plate's pressure
    stroke = nw.Stroke("out", direction=1, travel=1.0, pressure=low)
    foot = nw.Contact("foot", edges=["bottom"], surface=Plane(point=(0.0, 0.0), normal_vector=(0.0, 1.0)), refine=True)
    wet = replace(
        scene,
        contacts=[*scene.contacts, foot],
        supports=[nw.Support(edges=["left"], y=False)],
        fluid=nw.Fluid(edges=["bottom", "right", "top"], inlet=["right"]),
        program=nw.Program(strokes=1, cycle=[replace(stroke, pressure=1e-3)]),
    )
    state = Stepper(wet).start()
    assert found(state.stage, state.reports[-1]) == {}
    state.stage.problem.set_loads({"fluid pressure [MPa]": low})
    blown = found(state.stage, state.reports[-1], stroke=stroke)["blow-by out fluid"]
    assert "the 2 MPa of 'fluid' would open the contact at '" in blown.sentence
    assert 0 < blown.amount < low


def test_a_zone_across_the_outlines_first_point_is_one(solved):
    """The same contact, whichever node comes first."""
    _, report = solved
    profile = report.contacts["plate"]
    inside = profile.pressure * (np.arange(len(profile.t)) % (len(profile.t) - 1) > 0)  # open at both ends
    closing = np.vstack([profile.edges, [len(profile.t) - 1, 0]])  # as of a contact all around an outline
    whole = replace(profile, pressure=inside, edges=closing, mean=np.append(profile.mean, 0.0))
    (zone,) = whole.zones()
    for first in range(1, len(profile.t)):
        (other,) = whole._from(first).zones()
        assert other.width == pytest.approx(zone.width, rel=0.1)  # its ends are extrapolated where nodes follow
        assert other.peak == zone.peak
        assert set((other.nodes + first) % len(profile.t)) == set(zone.nodes)


def test_a_part_that_wears_may_end_a_solve_inside_the_surface_that_wears_it(scene):
    """By the depth that it wears; before the first stroke it may not."""
    worn = replace(scene, contacts=[replace(scene.contacts[0], specific_wear_rate=1e-6)])
    state = Stepper(worn).start()
    problem, stage = state.stage.problem, state.stage
    problem.state.vec.FV().NumPy()[problem.part("displacement")] *= 0.9  # less than the plate pushes
    assert any("overlap" in key for key in found(stage, state.reports[-1]))
    assert not any("overlap" in key for key in found(stage, state.reports[-1], worn=True))


def test_an_outline_that_crosses_itself_is_found(scene):
    """The sides of a thin block, moved through each other."""
    state = Stepper(scene).start()
    stage = state.stage
    u = stage.problem.fields["displacement"]
    u.Set(ng.CF((-2.4 * (ng.x - 1.0) * ng.y, 0.0)))  # the top is turned over
    crossing = found(stage, state.reports[-1])["crossing"]
    assert "crosses itself at (1, 0.4167): the part touches itself there" in crossing.sentence


def test_a_contact_within_a_mesh_edge_has_a_width(solved):
    """Its ends are looked for inside the outermost nodes, which are open: there is no less than half an edge."""
    profile = solved[1].contacts["plate"]
    one = np.arange(len(profile.t)) == len(profile.t) // 2
    thin = replace(profile, pressure=1.0 * one, gap=1.0 - 0.5 * one + 0.01 * np.abs(np.arange(len(one)) - one.argmax()))
    (zone,) = thin.zones()
    edges = np.linalg.norm(np.diff(profile.place, axis=0), axis=1)
    assert zone.width >= 0.5 * edges.min()


def test_an_inlet_that_surfaces_cover_is_found(scene):
    stroke = replace(scene.program.cycle[0], pressure=0.1)
    fluid = nw.Fluid(edges=["left", "top"], inlet=["left"])
    state = Stepper(replace(scene, fluid=fluid, program=replace(scene.program, cycle=[stroke]))).start()
    assert not [key for key in found(state.stage, state.reports[-1]) if key.startswith("inlet")]
    state.stage.fluids["fluid"].field.vec[:] = 0.0  # as if a surface touched all of it
    (finding,) = [f for key, f in found(state.stage, state.reports[-1]).items() if key.startswith("inlet")]
    assert "surfaces touch the whole inlet of 'fluid', so that its 0.1 MPa act nowhere" in finding.sentence
