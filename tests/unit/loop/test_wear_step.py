"""Backward differences of the worn depth, what a new mesh keeps of them, and the error of a step."""

from dataclasses import replace

import numpy as np
import pytest

from ngwear.errors import MeshError
from ngwear.geometry.outline import Outline
from ngwear.loop.finer_mesh import refine_everywhere
from ngwear.loop.remeshing import _Interpolation
from ngwear.loop.stepper import Stepper
from ngwear.loop.stroke_solve import solve_stroke
from ngwear.loop.wear_step import WearStep, _follow
from ngwear.scene.accuracy import Accuracy
from ngwear.wear.backward_differences import error_over_difference, share_of_last


def worn(ways):
    """dw/ds = 1 - w from w = 0, by the steps of ``wear.backward_differences``."""
    depth, mean, before = 0.0, 0.0, 0.0
    for way in ways:
        last = share_of_last(way, before)
        pressure = (1 - depth - last * way * mean) / (1 + (1 - last) * way)  # p_1 = 1 - w_1
        mean, before = last * mean + (1 - last) * pressure, way
        depth += way * mean
    return depth


def test_weight_of_the_last_step():
    assert share_of_last(1.0, 0.0) == 0.0
    assert share_of_last(2.0, 2.0) == pytest.approx(1 / 3)
    assert share_of_last(1e9, 1.0) == pytest.approx(0.5)


@pytest.mark.parametrize("grading", [1.0, 1.5])
def test_order_is_two_with_even_and_with_growing_steps(grading):
    errors = []
    for n in (20, 40, 80):
        places = 2.0 * np.linspace(0.0, 1.0, n + 1) ** grading
        errors.append(abs(worn(np.diff(places)) - (1 - np.exp(-2.0))))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > 1.85).all(), orders


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0])
def test_the_difference_from_the_trapezoidal_rule_tells_the_error_of_a_step(ratio):
    """Of a pressure exp(-s) that is known until the step; the first step is backward Euler."""
    before, way = 1e-3, ratio * 1e-3
    last, begin, end = (np.exp(before) - 1) / before, 1.0, np.exp(-way)
    exact, trapezoidal = (1 - end) / way, (begin + end) / 2
    for share, length in ((share_of_last(way, before), before), (0.0, 0.0)):
        step = share * last + (1 - share) * end
        told = (step - trapezoidal) * error_over_difference(way, length)
        assert told == pytest.approx(step - exact, rel=3e-3)


def test_a_stiff_step_lands_on_the_steady_state():
    assert worn([1e6] * 4) == pytest.approx(1.0, abs=1e-5)


def test_a_new_outline_keeps_the_shape_of_values():
    angle = np.linspace(0, 2 * np.pi, 41)[:-1]
    fine = np.linspace(0, 2 * np.pi, 67)[:-1]
    before, after = (
        Outline(np.stack([np.cos(a), np.sin(a)], axis=1), ("rim",) * len(a), np.zeros(len(a), dtype=bool))
        for a in (angle, fine)
    )
    moved = _Interpolation(before, after)(np.stack([1 + np.cos(angle), np.zeros_like(angle)]))
    assert np.abs(moved[0] - (1 + np.cos(fine))).max() < 5e-3
    assert (moved[1] == 0).all()


def test_a_new_mesh_keeps_worn_areas_and_pressures(fine_sheet):
    stepper = Stepper(fine_sheet)
    state = stepper.advance(stepper.start())
    last = state.phases[0].worn
    peak = (last.end / last.lengths[0]).max()
    refine_everywhere(state)
    new = state.phases[0].worn
    assert new.end.shape[1] == len(state.contour) != last.end.shape[1]
    assert new.end.sum() == pytest.approx(last.end.sum(), rel=1e-12)
    assert new.mean.sum() == pytest.approx(last.mean.sum(), rel=1e-12)
    assert (new.end / new.lengths[0]).max() == pytest.approx(peak, rel=0.05)


@pytest.fixture(scope="module")
def coarse_seal(seal):
    """The shipped seal with half an element across the lip after thirty strokes, and the strokes after each step."""
    coarse = replace(seal, accuracy=Accuracy(patch=0.04, mounting=0.04))
    stepper = Stepper(replace(coarse, save=replace(seal.save, strokes=())))
    state, done = stepper.start(), [0]
    while state.strokes < 30 or len(done) <= 5:
        state = stepper.advance(state)
        done.append(state.strokes)
    return stepper, state, done


@pytest.mark.slow
def test_on_a_coarse_patch_what_a_step_errs_by_is_a_matter_of_its_length(coarse_seal):
    """What the mesh does to pressures is no error of the wear steps."""
    jumps = np.diff(coarse_seal[2][:6])
    assert jumps[-1] > 4 * jumps[0], jumps


@pytest.mark.slow
def test_where_nodes_cannot_follow_the_strokes_to_come_leave_air(coarse_seal, monkeypatch):
    """The outward stroke's peak with the inward strokes' wear in its outline, as air under it, and left out."""
    stepper, state, _ = coarse_seal
    cycles = state.control.cycles
    outward, inward = (stepper._strokes(kind, state.strokes, cycles) for kind in (0, 1))

    def peak(later, *, follows):
        saved = state.saved()
        with monkeypatch.context() as patch:
            if not follows:
                patch.setattr(state.stage.body, "move_to", _refuse)
            WearStep.begin(state, 0, outward, later=later)
        solve_stroke(state, 0, state.stage.scene.program.cycle[0], outward)
        found = state.stage.contacts["rod"].profile().pressure.max()
        state.restore(saved)
        return found

    whole = peak({1: inward}, follows=True)
    air, none = (abs(peak(later, follows=False) / whole - 1.0) for later in ({1: inward}, {}))
    assert air < 0.4 * none, (air, none)


def _refuse(contour):
    raise MeshError("an element would turn inside out")


def test_a_tongue_that_the_mesher_cannot_fill_is_taken_off_and_booked(fine_sheet):
    stepper = Stepper(fine_sheet)
    state = stepper.advance(stepper.start())
    outline, worn = state.contour, fine_sheet.contacts[0].edges[0]
    where = np.flatnonzero(outline.on((worn,)))
    i = int(where[len(where) // 2])
    a, b = outline.points[i], outline.points[i + 1]
    along, length = (b - a) / outline.lengths[i], outline.lengths[i]
    out = np.array([along[1], -along[0]]) * length
    tongue = np.array([a + 0.45 * (b - a), a + 0.5 * (b - a) + out, a + 0.55 * (b - a)])
    new = Outline(
        np.insert(outline.points, i + 1, tongue, axis=0),
        outline.names[: i + 1] + (worn,) * 3 + outline.names[i + 1 :],
        np.insert(outline.corners, i + 1, [False] * 3),
    )
    removed = state.ledger.removed
    with pytest.raises(MeshError):
        _follow(state, outline, new)  # too much for a step that wears nothing
    _follow(state, replace(outline, points=1.1 * outline.points), new)  # little of what such a step wears
    assert state.ledger.removed - removed == pytest.approx(0.05 * length**2, rel=1e-6)
    assert state.contour.area == pytest.approx(outline.area, rel=1e-9)
