"""Pockets between two contacts with a surface: what they hold when the fluid's pressure falls."""

from dataclasses import replace

import numpy as np
import pytest
from valve import HIGH, valve

import ngwear as nw
from ngwear.effects.fluid_pressure import LESS
from ngwear.effects.pockets import pockets
from ngwear.geometry.outline import Outline
from ngwear.loop.stepper import Stepper


@pytest.fixture(scope="module")
def trapped():
    return Stepper(valve("trapped")).start()


def found(state):
    """The pockets, in the state at the end of the last stroke."""
    stage = state.stage
    return pockets(stage.body, stage.problem.fields["displacement"], list(stage.contacts.values()))


def presses(report):
    """Force of the fluid and of what it has trapped, on lip and roof."""
    return report.forces["fluid"][1] + report.forces["trapped fluid"][1]


def test_the_fluid_fills_an_empty_pocket():
    """It lifts the lip; with the same pressure on both sides the lip may close again."""
    stepper = Stepper(valve("trapped"))
    state = stepper.start()
    state.phases[-1].left = np.empty((0, 3))
    full, _ = stepper.solve_next_cycle(state)
    assert presses(full) > 1.9 * HIGH


def test_a_pocket_keeps_what_its_contacts_carry(trapped):
    """When the fluid's pressure is gone, the pocket presses the lip down; the next cycle finds it full."""
    full, after = trapped.reports
    assert full.trapped == pytest.approx(HIGH)  # of the cycle before, on coarser elements
    assert presses(full) > 1.9 * HIGH
    assert after.trapped == pytest.approx(HIGH)
    (pocket,) = found(trapped)
    assert pocket.holds > HIGH
    assert {"inside", "roof", "flank"} <= set(trapped.stage.body.outline.names[pocket.edges])


def test_its_force_is_its_pressure_on_its_width(trapped):
    after, profile = trapped.reports[1], trapped.stage.contacts["plate"].profile()
    ends = np.sort([place[0] for zone in profile.zones() for place in (zone.start, zone.end)])
    assert after.forces["trapped fluid"][1] == pytest.approx(HIGH * (ends[2] - ends[1]), rel=0.05)


def test_what_they_do_not_carry_leaks_out():
    state = Stepper(valve("trapped")).start()
    term, given = state.stage.trapped, state.phases[0].left.copy()
    holds = found(state)[0].holds
    given[:, 2] = 4 * holds
    term.leave(given)
    term.prepare()  # as if solved with it
    assert term.refresh(solved=True)
    assert term.pressures.max() == pytest.approx(holds / (1 - LESS))


def test_ambient_pockets_keep_nothing():
    state = Stepper(valve("ambient")).start()
    assert state.reports[1].trapped is None
    assert "trapped fluid" not in state.reports[1].forces


def test_what_was_never_wetted_holds_nothing():
    state = Stepper(valve("trapped", pressures=(0.0, 0.0))).start()
    assert [report.trapped for report in state.reports] == [0.0, 0.0]


def test_it_goes_on_with_the_strokes_and_on_new_meshes(trapped):
    """As much after a run with wear, remeshes and cycles as in the first one."""
    result = nw.run(replace(valve("trapped"), program=replace(valve("trapped").program, strokes=20)), progress=False)
    column = [row["pressure trapped in pockets [MPa]"] for row in result.records.rows]
    assert max(column) == pytest.approx(trapped.reports[1].trapped, rel=0.05)


def test_a_pressure_that_falls_leaves_the_pocket_at_the_higher_one():
    state = Stepper(valve("trapped", pressures=(HIGH, 0.4 * HIGH))).start()
    assert state.reports[1].trapped == pytest.approx(HIGH)


def test_a_wrong_choice_is_refused():
    with pytest.raises(nw.SceneError, match=r"fluid.pockets = 'vacuum'.*'ambient' or 'trapped'"):
        valve("vacuum")


def test_an_inlet_in_a_closed_pocket_is_refused():
    scene = valve("ambient")
    scene = replace(scene, fluid=replace(scene.fluid, inlet=["roof"]))
    with pytest.raises(nw.SceneError, match=r"fluid.inlet = \['roof'\].*a pocket that the contact 'plate' closes"):
        Stepper(scene).start()


def test_the_surroundings_are_no_pocket():
    """Fluid all around a block on a plate: both ends of its contact are on the same surface."""
    scene = valve("trapped")
    outline = Outline.rectangle((0.0, 3.0), (0.0, 2.0))
    around = replace(
        scene,
        part=replace(scene.part, outline=outline),
        contacts=[replace(scene.contacts[0], edges=["bottom", "left", "right"])],
        fluid=nw.Fluid(edges=["left", "bottom", "right"], inlet=["left"], pockets="trapped"),
    )
    state = Stepper(around).start()
    assert found(state) == []
