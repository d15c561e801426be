"""Several inlets, a pressure each by stroke; fluids that no contact holds."""

from dataclasses import replace

import numpy as np
import pytest

import ngwear as nw
from ngwear.loop.run import run
from ngwear.loop.stepper import Stepper
from ngwear.results.section import Section
from ngwear.verify.leak_pressure import SQUEEZED
from ngwear.verify.leak_pressure import scene as block

SIDES = {"sealed": ["sealed side"], "air": ["air side"]}
PAIRS = ((0.0, 0.0), (4.0, 4.0), (4.0, 1.5), (0.0, 3.0))  # MPa on the sealed side and on the air side


@pytest.fixture(scope="module")
def ring():
    """An O-ring with room to move, which each stroke presses from both sides."""
    shipped = nw.read_scene("geometries/o_ring/scene.toml")
    strokes = [nw.Stroke(f"{a:g}, {b:g}", travel=20.0, pressure={"sealed": a, "air": b}) for a, b in PAIRS]
    return replace(
        shipped,
        contacts=[replace(contact, friction=0.0) for contact in shipped.contacts],
        fluid=replace(shipped.fluid, inlet=SIDES),
        program=nw.Program(strokes=len(strokes), cycle=strokes),
        accuracy=nw.Accuracy.draft(),
    )


@pytest.fixture(scope="module")
def reports(ring):
    return Stepper(ring).start().reports


def peak(report):
    return report.contacts["rod"].pressure.max()


def test_equal_pressures_on_both_sides_add_to_the_rings_own(ring):
    """Incompressible rubber that a fluid surrounds: its pressure is added everywhere, and nothing moves."""
    cycle = ring.program.cycle[:2]
    finer = replace(ring, program=nw.Program(strokes=2, cycle=cycle), accuracy=nw.Accuracy(across=12.0))
    reports = Stepper(finer).start().reports  # a draft's front errs by 1 % of the peak pressure
    assert peak(reports[1]) == pytest.approx(peak(reports[0]) + 4.0, rel=0.005)
    sealed, air = (reports[1].forces[name][0] for name in SIDES)
    assert sealed == pytest.approx(-air, rel=0.03)


def test_the_higher_pressure_moves_the_ring(reports):
    def push(report):
        return {name: float(report.forces[f"{name} wall"][0]) for name in SIDES}

    assert push(reports[2])["air"] > 100 > abs(push(reports[2])["sealed"])
    assert push(reports[3])["sealed"] < -100 < -abs(push(reports[3])["air"])
    for report in reports[1:]:
        along = [force[0] for force in report.forces.values()]
        assert abs(sum(along)) < 1e-6 * np.abs(along).max()


def test_a_contact_that_reaches_into_the_inlet_stops_the_fluid_there():
    """An X-ring whose sealed side is all of its right half, flanks and valleys too: the lobes hold the fluid."""
    ring = nw.read_scene("geometries/x_ring/scene.toml")
    stepper = Stepper(replace(ring, accuracy=nw.Accuracy.draft()))
    state = stepper.start()
    stepper.restore_last_stroke(state)  # a look at finer elements may have left another state
    section = Section.of(state.reports[1].section)
    wet = section.points[section.wetted[5.0][:, 1], 0]
    for name in ("rod", "groove bottom"):
        profile = state.stage.contacts[name].profile()
        assert wet.min() > profile.place[profile.pressure > 0, 0].max() - 0.4, name


def test_sections_show_each_fluid_by_its_pressure(ring):
    kept = Stepper(ring).start().reports[2]
    wetted = Section.of(kept.section).wetted
    assert set(wetted) == {4.0, 1.5}
    assert len(np.intersect1d(*(edges.ravel() for edges in wetted.values()))) == 0


@pytest.mark.parametrize(
    ("inlet", "pressure", "place"),
    [
        ({"sealed": ["sealed side"], "air": ["sealed side"]}, {}, "fluid.inlet.air"),
        ({"sealed": ["sealed side"], "air": ["none"]}, {}, "fluid.inlet.air"),
        ({"sealed": []}, {}, "fluid.inlet.sealed"),
        ({}, {}, "fluid.inlet"),
        (SIDES, 4.0, "program.stroke 'out'.pressure"),
        (SIDES, {"sealed": -1.0}, "program.stroke 'out'.pressure"),
        (SIDES, {"steam": 1.0}, "program.stroke 'out'.pressure.steam"),
        (["sealed side"], {"sealed": 1.0}, "program.stroke 'out'.pressure.sealed"),
    ],
)
def test_what_contradicts_itself_is_refused(ring, inlet, pressure, place):
    def build():
        program = nw.Program(strokes=2, cycle=[nw.Stroke("out", travel=20.0, pressure=pressure)])
        return replace(ring, fluid=nw.Fluid(edges=ring.fluid.edges, inlet=inlet), program=program)

    with pytest.raises(nw.SceneError) as refused:
        build()
    assert refused.value.place == place


def test_a_scene_file_holds_them(ring, tmp_path):
    ring.write(tmp_path / "ring.toml")
    read = nw.read_scene(tmp_path / "ring.toml")
    assert read.fluid.inlets == {name: tuple(edges) for name, edges in SIDES.items()}
    assert [stroke.pressure for stroke in read.program.cycle] == [dict(s.pressure) for s in ring.program.cycle]


RATE, PRESSURE = 1e-3, 0.5


@pytest.fixture
def worn():
    """A block that wears between two plates, under a fluid."""
    squeezed = block()
    plates = [replace(contact, specific_wear_rate=RATE) for contact in squeezed.contacts]
    stroke = nw.Stroke("slide", travel=1.0, pressure=PRESSURE)
    return replace(squeezed, contacts=plates, program=nw.Program(strokes=150, cycle=[stroke]))


def test_blow_by_is_a_result_and_may_end_the_run(worn, tmp_path):
    """The contact carries the fluid's pressure and the block's own, which is gone when the squeeze is worn away."""
    gone = (1 - SQUEEZED) / 2
    ending = replace(worn, fluid=replace(worn.fluid, blow_by="end"))
    result = run(ending, out=tmp_path / "out", figures=False)
    (blown,) = result.summary["blow-by"]
    assert result.status == "completed"
    assert (
        f"ended by blow-by after stroke {blown['stroke']}: the 0.5 MPa of 'fluid' opens the contact" in result.message
    )
    assert blown["edge"] in ("bottom", "top")
    assert 0.98 * PRESSURE < blown["highest contact pressure [MPa]"] < blown["fluid pressure [MPa]"] == PRESSURE
    assert result.summary["strokes"] == blown["stroke"] < ending.program.strokes
    assert result.summary["maximum depth [mm]"] == pytest.approx(gone, abs=2 * RATE * PRESSURE)
    again = run(ending, out=tmp_path / "out", resume=True, figures=False)
    assert again.message == result.message

    going_on = run(worn, figures=False)
    assert going_on.summary["strokes"] == worn.program.strokes
    assert going_on.summary["blow-by"][0]["stroke"] >= blown["stroke"]
    assert "would open the contact" in going_on.summary["warnings"][0]


def test_a_fluid_that_meets_no_contact_blows_by_at_once():
    free = block()
    apart = [
        replace(c, surface=replace(c.surface, point=(0.0, y))) for c, y in zip(free.contacts, (-1, 2), strict=True)
    ]
    held = replace(free, contacts=apart, supports=[nw.Support(edges=["left"])])
    assert run(held, figures=False).summary["blow-by"] == []  # bonded: no fluid passes its far side
    guided = replace(held, supports=[nw.Support(edges=["left"], y=False), nw.Support(edges=["top"], x=False)])
    (*_, found) = run(guided, figures=False).summary["blow-by"]
    assert (found["edge"], found["highest contact pressure [MPa]"]) == ("top", 0.0)
