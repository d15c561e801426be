"""The grid along a track: places, interpolation, turning tensors."""

import math

import numpy as np
import pytest

from ngwear.fields.streamlines import StreamGrid

COLUMNS = np.linspace(-6.0, 5.0, 23)
OFFSETS, HEIGHTS = np.linspace(-2.0, 3.0, 6), np.array([0.0, 0.5, 2.0])
TRACKS = [math.inf, 16.5]


def grid(track):
    return StreamGrid(COLUMNS, (OFFSETS, HEIGHTS), track)


@pytest.mark.parametrize("track", TRACKS)
def test_places_are_found_again(track):
    tracked = grid(track).tracked(grid(track).places).reshape(6, 3, 23, 3)
    np.testing.assert_allclose(tracked[2, 1, :, 0], COLUMNS, atol=1e-12)
    np.testing.assert_allclose(tracked[:, 1, 4, 1], OFFSETS, atol=1e-12)
    np.testing.assert_allclose(tracked[0, :, 4, 2], HEIGHTS, atol=1e-12)


def test_circular_track_keeps_to_its_circle_and_starts_along_x():
    on_track = StreamGrid(COLUMNS, (np.array([0.0, 1.0]), HEIGHTS), 16.5).places[:23]
    np.testing.assert_allclose(np.hypot(on_track[:, 0], on_track[:, 1] - 16.5), 16.5)
    assert on_track[12, 0] == pytest.approx(16.5 * math.sin(COLUMNS[12] / 16.5))


@pytest.mark.parametrize("track", TRACKS)
def test_interpolation_is_exact_for_linear_fields(track):
    g, rng = grid(track), np.random.default_rng(3)
    inside = np.column_stack([rng.uniform(-5, 4, 50), rng.uniform(-1.9, 2.9, 50), rng.uniform(0, 2, 50)])
    angle = inside[:, 0] / track
    places = inside.copy()
    if math.isfinite(track):
        places[:, 0] = (track - inside[:, 1]) * np.sin(angle)
        places[:, 1] = track - (track - inside[:, 1]) * np.cos(angle)
    middle = 0.5 * (COLUMNS[1:] + COLUMNS[:-1])
    offset, height, along = np.meshgrid(OFFSETS, HEIGHTS, middle, indexing="ij")
    values = 2 * along - offset + 3 * height
    expected = 2 * inside[:, 0] - inside[:, 1] + 3 * inside[:, 2]
    np.testing.assert_allclose(g.between(places) @ values.ravel(), expected, atol=1e-12)


def test_section_is_interpolated_too():
    g = StreamGrid(COLUMNS, (HEIGHTS,))
    middle = 0.5 * (COLUMNS[1:] + COLUMNS[:-1])
    values = middle[None] + 10 * HEIGHTS[:, None]
    assert (g.between(np.array([[0.3, 1.1]])) @ values.ravel())[0] == pytest.approx(0.3 + 11.0)


def test_areas_add_up_to_the_volume_swept():
    assert grid(math.inf).areas.sum() == pytest.approx(5.0 * 2.0)
    # Towards the centre the circles are shorter: mean offset 0.5 of 16.5.
    assert grid(16.5).areas.sum() == pytest.approx(10.0 * (1 - 0.5 / 16.5))


def test_tensors_turn_with_the_track_and_back():
    g, rng = grid(16.5), np.random.default_rng(4)
    tensors = rng.normal(size=(len(g.places), 6))
    there = g.turned(tensors, g.places)
    np.testing.assert_allclose(g.turned(there, g.places, back=True), tensors, atol=1e-12)
    # A tension along the track is one along x in its axes.
    angle = np.arctan2(g.places[:, 0], 16.5 - g.places[:, 1])
    c, s, zero = np.cos(angle), np.sin(angle), np.zeros(len(angle))
    along = np.stack([c * c, s * s, zero, c * s, zero, zero], axis=-1)
    np.testing.assert_allclose(g.turned(along, g.places), np.tile([1.0, 0, 0, 0, 0, 0], (len(angle), 1)), atol=1e-12)
