from dataclasses import replace

import numpy as np
import pytest

from ngwear.effects.contact_profile import ContactProfile
from ngwear.loop.element_sizes import with_patch
from ngwear.loop.refinement import LEAST, NARROWEST, NEAR, contact_sizes, element_edges, is_too_coarse, required_sizes
from ngwear.loop.stepper import Stepper
from ngwear.scene.accuracy import Accuracy


@pytest.fixture
def started(fine_sheet):
    def make(**accuracy):
        scene = replace(fine_sheet, accuracy=replace(fine_sheet.accuracy, **accuracy))
        return Stepper(scene).start()

    return make


def test_a_contact_asks_for_the_patch(started):
    state = started(stress_error=1.0)
    stage, phases = state.stage, [p.vector for p in state.phases]
    field = required_sizes(stage, phases)
    profile = state.reports[0].contacts["roller"]
    middle = profile.reference[np.argmax(profile.pressure)]
    patch = stage.scene.accuracy.patch
    assert field(middle)[0] == pytest.approx(patch)
    assert field(np.array([[0.1, 0.1]]))[0] > 1.5 * patch
    assert not is_too_coarse(stage, phases)


def test_stresses_ask_for_more_where_they_are_worst(started):
    """The bonded bottom's corners are singular: a small stress_error refines there, far from the contact."""
    state = started(stress_error=1.0)
    stage, phases = state.stage, [p.vector for p in state.phases]
    tight = replace(stage.scene, accuracy=replace(stage.scene.accuracy, stress_error=0.01))
    stage.scene = tight
    seeds = required_sizes(stage, phases).seeds
    away = seeds[np.abs(seeds[:, 1] - 2.0) > 1e-9]
    assert len(away) > 0
    assert is_too_coarse(stage, phases)
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


def test_narrow_zones_have_elements_of_their_own():
    """A gap beside a zone takes the nearest zone's, and lengths are the same everywhere."""
    t = np.arange(12.0)
    loaded = np.isin(t, [1, 2, 3, 6, 7, 10])
    place = np.stack([0.1 * t, np.zeros(12)], axis=1)
    profile = ContactProfile(
        t=t,
        reference=place,
        place=place,
        nominal_pressure=1.0 * loaded,
        pressure=1.0 * loaded,
        gap=0.01 * ~loaded,
        weight=np.full(12, 0.1),
        load=0.1 * loaded,
        edges=np.stack([np.arange(11), np.arange(1, 12)], axis=1),
        mean=0.5 * (1.0 * loaded[1:] + loaded[:-1]),
        standing_off=np.zeros(11),
    )
    assert len(profile.zones()) == 3
    widths = profile.bump_widths()[[2, 6, 10]]
    assert widths[0] > widths[1] > widths[2]
    patch = widths[0] / 4
    sizes = element_edges(profile, patch, 4.0)
    assert sizes[[0, 1, 2, 3, 4]] == pytest.approx(patch)
    assert sizes[[5, 6, 7, 8]] == pytest.approx(widths[1] / 4)
    assert sizes[[9, 10, 11]] == pytest.approx(max(widths[2] / 4, NARROWEST * patch))
    narrow = element_edges(profile, 8 * patch, 4.0, narrow=True)
    mean = sum(load * width for load, width in profile.loads_and_widths()) / profile.load.sum()
    assert narrow[10] == pytest.approx(max(widths[2] / 4, NARROWEST * mean / 4))
    assert element_edges(profile, 8 * patch, 4.0)[10] == pytest.approx(2 * patch)
    assert element_edges(profile, patch, None) == pytest.approx(patch)
    assert element_edges(replace(profile, pressure=np.zeros(12)), patch, 4.0) == pytest.approx(patch)


def profile_of(x, pressure):
    """A contact along the axis; its ends lie half an edge beyond the last loaded nodes."""
    k = len(x)
    place = np.stack([x, 0 * x], axis=1)
    return ContactProfile(
        t=np.arange(float(k)),
        reference=place,
        place=place,
        nominal_pressure=pressure,
        pressure=pressure,
        gap=np.where(pressure > 0, 0.0, 0.01),
        weight=np.full(k, x[1] - x[0]),
        load=(x[1] - x[0]) * pressure,
        edges=np.stack([np.arange(k - 1), np.arange(1, k)], axis=1),
        mean=0.5 * (pressure[1:] + pressure[:-1]),
        standing_off=np.zeros(k - 1),
    )


def test_a_hertz_pressure_has_one_bump_as_wide_as_the_contact():
    x = np.linspace(-1.1, 1.1, 221)
    profile = profile_of(x, np.sqrt(np.clip(1 - x**2, 0.0, None)))
    (zone,), widths = profile.zones(), profile.bump_widths()
    assert zone.width == pytest.approx(2.0, rel=0.01)
    assert widths[profile.pressure > 0.02] == pytest.approx(2.0, rel=0.01)
    assert (widths[profile.pressure == 0] == 0).all()


def test_lobes_that_touch_and_a_peak_at_an_end_have_widths_of_their_own():
    x = np.linspace(0.0, 4.0, 801)
    lobes = sum(h * np.sqrt(np.clip(1 - ((x - c) / r) ** 2, 0.0, None)) for c, r, h in ((1, 0.9, 2), (2.7, 0.9, 3)))
    tip = 12 * np.clip(1 - np.abs(x - 3.5) / 0.05, 0.0, None)
    profile = profile_of(x, np.where(lobes > 0, lobes + tip, 0.0))
    (zone,), widths = profile.zones(), profile.bump_widths()
    assert zone.width == pytest.approx(3.5, rel=0.01)
    left, valley, right, peak = (int(np.abs(x - place).argmin()) for place in (1.0, 1.85, 2.7, 3.5))
    assert widths[left] == pytest.approx(1.8, rel=0.02)
    assert widths[valley] == pytest.approx(zone.width, rel=0.05)
    assert widths[right] == pytest.approx(1.8, rel=0.06)  # the peak at its end is above its half, too
    assert widths[peak] < 0.1
    sizes = element_edges(profile, zone.width / 6, 6.0)
    assert sizes[[left, right]] == pytest.approx([0.3, 0.3], rel=0.06)
    assert sizes[valley] == pytest.approx(zone.width / 6, rel=0.05)
    assert sizes[peak] == pytest.approx(NARROWEST * zone.width / 6)
    every = profile_of(x[::20], profile.pressure[::20])  # elements of 0.1 mm: a worn outline has points for no others
    at = int(np.abs(every.place[:, 0] - 3.5).argmin())
    assert element_edges(every, zone.width / 12, 40.0)[at] < 0.09
    assert element_edges(every, zone.width / 12, 40.0, worn=True)[at] == pytest.approx(0.1)


def test_the_element_edge_in_contact_is_the_mean_by_load():
    place = np.stack([[0.0, 0.1, 0.3, 0.6], np.zeros(4)], axis=1)
    values = dict.fromkeys(("nominal_pressure", "pressure", "gap", "weight", "load"), np.zeros(4))
    edges, t = np.array([[0, 1], [1, 2], [2, 3]]), np.arange(4.0)
    profile = ContactProfile(
        t=t,
        reference=place,
        place=2 * place,
        edges=edges,
        mean=np.array([3.0, 1.0, -1.0]),
        standing_off=np.zeros(3),
        **values,
    )
    assert profile.element_edge == pytest.approx((0.3 * 0.1 + 0.2 * 0.2) / 0.5)
    assert replace(profile, mean=np.zeros(3)).element_edge == 0.0


def test_few_elements_across_follow_the_outline_less_closely(sheet):
    state = Stepper(replace(sheet, accuracy=Accuracy(across=4.0))).start()
    stage, phases = state.stage, [p.vector for p in state.phases]
    fields = [contact_sizes(stage, phases, across=across) for across in (None, 8.0, 6.0, 5.0, 4.0, 3.0, 2.5, 1.0)]
    assert [f.elsewhere for f in fields] == pytest.approx([0.5, 0.5, 0.5, 0.5, 0.5, 2 / 3, 0.7, 0.7])
    assert [f.per_radius for f in fields] == pytest.approx([2.0, 2.0, 2.0, 1.5, 1.0, 1.0, 1.0, 1.0])


def test_elements_across_are_counted_in_each_zone(sheet):
    state = Stepper(replace(sheet, accuracy=Accuracy(across=6.0))).start()
    stage, phases = state.stage, [p.vector for p in state.phases]
    alike, own = contact_sizes(stage, phases), contact_sizes(stage, phases, across=6.0)
    assert own.seeds == pytest.approx(alike.seeds)
    (zone,) = stage.contacts["roller"].profile().zones()
    assert own.sizes == pytest.approx(min(zone.width / 6.0, stage.scene.accuracy.patch), rel=0.1)
    assert own.sizes.max() <= zone.width / 6.0


def test_a_contact_that_is_wide_in_another_stroke_only_has_elements_by_its_own_width(sheet):
    """Beside it, where a gap is wider than these, they are as small as other strokes ask for."""
    state = Stepper(replace(sheet, accuracy=Accuracy(across=6.0))).start()
    stage, phases = state.stage, [p.vector for p in state.phases]
    profile = stage.contacts["roller"].profile()
    (zone,) = profile.zones()
    assert profile.loads_and_widths() == [(pytest.approx(profile.load[zone.nodes].sum()), zone.width)]
    wide = 20 * zone.width / 6.0  # the patch of a stroke in which it is as many times as wide
    stage.scene = with_patch(stage.scene, wide)
    own = contact_sizes(stage, phases, across=6.0)
    inside = np.isclose(own.sizes, zone.width / 6.0, rtol=0.1)
    assert inside.any()
    assert own.sizes[~inside] == pytest.approx(NARROWEST * wide)


def test_a_tolerance_of_one_asks_for_nothing(started):
    state = started(stress_error=1.0)
    stage, phases = state.stage, [p.vector for p in state.phases]
    assert required_sizes(stage, phases).seeds == pytest.approx(contact_sizes(stage, phases).seeds)


def test_gaps_count_as_far_as_wear_may_still_close_them(started):
    """From a patch where nothing more wears, to two; and as far as all that wears where the mesh is to last."""
    state = started(stress_error=1.0)
    stage, phases = state.stage, [state.stage.problem.state.vec.FV().NumPy().copy()]
    (spec,) = stage.scene.followed
    profile, patch = stage.contacts[spec.name].profile(), stage.scene.accuracy.patch
    most = (profile.nominal_pressure * stage.contacts[spec.name].wear_factor(profile.pressure)).max()
    way = NEAR * patch / (spec.wear_rate.highest * most)  # that wears two patches

    corners = np.rint(profile.t).astype(int) == profile.t
    points, gaps = profile.reference[corners].round(9), profile.gap[corners]

    def widest(**how):
        asked = {tuple(seed) for seed in contact_sizes(stage, phases, **how).seeds.round(9)}
        return max(gap for point, gap in zip(points, gaps, strict=True) if tuple(point) in asked)

    for how, bound in (
        ({"left": 0.0}, LEAST * NEAR * patch),
        ({"left": 0.75 * way}, 0.75 * NEAR * patch),
        ({"left": way}, NEAR * patch),
        ({}, NEAR * patch),
        ({"sliding": way}, 2 * NEAR * patch),
    ):
        found = widest(**how)  # a node between two points of the outline asks for one of them
        assert gaps[gaps < bound].max() <= found <= gaps[gaps >= bound].min(), how
    assert widest(left=0.0) < widest(left=0.75 * way) < widest() < widest(sliding=way)
