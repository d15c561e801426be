"""A mesh that does not bear a load step, or does not resolve a solve, is refined; the results stay the scene's."""

from dataclasses import replace

import numpy as np
import pytest

import ngwear as nw
from ngwear.equilibrium import stepping
from ngwear.equilibrium.newton import Outcome, Report
from ngwear.errors import ConvergenceError
from ngwear.loop import bearable_friction, finer_mesh, first_cycle, stepper
from ngwear.loop.bearable_friction import LEAST, REVERSED
from ngwear.loop.finer_mesh import EVERYWHERE, LOCALLY, refine_at, unresolved
from ngwear.loop.solution_checks import ROLLS, Finding
from ngwear.loop.stepper import Stepper


@pytest.fixture(scope="module")
def whole(ring):
    return Stepper(ring).start()


@pytest.fixture(scope="module")
def fine(ring):
    """The same with twice as many elements across from the first."""
    return Stepper(replace(ring, accuracy=nw.Accuracy.preset("engineering"))).start()


def push(state):
    return float(state.reports[-1].forces["air wall"][0])


def fails_once(where, failed):
    """``advance`` that gives up once on the way to some loads, after a part of it; adds the elements to ``failed``."""

    def way(problem, target, *args, **kwargs):
        if not failed and where(target):
            failed.append(problem.body.mesh.ne)
            begin = problem.get_loads()
            half = {name: 0.5 * (begin[name] + load) for name, load in target.items()}
            stepping.advance(problem, half, *args, **kwargs)
            raise ConvergenceError("stopped half-way")
        return stepping.advance(problem, target, *args, **kwargs)

    return way


@pytest.mark.parametrize(
    "where",
    [
        pytest.param(lambda target: "imbalance" not in target and target["fluid pressure [MPa]"] > 0, id="stroke"),
        pytest.param(lambda target: target.get("rod approach [mm]", 1.0) == 0.0, id="mounting"),
    ],
)
def test_a_load_step_goes_on_on_finer_elements(ring, whole, fine, monkeypatch, where):
    failed = []
    monkeypatch.setattr(finer_mesh, "advance", fails_once(where, failed))
    state = Stepper(ring).start()
    assert state.halved == 1
    assert state.stage.body.mesh.ne > 1.5 * failed[0]
    assert abs(push(state) - push(fine)) < abs(push(whole) - push(fine)) < 0.03 * push(fine)


def test_not_where_the_part_shows_the_cause(ring, monkeypatch):
    def way(problem, target, *args, **kwargs):
        raise ConvergenceError("stopped", cause="the surface creases")

    monkeypatch.setattr(finer_mesh, "advance", way)
    with pytest.raises(ConvergenceError, match="stopped"):
        Stepper(ring).start()


def test_it_gives_up_on_the_finest_elements(ring, monkeypatch):
    halved = []

    def way(problem, target, *args, **kwargs):
        if target.get("fluid pressure [MPa]", 0.0) > 0:
            halved.append(problem.body.mesh.ne)
            raise ConvergenceError("stopped")
        return stepping.advance(problem, target, *args, **kwargs)

    monkeypatch.setattr(finer_mesh, "advance", way)
    monkeypatch.setattr(bearable_friction, "advance", way)  # then with less friction on the first elements
    with pytest.raises(ConvergenceError, match="stopped"):
        Stepper(ring).start()
    assert len(halved) == EVERYWHERE + 1 + len((0.0, *REVERSED))
    assert np.all(np.diff(halved[: EVERYWHERE + 1]) > 0)
    assert set(halved[EVERYWHERE + 1 :]) == {halved[0]}


def asks(state, places):
    """The state, as if its last solve had not resolved these places."""
    found = Finding("coarse", 1.0, "too coarse", np.array(places))
    state.reports = [replace(state.reports[-1], findings=(found,))]
    return state


def test_a_finding_asks_for_finer_elements_at_its_places(ring):
    state = Stepper(ring).start()
    x, y = state.stage.body.contour.points[0]
    edge = float(state.stage.body.field(np.array([[x, y]]))[0])
    refine_at(asks(state, [[x, y, edge]]), unresolved(state))
    assert state.stage.body.field(np.array([[x, y]]))[0] <= 0.5 * edge * (1 + 1e-9)
    line, contour = state.stage.body.outline, state.stage.body.contour
    ends = contour.at(line.t[:, 0]), contour.at(np.minimum(line.t[:, 1], len(contour) - 1e-9))
    beside = np.linalg.norm(ends[0] - (x, y), axis=1).argmin()
    assert np.linalg.norm(ends[1][beside] - ends[0][beside]) < 0.7 * edge
    state.refined = LOCALLY
    assert unresolved(asks(state, [[x, y, edge]])) == []


def test_a_run_that_does_not_bear_them_goes_on_without(ring, whole, monkeypatch):
    """The first look finds something; the finer mesh then has no solution."""
    place = [*whole.stage.body.contour.points[0], 0.2]
    looks = []

    def look(state):
        looks.append(state.strokes)
        return [Finding("coarse", 1.0, "too coarse", np.array([place]))] if len(looks) == 1 else unresolved(state)

    def refine(state, found):
        refine_at(state, found)
        monkeypatch.setattr(stepper.Stepper, "_step", fails)

    step = stepper.Stepper._step

    def fails(self, state, cycles):
        monkeypatch.setattr(stepper.Stepper, "_step", step)
        raise ConvergenceError("no solution")

    run = Stepper(ring)
    state = run.start()
    elements = state.stage.body.mesh.ne
    monkeypatch.setattr(stepper.finer_mesh, "unresolved", look)
    monkeypatch.setattr(stepper.finer_mesh, "refine_at", refine)
    state = run.advance(state)
    assert state.strokes == 2
    assert state.refined == LOCALLY
    assert state.stage.body.mesh.ne == elements


@pytest.mark.slow
def test_a_ring_that_friction_rolls_over_is_told_of(ring):
    """Rod friction alone turns it: the groove and the walls have none."""
    slippery = [replace(c, friction=0.4 if c.name == "rod" else 0.0) for c in ring.contacts]
    state = Stepper(replace(ring, contacts=slippery)).start()
    share, why = state.stage.friction_shares["outward"]
    assert LEAST < share < 0.2
    assert why == ROLLS
    told = [found.sentence for report in state.reports for found in report.findings]
    assert any("friction rolls the part over; the results are for" in sentence for sentence in told)


def test_the_series_says_how_far_it_has_turned(ring, whole):
    result = nw.run(ring, alone=True, progress=False)
    turned = [row["section turned by [deg]"] for row in result.records.rows]
    assert turned[0] == pytest.approx(whole.reports[0].turned, abs=1e-6)
    assert max(map(abs, turned)) < 45


def fails_on_mesh(monkeypatch, number, error):
    """The part finds no equilibrium on that new mesh of the start."""
    settle = Stepper.settle_on_new_mesh

    def settles(self, state):
        if state.ledger.remeshes >= number:
            raise error
        settle(self, state)

    monkeypatch.setattr(Stepper, "settle_on_new_mesh", settles)


def test_without_an_equilibrium_on_the_last_mesh_the_one_before_counts_and_this_is_told(ring, whole, monkeypatch):
    fails_on_mesh(monkeypatch, 2, ConvergenceError("the corrections do not shrink"))
    state = Stepper(ring).start()
    assert state.ledger.remeshes == 1
    assert state.stage.body.mesh.ne < whole.stage.body.mesh.ne
    (told,) = [found for found in state.reports[-1].findings if found.key == "coarser"]
    assert f"on {state.stage.body.mesh.ne} elements: no equilibrium was found on finer ones" in told.sentence
    assert "the corrections do not shrink" in told.sentence
    assert push(state) == pytest.approx(push(whole), rel=0.05)
    assert Stepper(ring).advance(state).strokes > 0


def test_a_part_refined_only_while_it_was_mounted_has_its_reports(ring, monkeypatch):
    """Of two strokes, so that no cycle is repeated before the first new mesh, on which there is no equilibrium."""
    failed = []
    monkeypatch.setattr(
        finer_mesh, "advance", fails_once(lambda target: target.get("rod approach [mm]") == 0.0, failed)
    )
    fails_on_mesh(monkeypatch, 2, ConvergenceError("the corrections do not shrink"))
    state = Stepper(replace(ring, program=replace(ring.program, strokes=2))).start()
    assert state.halved == state.ledger.remeshes == 1
    assert len(state.reports) == len(ring.program.cycle)
    assert [found.key for found in state.reports[-1].findings].count("coarser") == 1


@pytest.mark.parametrize(
    ("number", "error"),
    [
        pytest.param(1, ConvergenceError("the corrections do not shrink"), id="first new mesh"),
        pytest.param(2, ConvergenceError("no equilibrium", cause="friction creases the surface"), id="cause known"),
    ],
)
def test_a_part_without_an_equilibrium_is_not_passed_on_coarser_elements(ring, monkeypatch, number, error):
    fails_on_mesh(monkeypatch, number, error)
    with pytest.raises(ConvergenceError) as raised:
        Stepper(ring).start()
    assert raised.value is error


@pytest.mark.parametrize(
    ("cause", "outcome", "again"), [("", "STALLED", True), ("it creases", "STALLED", False), ("", "SINGULAR", False)]
)
def test_a_part_that_cannot_be_mounted_is_mounted_on_half_the_edges(fine_sheet, monkeypatch, cause, outcome, again):
    """Once, also a part that is held; not if the part itself shows the cause, or nothing holds it."""
    elements, mount = [], first_cycle.mount

    def fails_once(stage, on_mount, way):
        elements.append(stage.body.mesh.ne)
        if len(elements) == 1:
            raise ConvergenceError("stopped", Report(Outcome[outcome]), cause=cause)
        return mount(stage, on_mount, way)

    monkeypatch.setattr(first_cycle, "mount", fails_once)
    if not again:
        with pytest.raises(ConvergenceError, match="stopped"):
            Stepper(fine_sheet).start()
        assert len(elements) == 1
        return
    state = Stepper(fine_sheet).start()
    assert len(elements) == 2
    assert elements[1] > 1.5 * elements[0]
    assert state.stage.scene.accuracy == Stepper(fine_sheet).scene.accuracy, "the scene's own, for the meshes to come"
    assert len(state.reports) == len(fine_sheet.program.cycle)
