"""A U-cup between two shoulders: the fluid lifts it off the sealed one, and reaches the whole annulus behind it."""

import math
from dataclasses import replace

import numpy as np
import pytest

import ngwear as nw
from ngwear.equilibrium.newton import Outcome, Report
from ngwear.equilibrium.stepping import StepOptions, Work, advance, relax
from ngwear.loop import fluid_let_in, stroke_solve
from ngwear.loop.fluid_let_in import fluid_errors
from ngwear.loop.run import run
from ngwear.results.quantities_of_interest import BY_FLUID, DEPTH, PEAK

ROD, BORE = 22.0, 30.0
POINTS = [(0.0, 11.15), (1.8, 11.15), (4.6, 10.6), (4.9, 10.6), (6.0, 11.6), (6.0, 12.2), (2.5, 12.2)]
POINTS += [(2.5, 13.8), (6.0, 13.8), (6.0, 14.7), (4.9, 15.4), (4.6, 15.4), (1.8, 14.9), (0.0, 14.9)]
NAMES = ["air bottom", "lip back", "lip tip", "lip front", "lip end", "u bottom", "u root", "u top"]
NAMES += ["outer end", "outer front", "outer tip", "outer back", "air top", "heel"]
INLET = ["u bottom", "u root", "u top"]


@pytest.fixture(scope="module")
def cup():
    """Without room along the axis; each stroke holds a pressure."""
    outline = nw.Outline(np.array(POINTS), tuple(NAMES), np.ones(len(POINTS), dtype=bool))
    shoulders = [
        nw.Contact("air shoulder", surface=nw.Plane(point=(0.0, 0.0), normal_vector=(1.0, 0.0))),
        nw.Contact("sealed shoulder", surface=nw.Plane(point=(5.95, 0.0), normal_vector=(-1.0, 0.0))),
    ]
    scene = nw.Scene(
        "U-cup",
        nw.Part(outline, material=nw.NeoHooke(shear=8.0, bulk_modulus=4000.0)),
        contacts=[
            nw.Contact("rod", surface=nw.rod(diameter=ROD), refine=True),
            nw.Contact("gland", surface=nw.bore(diameter=BORE), refine=True),
            *shoulders,
        ],
        fluid=nw.Fluid(edges=NAMES[:-1], inlet=INLET),
        program=nw.Program(
            strokes=6,
            cycle=[nw.Stroke(f"hold {p:g}", direction=0, travel=1.0, pressure=p) for p in (0.0, 0.5, 6.0)],
        ),
        accuracy=nw.Accuracy.preset("engineering"),
    )
    stepper = nw.Stepper(scene)
    return stepper, stepper.start()


def axial(report):
    """Force of the fluid along the axis [N]."""
    return -float(report.forces["fluid"][0])


def test_it_reaches_the_whole_annulus(cup):
    _, state = cup
    _, little, much = state.reports
    annulus = math.pi / 4 * (BORE**2 - ROD**2)
    assert axial(little) < 0.97 * 0.5 * annulus, "the sealed shoulder dams it"
    assert axial(much) == pytest.approx(6.0 * annulus, rel=5e-3)
    assert np.abs(much.forces["sealed shoulder"]).max() < 1e-9
    assert not much.leaks


def test_the_next_cycle_starts_behind_the_contacts_that_it_has_passed(cup):
    stepper, state = cup
    places = [phase.passed for phase in state.phases]
    assert places[0] is None
    assert np.isfinite(places[2]).any()
    state = stepper.advance(state)
    assert axial(state.reports[-1]) == pytest.approx(axial(cup[1].reports[-1]), rel=1e-4)
    np.testing.assert_array_equal(np.isfinite(state.phases[2].passed), np.isfinite(places[2]))


def test_after_a_stroke_without_pressure_it_has_passed_nothing(cup):
    """Wherever it was in the same stroke of the last cycle: the contacts have closed since."""
    stepper, state = cup
    kept = state.saved()
    before = axial(state.reports[1])
    state.phases[1].passed = state.phases[2].passed
    state = stepper.advance(state)
    assert axial(state.reports[1]) == pytest.approx(before, rel=1e-3)
    state.restore(kept)


def test_a_solve_that_failed_leaves_no_contact_lifted(cup, monkeypatch):
    """Load steps from the stroke's last end begin where the fluid was then."""
    stepper, state = cup
    kept, before, began = state.saved(), axial(state.reports[1]), []
    everywhere = state.phases[2].passed

    def fails(state, guess, work):
        began.append(state.stage.fluid_passed())
        state.stage.let_fluid_pass(everywhere)
        return Report(Outcome.STALLED)

    def relaxes(problem, options):
        began.append(state.stage.fluid_passed())
        return relax(problem, options)

    monkeypatch.setattr(stroke_solve, "_solves", fails)
    monkeypatch.setattr(stroke_solve, "relax", relaxes)
    report = stepper._solve_without_wear(state, 1, stepper._next_cycle(state))
    assert began == [None, None], "of no contact"
    assert axial(report) == pytest.approx(before, rel=5e-3), "within a mesh edge of the front"
    state.restore(kept)


def test_load_steps_on_a_new_mesh_whose_fluid_passes_a_contact_at_once_are_not_trusted(cup, monkeypatch):
    stepper, state = cup
    kept, ways = state.saved(), []

    def advances(*args, **kwargs):
        ways.append("from the stroke before")
        return advance(*args, **kwargs)

    monkeypatch.setattr(stroke_solve, "_solves", lambda *args: Report(Outcome.STALLED))
    monkeypatch.setattr(stroke_solve, "advance", advances)
    for far in (False, True):
        monkeypatch.setattr(stroke_solve, "_passes_far", lambda *args, far=far: far)
        state.phases[1].rate = None  # as on a new mesh
        stroke_solve._approach(state, 1, stepper.scene.program.cycle[1], Work(), StepOptions())
        assert len(ways) == far
        state.stage.floats = stepper.scene.contacts  # the next time as a part with room to move
    state.stage.floats = ()
    state.restore(kept)


def test_an_inlet_on_both_sides_of_a_contact_that_slides_is_told_of(cup):
    stepper, state = cup
    assert not [found for report in state.reports for found in report.findings if found.key.startswith("inlet")]
    below = ["air bottom", "lip back", "lip tip", "lip front", "lip end"]
    fluid = nw.Fluid(edges=NAMES, inlet=[*INLET, *below])
    state = nw.Stepper(replace(stepper.scene, fluid=fluid)).start()
    told = [found.sentence for found in state.reports[-1].findings if found.key.startswith("inlet")]
    assert "contact 'rod' lies on the inlet of 'fluid' and seals nothing" in told[0]


def test_a_warning_is_on_the_screen_when_a_solve_shows_it_first(cup, capsys):
    below = ["air bottom", "lip back", "lip tip", "lip front", "lip end"]
    scene = replace(
        cup[0].scene, fluid=nw.Fluid(edges=NAMES, inlet=[*INLET, *below]), accuracy=nw.Accuracy.preset("draft")
    )
    said = []
    run(scene, progress=True, on_step=lambda state: said.append(capsys.readouterr().err.count("seals nothing")))
    assert len(said) > 1
    said.append(capsys.readouterr().err.count("seals nothing"))
    assert said[:2] == [0, 2], "for each stroke with pressure, once the part is mounted"
    assert sum(said) == 2
    run(scene)
    assert not capsys.readouterr().err


def test_a_fluid_that_has_passed_all_contacts_of_a_way_is_at_its_end(cup):
    _, state = cup
    fluid = state.stage.fluids["fluid"]
    kept = fluid.passed
    edges = [len(path) for _, path in fluid.paths]
    fluid._passed = list(edges)
    ends = fluid.passed
    fluid.passed = ends
    assert fluid._passed == [count - 1 for count in edges]
    assert (fluid.passed == ends).all()
    fluid.passed = kept


def test_a_stage_takes_the_places_to_its_own_mesh(cup):
    _, state = cup
    stage, places = state.stage, state.phases[2].passed
    stage.let_fluid_pass(places)
    known = np.isfinite(places)
    assert np.abs(stage.fluid_passed()[known] - places[known]).max() < 1e-12
    stage.let_fluid_pass(None)
    assert stage.fluid_passed() is None


def test_the_error_by_a_fluid_that_is_just_held_is_what_it_changes_if_let_in(cup, monkeypatch):
    """The shoulder dams the little pressure; let in, the fluid acts on the whole annulus."""
    _, state = cup
    kept, seen, whole = state.saved(), [], fluid_let_in.read_cycle
    monkeypatch.setattr(fluid_let_in, "read_cycle", lambda at: seen.append(at.reports) or whole(at))
    assert fluid_errors(state) == {}
    held = replace(state.reports[1], comes_further=True)
    state.reports = [state.reports[0], held, *state.reports[2:]]
    monkeypatch.setattr(fluid_let_in, "ERRS", 3.0)  # more than the shoulder carries
    errors = fluid_errors(state)
    as_it_is, let_in = (axial(reports[1]) / (0.5 * math.pi / 4 * (BORE**2 - ROD**2)) for reports in seen)
    assert as_it_is < 0.97
    assert let_in == pytest.approx(1.0, rel=5e-3)
    assert errors[f"{PEAK[:-4]} {BY_FLUID}"] > 0.001
    assert [fluid.holding for fluid in state.stage.fluids.values()] == [0.95]
    assert (state.stage.problem.state.vec.FV().NumPy() == state.phases[-1].vector).all()
    state.restore(kept)


def test_a_run_states_it_or_says_that_it_is_not_known(ring, monkeypatch):
    from ngwear.loop import run as module

    monkeypatch.setattr(module, "add_mesh_errors", lambda state: [])
    by_fluid = f"{DEPTH[:-4]} {BY_FLUID}"
    monkeypatch.setattr(fluid_let_in, "fluid_errors", lambda state: {by_fluid: 0.4})
    assert run(ring, errors=lambda recorder, summary: None).summary["error estimates"][by_fluid] == 0.4

    def fails(state):
        raise nw.ConvergenceError("no equilibrium")

    monkeypatch.setattr(fluid_let_in, "fluid_errors", fails)
    told = run(ring, errors=lambda recorder, summary: None).summary
    assert any("the error by the fluid that may come in is not known" in warning for warning in told["warnings"])
