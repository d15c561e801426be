"""The logic of cost studies on made-up runs: orders, fronts, choice, budget. No solver."""

import math
from dataclasses import replace

import pytest

from ngwear.error_estimates.convergence_order import observed_order, reference_error, relative
from ngwear.error_estimates.cost_table import as_dict, table
from ngwear.error_estimates.cost_text import paragraph
from ngwear.error_estimates.ladder import STOPPED, Ladder, Measurement
from ngwear.error_estimates.pareto_front import cheapest, pareto_front, power_law, product_seconds
from ngwear.error_estimates.settings_search import confirm, run_ladders
from ngwear.errors import SceneError
from ngwear.files.result_folder import COMPLETED, GAVE_UP

DEPTH = "maximum depth [mm]"
LIMIT, MESH_ERROR, JUMP_ERROR = 1.0, 2.0, 0.1


def ladder(name, values, own, cost_exponent=1.0, **more):
    labels = tuple(f"{name} {value:g}" for value in values)
    more |= {"own": own, "cost_exponent": cost_exponent}
    return Ladder(name=name, column=f"{name} [-]", values=values, labels=labels, **more)


EDGE = ladder("edge", (0.4, 0.2, 0.1, 0.05, 0.025), 2, cost_exponent=1.0)
JUMP = ladder("jump", (0.32, 0.08, 0.02, 0.005, 0.0), 2, cost_exponent=0.5, most_solves=200)
LADDERS = (EDGE, JUMP)


class Fake:
    """Runs of known error and time: depth = 1 + 2 edge² + 0.1 jump, seconds = 0.1 / edge * solves / 20."""

    def __init__(self, *, breaks=(), slow=1.0):
        self.asked, self.breaks, self.slow = [], breaks, slow

    def __call__(self, setting, left):
        self.asked.append(setting)
        edge, jump = EDGE.values[setting[0]], JUMP.values[setting[1]]
        solves = round(20 * (0.02 / jump) ** 0.5) if jump else 200
        seconds = self.slow * 0.1 / edge * solves / 20
        if seconds > left:
            return Measurement(status=STOPPED, wall=left, needed=seconds)
        if setting in self.breaks:
            return Measurement(status=GAVE_UP, message="no equilibrium", wall=seconds)
        depth = LIMIT + MESH_ERROR * edge**2 + JUMP_ERROR * jump
        values = {DEPTH: depth, "worn area [mm^2]": 3.0}
        return Measurement(status=COMPLETED, values=values, cpu=seconds, wall=seconds, memory=100.0, solves=solves)


def study_of(budget, **how):
    fake = Fake(**how)
    study = run_ladders(LADDERS, DEPTH, budget, fake)
    return study, confirm(study, budget, fake), fake


def test_pareto_front_by_hand():
    points = [(1.0, 0.5), (2.0, 0.1), (1.5, 0.6), (4.0, 0.1), (3.0, 0.05), (1.0, 0.7), (9.0, 0.01)]
    assert pareto_front(points) == [0, 1, 4, 6]
    assert pareto_front([]) == []


@pytest.mark.parametrize("p", [0.5, 1.0, 2.0, 3.3])
@pytest.mark.parametrize("values", [(0.4, 0.2, 0.1), (0.4, 0.1, 0.05), (0.4, 0.1, 0.0), (7.0, 0.9, 0.8, 0.3)])
def test_order_of_manufactured_errors(p, values):
    assert observed_order(values, [5.0 - 3.0 * v**p for v in values]) == pytest.approx(p, rel=1e-6)


@pytest.mark.parametrize("results", [(1.0, 2.0), (1.0, 2.0, 2.0), (1.0, 2.0, 1.5), (1.0, 1.1, 1.3)])
def test_no_order_where_none_shows(results):
    assert observed_order((0.4, 0.2, 0.1)[: len(results)], results) is None


def test_error_of_the_finest_by_hand():
    values, exact = (0.4, 0.2, 0.1), 5.0
    results = [exact + 0.3 * v**2 for v in values]
    assert reference_error(values, results) == pytest.approx(0.3 * 0.01 / results[-1], rel=1e-6)
    assert reference_error(values, results, smooth=False) == pytest.approx(relative(results[1], results[2]))
    assert reference_error((0.2, 0.0), (1.1, 1.0)) == 0.0, "a value of 0 has no error"
    assert reference_error((0.2,), (1.1,)) is None
    assert relative(0.0, 0.0) == 0.0
    assert relative(1.0, 0.0) == math.inf


def test_seconds_by_power_law():
    assert power_law((0.2,), (3.0,), 0.1, 1.0) == pytest.approx(6.0)
    assert power_law((0.4, 0.2), (1.0, 4.0), 0.1, 1.0) == pytest.approx(16.0)
    assert power_law((0.4, 0.2), (4.0, 1.0), 0.1, 1.0) == pytest.approx(2.0), "no faster when finer"
    assert power_law((0.4, 0.2), (1.0, 4.0), 0.1, 1.0, 9.0) == 9.0


def test_cheapest_combination_by_hand():
    error = {(0, 0): 0.3, (0, 1): 0.2, (1, 0): 0.04, (1, 1): 0.03}
    seconds = {(0, 0): 1.0, (0, 1): 2.0, (1, 0): 3.0, (1, 1): 3.1}
    levels = ((0, 1), (0, 1))

    def choose(target, **how):
        return cheapest(target, levels, error.__getitem__, seconds.__getitem__, **how)

    assert choose(0.25) == (0, 1)
    assert choose(0.05) == (1, 1), "hardly longer and more accurate"
    assert choose(0.05, own=(1, 0)) == (1, 0), "hardly longer, but nothing changed"
    assert choose(0.05, unfit=[(1, 0)]) == (1, 1)
    assert choose(0.01) is None
    each = ({0: 1.0, 1: 4.0}, {0: 0.5, 1: 1.0})
    assert product_seconds((0, 1), each, (1, 0)) == pytest.approx(2.0)


def test_ample_budget_climbs_everything_and_finds_errors_and_orders():
    study, choices, fake = study_of(1000.0)
    assert len(fake.asked) == len(set(fake.asked)), "no run twice"
    assert set(study.levels(0)) == set(range(5))
    assert set(study.levels(1)) == set(range(5))
    assert not study.left_out
    assert study.order(0, DEPTH) == pytest.approx(2.0, rel=1e-6)
    assert study.order(1, DEPTH) == pytest.approx(1.0, rel=1e-6)
    exact = LIMIT
    for setting, run in study.runs.items():
        true = abs(run.values[DEPTH] - exact) / exact
        assert study.error(setting, DEPTH) == pytest.approx(true, rel=0.05, abs=2e-4)
        assert study.error(setting, "worn area [mm^2]") == 0.0
    for choice in choices[:2]:
        assert choice.measured
        assert abs(study.runs[choice.setting].values[DEPTH] - exact) <= choice.target
        worse = [s for s in study.runs if study.error(s, DEPTH) <= choice.target]
        assert study.seconds(choice.setting) <= 1.05 * min(study.seconds(s) for s in worse)
    assert choices[2].setting is None, "0.1 % is beyond the finest mesh, which errs by 0.125 %"
    text = paragraph("block", study, choices, 1000.0)
    assert "not reached within the budget" in text
    assert "edge 0.1" in text


def test_a_coarse_rung_near_the_reference_by_chance_is_not_believed():
    def lucky(setting, left):
        run = Fake()(setting, left)
        return replace(run, values={DEPTH: LIMIT}) if setting == (0, 2) else run

    study = run_ladders(LADDERS, DEPTH, 1000.0, lucky)
    assert study.level_error(0, 0, DEPTH) < study.level_error(0, 1, DEPTH)
    assert study.part(0, 0, DEPTH) == study.part(0, 1, DEPTH) > study.part(0, 2, DEPTH)


def test_jumps_that_are_single_strokes_already_are_not_refined_further():
    def short(setting, left):
        run = Fake()(setting, left)
        return replace(run, solves=210) if setting[1] >= 2 else run

    study = run_ladders(LADDERS, DEPTH, 1000.0, short)
    assert set(study.levels(1)) == {0, 1, 2, 4}


def test_front_holds_no_run_that_another_beats():
    study, *_ = study_of(1000.0)
    front = study.front()
    for s in study.runs:
        beaten = [f for f in front if study.runs[f].cpu <= study.runs[s].cpu]
        assert any(study.error(f, DEPTH) <= study.error(s, DEPTH) for f in beaten)


def test_partial_budget_gives_a_partial_answer():
    study, choices, _ = study_of(12.0)
    assert study.spent <= 12.0
    assert study.left_out
    for setting, seconds in study.left_out.items():
        alone = Fake()(setting, math.inf).wall
        assert seconds == pytest.approx(alone, rel=0.6)
    assert "No time was left for" in paragraph("block", study, choices, 12.0)
    for choice in choices:
        if choice.measured:
            assert study.error(choice.setting, DEPTH) <= choice.target


def test_tiny_budget_runs_what_it_can_and_promises_nothing():
    study, choices, _ = study_of(1.05)
    assert len(study.runs) == 1
    assert all(choice.setting is None for choice in choices)
    text = paragraph("block", study, choices, 1.05)
    assert "The scene as given was not run: it would take about 1 s" in text
    assert "For 5 %, 1 % and 0.1 % of the maximum depth: not reached" in text
    assert "were tried with" not in text
    assert not set(study.left_out) & set(study.runs)
    assert [row["error of maximum depth [-]"] for row in table(study)] == [""]


def test_scene_is_tried_on_the_coarsest_mesh_if_the_coarser_one_is_too_slow():
    study, _, fake = study_of(0.7)
    assert fake.asked == [(1, 2), (0, 2)]
    assert set(study.levels(0)) == {0}


def test_too_small_a_budget_says_what_it_would_take():
    with pytest.raises(SceneError, match=r"on a mesh of edge 0.4 it takes about 25 s; give 250 s or more"):
        run_ladders(LADDERS, DEPTH, 1.0, Fake(slow=100.0))

    def unknown(setting, left):
        return Measurement(status=STOPPED, wall=left)

    with pytest.raises(
        SceneError, match=r"takes more than 30 s \(measured by a run of 30 s beyond the budget\); give many"
    ):
        run_ladders(LADDERS, DEPTH, 1.0, unknown)

    def seen_later(setting, left):
        if left < 7.0:
            return unknown(setting, left)
        return Measurement(status=COMPLETED, values={DEPTH: 1.0}, wall=7.0)

    with pytest.raises(
        SceneError, match=r"takes about 7 s \(measured by a run of 7 s beyond the budget\); give 70 s or more"
    ):
        run_ladders(LADDERS, DEPTH, 1.0, seen_later)


def test_base_on_a_coarser_mesh_is_told():
    study, choices, _ = study_of(8.0)
    assert study.base == (1, 2)
    assert "other parameters were varied with edge 0.2" in paragraph("block", study, choices, 8.0).replace(
        "edge edge", "edge"
    )


def test_a_ladder_that_begins_with_the_scenes_own_rung_is_climbed_first():
    """Else a partial budget would tell nothing: all finer levels are dearer than coarse ones of other ladders."""
    step = ladder("time step", (1.0, 0.5, 0.25), 0)
    fake = Fake()

    def with_steps(setting, left):
        run = fake(setting[:2], left)
        times = step.values[setting[2]]
        values = {DEPTH: run.values[DEPTH] + 0.01 * times}
        return replace(run, wall=run.wall / times, cpu=run.cpu / times, values=values)

    study = run_ladders((*LADDERS, step), DEPTH, 9.0, with_steps)
    assert list(study.runs)[2] == (*study.base[:2], 1), "after the scene on two meshes"
    assert len(study.levels(2)) == 2
    assert study.left_out
    assert math.isfinite(study.predicted_error(study.base, DEPTH))


def test_same_measurements_same_plan():
    first, again = study_of(12.0), study_of(12.0)
    assert first[2].asked == again[2].asked
    assert first[1] == again[1]


def test_a_rung_that_gives_up_does_not_lose_the_others():
    study, choices, _ = study_of(1000.0, breaks={(0, 2), (2, 0), (4, 2)})
    assert set(study.levels(0)) == {1, 2, 3}
    assert set(study.levels(1)) == {1, 2, 3, 4}
    assert choices[0].measured
    text = paragraph("block", study, choices, 1000.0)
    assert "With edge 0.4, and with jump 0.32, and with edge 0.025 it gave up: no equilibrium." in text
    assert [row["reason [-]"] for row in table(study)].count("no equilibrium") == 3
    assert math.isinf(study.part(0, 0, DEPTH)), "nothing is known of a level that gave up below the finest"


def test_settings_that_give_up_alike_are_told_by_what_they_have_in_common():
    study, choices, _ = study_of(1000.0)
    study.runs |= {(1, i): Measurement(status=GAVE_UP, message="no equilibrium", wall=1.0) for i in (0, 1, 3)}
    study.runs[(0, 3)] = Measurement(status=GAVE_UP, message="torn", wall=1.0)
    text = paragraph("block", study, choices, 1000.0)
    assert "With edge 0.2, in 3 settings, it gave up: no equilibrium." in text
    assert "With edge 0.4, jump 0.005 it gave up: torn." in text


def test_measured_error_beyond_the_target_gives_way():
    ladders, first = (replace(EDGE, own=4), JUMP), (2, 1)
    study = run_ladders(ladders, DEPTH, 1000.0, Fake())
    assert confirm(study, 1000.0, Fake())[0].setting == first, "changes both parameters"

    def couples(setting, left):
        """Together they err by far more, which the ladders do not show."""
        run = Fake()(setting, left)
        return replace(run, values={DEPTH: run.values[DEPTH] + 0.5 * (setting == first)})

    study = run_ladders(ladders, DEPTH, 1000.0, couples)
    choice = confirm(study, 1000.0, couples)[0]
    assert first in study.runs, "was tried, as the sum of the single errors promised"
    assert choice.setting != first
    assert choice.measured
    assert study.error(choice.setting, DEPTH) <= choice.target


def test_errors_that_do_not_add_up_show_in_the_finest_run():
    def couples(setting, left):
        run = Fake()(setting, left)
        return replace(run, values={DEPTH: run.values[DEPTH] + 0.02 * (setting == (4, 4))})

    study = run_ladders(LADDERS, DEPTH, 1000.0, couples)
    choices = confirm(study, 1000.0, couples)
    assert study.finest in study.runs
    assert study.error(study.own, DEPTH) == pytest.approx(0.02, rel=0.2)
    assert choices[1].setting == study.finest


def test_json_has_no_infinities_and_a_row_a_run():
    import json

    study, choices, _ = study_of(12.0)
    told = as_dict(study, choices)
    json.dumps(told, allow_nan=False)
    assert len(told["runs"]) == len(table(study)) == len(study.runs)
    assert all("[" in column for column in table(study)[0])
    assert [c["target [-]"] for c in told["recommended"]] == [0.05, 0.01, 0.001]
