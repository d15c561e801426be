from dataclasses import replace

import numpy as np
import pytest

from ngwear.refinement import outgrown, wanted_size
from ngwear.stepper import Stepper


@pytest.fixture
def started(sheet):
    def make(**accuracy):
        scene = replace(sheet, accuracy=replace(sheet.accuracy, **accuracy))
        return Stepper(scene).start()

    return make


def test_a_contact_asks_for_the_patch(started):
    state = started(stress_error=1.0)
    stage, phases = state.stage, [p.vector for p in state.phases]
    field = wanted_size(stage, phases)
    profile = state.reports[0].contacts["roller"]
    middle = profile.reference[np.argmax(profile.pressure)]
    patch = stage.scene.accuracy.patch
    assert field(middle)[0] == pytest.approx(patch)
    assert field(np.array([[0.1, 0.1]]))[0] > 1.5 * patch
    assert not outgrown(stage, phases)


def test_stresses_ask_for_more_where_they_are_worst(started):
    """The bonded bottom's corners are singular: a small stress_error refines there, far from the contact."""
    state = started(stress_error=1.0)
    stage, phases = state.stage, [p.vector for p in state.phases]
    tight = replace(stage.scene, accuracy=replace(stage.scene.accuracy, stress_error=0.01))
    stage.scene = tight
    seeds = wanted_size(stage, phases).seeds
    away = seeds[np.abs(seeds[:, 1] - 2.0) > 1e-9]
    assert len(away) > 0
    assert outgrown(stage, phases)
    assert started(stress_error=0.01).stage.body.mesh.ne > 1.3 * stage.body.mesh.ne


def test_recovery_keeps_a_constant_and_smooths_a_jump(started):
    points = started().stage.problem.points
    right = points.centres[:, 0] > 2.0
    values = np.stack([np.ones(points.volumes.shape), np.ones(points.volumes.shape) * right[:, None]], axis=-1)
    smooth = points.recovered(values)
    assert smooth[..., 0] == pytest.approx(1.0)
    assert smooth[..., 1].min() + 1e-9 > 0.0
    jump = np.abs(smooth[..., 1] - values[..., 1]).max(axis=1)
    near = np.abs(points.centres[:, 0] - 2.0) < 3 * points.edges.max()
    assert jump[near].max() > 0.1
    assert jump[~near].max() < 1e-9
