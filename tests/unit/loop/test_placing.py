"""A part that friction rolls over on its way to a wall is mounted beside that wall."""

from dataclasses import replace

import numpy as np
import pytest

import ngwear as nw
from ngwear.equilibrium.newton import Outcome, Report
from ngwear.errors import ConvergenceError
from ngwear.loop import first_cycle as module
from ngwear.loop.element_sizes import coarse_for_mounting, with_mounting_lengths
from ngwear.loop.first_cycle import first_cycle
from ngwear.loop.mounting import mount, unworn_body
from ngwear.loop.placing import place_beside_wall, placed, unloaded
from ngwear.loop.stage import Stage
from ngwear.loop.state import State
from ngwear.loop.stepper import Stepper
from ngwear.wear.jump_control import JumpControl

ROLLED = ConvergenceError("no equilibrium", Report(Outcome.ROLLED))
ROOM, SIZE = 1.5, 1.5  # on either side of the ring along the axis, and its cord [mm]


def ring(*, room=ROOM, **changes):
    """A thin O-ring in the middle of a long groove, between a rod that rubs and a groove that holds."""
    t = np.linspace(0.0, 2 * np.pi, 49)[:-1]
    points = np.column_stack([SIZE / 2 * np.cos(t), 20.0 + SIZE / 2 * (1 + np.sin(t))])
    gap = 0.15 * SIZE
    walls = {"left": -(SIZE / 2 + room), "right": SIZE / 2 + room}
    contacts = [
        nw.Contact("rod", surface=nw.rod(2 * (20.0 + gap)), friction=0.3, specific_wear_rate=1e-8),
        nw.Contact("groove", surface=nw.bore(2 * (20.0 + SIZE)), friction=0.5, slides=False),
        *(
            nw.Contact(
                name, surface=nw.Plane(point=(x, 0.0), normal_vector=(-np.sign(x), 0.0)), friction=0.5, slides=False
            )
            for name, x in walls.items()
        ),
    ]
    return nw.Scene(
        "ring",
        nw.Part(
            nw.Outline(points, ["skin"] * len(points), [False] * len(points)),
            material=nw.NeoHooke(shear=1.0, bulk_modulus=1000.0),
        ),
        contacts=contacts,
        program=nw.Program(strokes=20, cycle=[nw.Stroke("out", direction=-1, travel=20.0)]),
        accuracy=nw.Accuracy.draft(),
        **changes,
    )


@pytest.fixture(scope="module")
def mounted():
    """The state of such a ring between rod and groove, before its first stroke."""
    scene = coarse_for_mounting(with_mounting_lengths(ring()))
    stage = Stage(scene, unworn_body(scene, 6.0))
    state = State(stage, [], JumpControl(0.1))
    stage.begin_unloaded(unloaded(state))
    mount(stage, lambda fraction: None)
    return state


@pytest.fixture
def state(mounted):
    vector = mounted.stage.problem.state.vec.FV().NumPy()
    keep = vector.copy()
    yield replace(mounted, placed=(0.0, 0.0))
    vector[:] = keep


def test_it_is_placed_where_it_touches_the_wall_that_friction_drives_it_to(state):
    state.stage.friction_shares["out"] = (0.5, "rolls the part over")
    assert place_beside_wall(state) == ""
    assert state.placed == (pytest.approx(-ROOM, rel=1e-4), 0.0)
    assert state.stage.friction_shares == {}
    (told,) = placed(state)
    assert "mounted (-1.5, 0) mm from where it is drawn" in told.sentence


def test_it_begins_there_without_a_load(state):
    state.placed = (-1.0, 0.0)
    vector = unloaded(state)
    assert np.array_equal(vector, state.stage.problem.state.vec.FV().NumPy())
    gap = state.stage.contacts["left"].profile().gap.min()
    assert gap == pytest.approx(ROOM - 1.0, rel=1e-3)
    assert state.stage.problem.jacobians() == pytest.approx(1.0, abs=1e-12)


@pytest.fixture
def ways(state, monkeypatch):
    """Where and how the first cycle is tried, and the errors of the first tries."""
    tried, errors = [], []

    def cycle(state, *args, **how):
        tried.append((state.placed != (0.0, 0.0), how))
        if errors:
            raise errors.pop(0)
        return []

    monkeypatch.setattr(module, "_first_cycle", cycle)
    state.work.solves = 1
    yield tried, errors
    state.work.solves = 0


def test_one_that_rolls_is_placed_before_its_friction_is_lowered(state, ways):
    tried, errors = ways
    errors += [ROLLED]
    first_cycle(state, lambda fraction: None, None)
    assert tried == [(False, {"lowers": False}), (True, {"shorter": False})]


def test_one_that_finds_no_state_at_the_wall_stays_as_drawn(state, ways):
    tried, errors = ways
    errors += [ROLLED, ConvergenceError("none")]
    first_cycle(state, lambda fraction: None, None)
    assert tried[2:] == [(False, {})]
    assert placed(state) == []


def test_one_that_has_rolled_on_coarser_elements_is_not_placed_again(state, ways):
    tried, _ = ways
    state.stage.friction_shares["out"] = (0.5, "rolls the part over")
    first_cycle(state, lambda fraction: None, None)
    assert tried == [(False, {"lowers": True})]
    state.stage.friction_shares.clear()


def test_it_is_placed_for_rolling_only(state, ways):
    tried, errors = ways
    errors += [ConvergenceError("none", Report(Outcome.CREASED))]
    with pytest.raises(ConvergenceError, match="none"):
        first_cycle(state, lambda fraction: None, None)
    assert len(tried) == 1


def test_without_a_wall_that_way_the_error_says_so(state, ways):
    tried, errors = ways
    errors += 3 * [ROLLED]
    scene = state.stage.scene
    walls = [contact for contact in state.stage.contacts if contact != "left"]
    there = Stage(replace(scene, contacts=[c for c in scene.contacts if c.name in walls]), state.stage.body)
    for name in walls:
        mine, other = there.problem, state.stage.problem
        pressure = there.contacts[name].pressure_name
        mine.fields[pressure].vec.data = other.fields[pressure].vec
    mine.fields["displacement"].vec.data = other.fields["displacement"].vec
    with pytest.raises(ConvergenceError, match="no equilibrium; no surface stops the part on its way there"):
        first_cycle(replace(state, stage=there), lambda fraction: None, None)
    assert [placed for placed, _ in tried] == [False, False, False]


@pytest.mark.slow
def test_a_ring_that_would_roll_all_along_its_groove_runs():
    state = Stepper(ring()).start()
    assert state.placed[0] == pytest.approx(-ROOM, rel=1e-3)
    (report,) = state.reports
    forces = report.forces
    assert forces["left"][0] == pytest.approx(-forces["rod friction"][0] - forces["groove friction"][0], rel=1e-6)
    assert forces["left"][0] > -forces["rod friction"][0] > 0
    assert any(found.key == "placed" for found in report.findings)
