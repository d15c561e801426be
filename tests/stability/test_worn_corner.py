"""Where a worn contact ends in a corner of the outline, finer elements find no spike of pressure."""

from dataclasses import replace
from pathlib import Path

import pytest

from ngwear.loop.finer_mesh import refine_everywhere
from ngwear.loop.state import State
from ngwear.loop.stepper import Stepper
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.read_scene import read_scene

SCENE = Path(__file__).parents[2] / "geometries/u_cup/scene.toml"


def peaks(state: State) -> list[float]:
    """Peak pressure of each stroke [MPa]."""
    found = []
    for phase in state.phases:
        state.stage.problem.state.vec.FV().NumPy()[:] = phase.vector
        found.append(float(state.stage.contacts["rod"].profile().pressure.max()))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("strokes", [12000, 17000])
def test_finer_elements_find_no_ridge_at_the_end_of_a_worn_contact(strokes):
    """Wear that leaves curves within mesh edges gives a peak 2.8 and 3.8 times as high on elements half as large."""
    scene = read_scene(SCENE)
    cycle = tuple(replace(stroke, pressure=0.0) for stroke in scene.program.cycle)
    program = replace(scene.program, strokes=strokes, cycle=cycle)
    stepper = Stepper(replace(scene, program=program, accuracy=Accuracy(across=6.0)))
    state = stepper.start()
    while not stepper.finished(state):
        state = stepper.advance(state)
    stepper.solve_next_cycle(state)
    coarse = peaks(state)
    refine_everywhere(state)
    stepper.settle_on_new_mesh(state)
    assert max(peaks(state)) < 2.0 * max(coarse)
