"""A part that friction rolls over, or whose surface it creases: solved with the friction that it bears, and said."""

from dataclasses import replace

import numpy as np
import pytest

import ngwear as nw
from ngwear.equilibrium.attempts import solve
from ngwear.equilibrium.newton import Outcome, Report
from ngwear.equilibrium.stepping import Work, advance
from ngwear.errors import ConvergenceError
from ngwear.loop import bearable_friction
from ngwear.loop.bearable_friction import BELOW, Start, is_too_much, lower_friction
from ngwear.loop.element_sizes import coarse_for_mounting, with_mounting_lengths
from ngwear.loop.mounting import mount, unworn_body
from ngwear.loop.solution_checks import findings
from ngwear.loop.stage import Stage
from ngwear.loop.state import State
from ngwear.loop.stepper import Stepper
from ngwear.wear.jump_control import JumpControl

RUBBED, SMOOTH = 0.4, 0.05  # friction of the rod, and of all that could stop the ring from turning


def rubbed():
    """An O-ring whose rod rubs and whose groove is smooth."""
    scene = nw.read_scene("geometries/o_ring/scene.toml")
    contacts = tuple(replace(c, friction=RUBBED if c.slides else SMOOTH) for c in scene.contacts)
    return replace(scene, contacts=contacts, accuracy=nw.Accuracy.draft())


@pytest.fixture(scope="module")
def rolled():
    """Scene and first state of such a ring."""
    scene = rubbed()
    return scene, Stepper(scene).start()


@pytest.fixture(scope="module")
def stage():
    """Such a ring at rest, with half of the friction in one stroke."""
    scene = coarse_for_mounting(with_mounting_lengths(rubbed()))
    return Stage(scene, unworn_body(scene, 6.0), friction_shares={"outward": (0.5, "rolls the part over")})


def test_a_share_of_the_friction_acts_in_the_stroke_that_has_one(stage):
    first, second = stage.scene.program.cycle
    assert (first.name, second.name) == ("outward", "inward")
    assert stage.stroke_loads(first)["rod slip"] == 0.5 * first.direction
    assert stage.stroke_loads(second)["rod slip"] == second.direction


def test_it_is_a_finding_of_that_stroke_alone(stage):
    told = [
        [f.sentence for f in findings(stage, {}, {}, stroke, worn=False) if f.key.startswith("less friction")]
        for stroke in stage.scene.program.cycle
    ]
    assert [len(sentences) for sentences in told] == [1, 0]
    assert "stroke 'outward': friction rolls the part over; the results are for 50 % of the friction" in told[0][0]


def test_a_crease_is_told_as_such(stage):
    stage.friction_shares["inward"] = (0.25, "creases the surface")
    try:
        stroke = stage.scene.program.cycle[1]
        told = [f.sentence for f in findings(stage, {}, {}, stroke, worn=False) if f.key.startswith("less friction")]
    finally:
        del stage.friction_shares["inward"]
    assert "stroke 'inward': friction creases the surface; the results are for 25 % of the friction" in told[0]


def test_friction_that_the_part_bears_is_brought_on_again():
    scene = coarse_for_mounting(with_mounting_lengths(nw.read_scene("geometries/o_ring/scene.toml")))
    scene = replace(scene, contacts=tuple(replace(c, friction=0.02) for c in scene.contacts))
    stage = Stage(scene, unworn_body(scene, 6.0))
    mount(stage, lambda fraction: None)
    target, creased = stage.stroke_loads(scene.program.cycle[0]), ConvergenceError("none", Report(Outcome.CREASED))
    work = lower_friction(stage, "outward", target, creased, Start.of(stage))
    assert work.solves > 0
    assert stage.friction_shares == {}
    assert stage.problem.get_loads()["rod slip"] == target["rod slip"]
    friction, load = np.abs(stage.forces()["rod friction"]), np.abs(stage.forces()["rod"])
    assert friction[0] == pytest.approx(0.02 * load[1], rel=1e-3)
    goes_back_to(stage, Start.of(stage), {"rod slip": 0.5 * target["rod slip"]})


def goes_back_to(stage, there, loads):
    """A state within the stroke is an equilibrium again after others, and so much has slipped as there."""
    counted = [(friction.heat(0.0), friction.slid()) for friction in stage.sticking.values()]
    advance(stage.problem, loads)
    there.put_back(stage)
    again = [(friction.heat(0.0), friction.slid()) for friction in stage.sticking.values()]
    assert again
    for (heat, slid), (before, slid_before) in zip(again, counted, strict=True):
        assert heat == pytest.approx(before, abs=1e-9)
        assert slid == pytest.approx(slid_before, abs=1e-9)
    assert solve(stage.problem).iterations <= 1


def tries(stage, monkeypatch, *, stroke, reached, comes_on):
    """Lower the friction of a stroke that has rolled the part over; return the tries, from the beginning of the stroke.

    ``reached``: share of the friction with which it has failed. ``comes_on(share, before_others)``: whether the loads
    come on with that share. No other friction is found from there.
    """
    tried, index = [], [stroke.name for stroke in stage.scene.program.cycle].index(stroke)
    target = stage.stroke_loads(stage.scene.program.cycle[index])

    def begins(stage, target, slips, start, *, before_others):
        tried.append((slips["rod slip"] / full, before_others))
        if not comes_on(*tried[-1]):
            raise ConvergenceError("the loads do not come on")
        return Work()

    def refuses(problem, slips, options):
        raise ConvergenceError("no other friction")

    full = target["rod slip"]
    monkeypatch.setattr(bearable_friction, "_with_less_friction", begins)
    monkeypatch.setattr(bearable_friction, "advance", refuses)
    stage.problem.set_loads({"rod slip": reached * full})
    lower_friction(stage, stroke, target, ConvergenceError("rolls", Report(Outcome.ROLLED)), Start.of(stage))
    return tried


@pytest.fixture
def unlowered(stage, monkeypatch):
    """The ring at rest, with all of the friction."""
    monkeypatch.setattr(stage, "friction_shares", {})
    return stage


@pytest.mark.parametrize(("bears", "share"), [(0.23, BELOW * 0.25), (0.21, BELOW**2 * 0.25), (0.1, None)])
def test_a_share_whose_loads_do_not_come_on_is_lowered_once_more(unlowered, monkeypatch, bears, share):
    """It slides with a quarter of the friction, not with more, and with ``bears`` when the loads come on anew."""
    came = []

    def comes_on(tried, before_others):
        if came and tried > bears:
            return False
        came.append(tried)
        return True

    if share is None:
        with pytest.raises(ConvergenceError, match="rolls"):
            tries(unlowered, monkeypatch, stroke="outward", reached=0.5, comes_on=comes_on)
        return
    tries(unlowered, monkeypatch, stroke="outward", reached=0.5, comes_on=comes_on)
    assert came == pytest.approx([0.25, share])
    assert unlowered.friction_shares["outward"] == (pytest.approx(share), bearable_friction.ROLLS)


def test_a_part_that_bears_hardly_any_friction_slides_with_that(unlowered, monkeypatch):
    tries(unlowered, monkeypatch, stroke="outward", reached=0.12, comes_on=lambda share, _: share <= 0.06)
    assert unlowered.friction_shares["outward"] == (pytest.approx(BELOW * 0.06), bearable_friction.ROLLS)


def test_a_part_that_bears_none_is_given_up(unlowered, monkeypatch):
    with pytest.raises(ConvergenceError, match="rolls"):
        tries(unlowered, monkeypatch, stroke="outward", reached=0.03, comes_on=lambda share, _: share <= 0.015)


def test_at_last_it_goes_a_way_that_was_gone(unlowered, monkeypatch):
    """With a quarter of the friction the loads come on, with nothing else."""
    tried = tries(unlowered, monkeypatch, stroke="outward", reached=0.5, comes_on=lambda share, _: share == 0.25)
    assert [share for share, _ in tried] == pytest.approx([0.25, BELOW * 0.25, BELOW**2 * 0.25, 0.25])
    assert unlowered.friction_shares["outward"] == (0.25, bearable_friction.ROLLS)


def test_a_reversal_is_tried_without_friction_and_then_with_its_own_before_the_other_loads(unlowered, monkeypatch):
    """The friction of the stroke before still acts where the loads have failed; they come on with half of its own."""
    tried = tries(unlowered, monkeypatch, stroke="inward", reached=-0.6, comes_on=lambda *way: way == (0.5, True))
    assert tried[:3] == [(0.0, False), (1.0, True), (0.5, True)]
    assert tried[-1] == (0.5, True)
    assert unlowered.friction_shares == {"inward": (0.5, bearable_friction.ROLLS)}


def test_what_it_bears_less_of_is_taken_from_the_way_up(unlowered, monkeypatch):
    """What the part does with more friction than that leaves no trace: here the state counts the friction's steps."""
    problem, target = unlowered.problem, unlowered.stroke_loads(unlowered.scene.program.cycle[0])
    full, vector = target["rod slip"], problem.state.vec.FV().NumPy()

    def comes_on(problem, slips, options):
        if slips["rod slip"] / full > 0.8:
            raise ConvergenceError("no more")
        problem.set_loads(slips)
        vector[:] += 1.0
        return Work()

    def begins(stage, target, slips, start, *, before_others):
        start.restore(stage)
        problem.set_loads(slips)
        return Work()

    kept, start = vector.copy(), Start.of(unlowered)
    monkeypatch.setattr(bearable_friction, "_with_less_friction", begins)
    monkeypatch.setattr(bearable_friction, "advance", comes_on)
    problem.set_loads({"rod slip": full})
    lower_friction(unlowered, "outward", target, ConvergenceError("rolls", Report(Outcome.ROLLED)), start)
    assert unlowered.friction_shares["outward"][0] == pytest.approx(BELOW * 0.75)  # from 1/2, four steps of 1/16
    assert vector - kept == pytest.approx(3.0)  # two steps up to 5/8, and one to what it slides with
    vector[:] = kept


def test_a_step_that_is_rejected_leaves_the_shares_as_they_were(stage):
    state = State(stage, [], JumpControl(0.01, depth=0.01, cycles=1, longest=1))
    saved, before = state.saved(), dict(stage.friction_shares)
    stage.friction_shares.clear()
    state.restore(saved)
    assert state.stage.friction_shares == before != {}


def test_without_friction_to_lower_the_part_is_given_up(stage):
    error = ConvergenceError("no equilibrium", Report(Outcome.ROLLED))
    assert is_too_much(error)
    assert not is_too_much(ConvergenceError("no equilibrium", Report(Outcome.STALLED)))
    target = stage.stroke_loads(stage.scene.program.cycle[0]) | {"rod slip": 0.0}
    with pytest.raises(ConvergenceError, match="no equilibrium"):
        lower_friction(stage, "outward", target, error, Start.of(stage))


@pytest.mark.slow
def test_a_stroke_in_which_the_ring_rolls_has_the_friction_that_it_bears(rolled):
    scene, state = rolled
    shares = state.stage.friction_shares
    assert shares, "the ring does not roll: this test needs more friction"
    assert all(0 < share < BELOW for share, _ in shares.values())
    for report, stroke in zip(state.reports, scene.program.cycle, strict=True):
        friction, load = np.abs(report.forces["rod friction"]), np.abs(report.forces["rod"])
        assert friction[0] == pytest.approx(RUBBED * shares.get(stroke.name, (1.0, ""))[0] * load[1], rel=1e-3)
        told = [finding.sentence for finding in report.findings if "rolls the part over" in finding.sentence]
        assert len(told) == (stroke.name in shares)
        assert all(f"for {100 * shares[stroke.name][0]:.0f} % of the friction" in sentence for sentence in told)


@pytest.mark.slow
def test_it_is_in_equilibrium(rolled):
    _, state = rolled
    for report in state.reports:
        along = np.array([force[0] for force in report.forces.values()])
        assert abs(along.sum()) < 1e-6 * np.abs(along).max()


@pytest.mark.slow
def test_a_resumed_run_has_the_same_friction(rolled):
    scene, state = rolled
    again = State.from_data(state.to_data(), scene)
    assert again.stage.friction_shares == state.stage.friction_shares
    for stroke in scene.program.cycle:
        assert again.stage.stroke_loads(stroke) == state.stage.stroke_loads(stroke)
