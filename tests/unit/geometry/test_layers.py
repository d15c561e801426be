from pathlib import Path

import numpy as np
import pytest

from ngwear.errors import GeometryError
from ngwear.geometry.element_body import ElementBody
from ngwear.geometry.layers import layered
from ngwear.geometry.outline import Outline

OPTIONS = {"depth": 0.3, "edge": 0.1, "coarse": 0.5, "grading": 0.3}


def lengths(contour):
    return {name: contour.lengths[contour.on((name,))].sum() for name in contour.edge_names}


def hill(height=0.2):
    """A sheet whose top, in two pieces, bulges."""
    x = np.linspace(3, 0, 31)
    top = np.stack([x, 2 + height * np.sin(np.pi * x / 3)], axis=1)
    points = np.vstack([[(0, 0), (3, 0)], top])
    corners = np.zeros(len(points), dtype=bool)
    corners[[0, 1, 2, -1]] = True
    return Outline(points, ("bottom", "right", *["east"] * 15, *["west"] * 15, "left"), corners)


@pytest.mark.parametrize("rows", [1, 3, 6])
def test_layers_have_as_many_rows_and_the_section_its_area_and_edges(rectangle, rows):
    contour = rectangle(4.0, 2.0)
    cells = layered(contour, ("top",), **OPTIONS | {"depth": 0.1 * rows})
    assert cells.quads.sum() == 40 * rows
    np.testing.assert_allclose(cells.areas()[cells.quads], 0.01, rtol=1e-12)
    assert (cells.least_jacobians() > 0).all()
    assert cells.area == pytest.approx(8.0, rel=1e-12)
    assert lengths(cells.contour) == pytest.approx(lengths(contour))
    assert ElementBody(cells).mesh.ne == len(cells.corners)


def test_columns_run_from_the_surface_to_the_bottom_of_the_layers(rectangle):
    cells = layered(rectangle(4.0, 2.0), ("top",), **OPTIONS)
    for start in np.flatnonzero(cells.points[:, 1] == 2.0):
        chain = [start]
        while cells.below[chain[-1]] >= 0:
            chain.append(cells.below[chain[-1]])
        np.testing.assert_allclose(cells.points[chain, 1], [2.0, 1.9, 1.8, 1.7], atol=1e-12)
        np.testing.assert_allclose(cells.points[chain, 0], cells.points[start, 0], atol=1e-12)
    assert (cells.below >= 0).sum() == 3 * 41


def test_a_curved_surface_of_two_edges_is_followed():
    cells = layered(hill(), ("east", "west"), **OPTIONS)
    contour = cells.contour
    assert set(contour.edge_names) == set(hill().edge_names)
    assert cells.area == pytest.approx(contour.area, rel=1e-12)
    assert cells.area == pytest.approx(hill().area, rel=1e-3)
    assert lengths(contour)["left"] == pytest.approx(2.0)
    x, y = contour.points[contour.on(("east", "west"))].T
    np.testing.assert_allclose(y, 2 + 0.2 * np.sin(np.pi * x / 3), atol=1e-4)


def test_layers_beside_the_worn_edges_inside_the_section_are_no_outline(rectangle):
    """The worn edge is a part of a side: the layers' flanks lie inside, triangles beside them."""
    x = [4.0, 3.0, 1.0, 0.0]
    points = np.array([(0, 0), (4, 0), *[(a, 2) for a in x]], dtype=float)
    contour = Outline(points, ("bottom", "right", "free", "worn", "free", "left"), np.ones(6, dtype=bool))
    cells = layered(contour, ("worn",), **OPTIONS)
    assert cells.quads.sum() == 20 * 3
    assert cells.area == pytest.approx(8.0, rel=1e-12)
    assert lengths(cells.contour) == pytest.approx(lengths(contour))


def test_an_edge_that_overhangs_is_refused_with_the_place():
    points = np.array([(0, 0), (4, 0), (4, 2), (2.0, 2), (2.5, 1.5), (1.5, 1.5), (0, 2)], dtype=float)
    names = ("bottom", "right", "top", "top", "top", "top", "left")
    with pytest.raises(GeometryError, match=r"\['top'\] overhang at \[2\.\d*, \d"):
        layered(Outline(points, names, np.ones(7, dtype=bool)), ("top",), **OPTIONS)


def test_layers_thicker_than_the_side_is_long_are_refused(rectangle):
    with pytest.raises(GeometryError, match=r"0\.6 mm thick, more than the edge '(left|right)' beside them is long"):
        layered(rectangle(4.0, 0.5), ("top",), **OPTIONS | {"depth": 0.6})


@pytest.mark.parametrize("edges", [("top", "bottom"), ("bottom", "right", "top", "left")])
def test_edges_not_in_one_piece_are_refused(rectangle, edges):
    with pytest.raises(GeometryError, match="must be one connected piece of the outline, and not all of it"):
        layered(rectangle(4.0, 2.0), edges, **OPTIONS)


def test_layers_that_leave_the_section_between_its_sides_are_refused():
    """The shipped seal's worn face ends within its lower side: nothing beside the layers would stop them."""
    contour = Outline.read(Path(__file__).parents[3] / "geometries" / "torn_seal" / "contour.toml")
    edges = ("heel", "left ridges", "lip", "right ridges", "sealed face")
    with pytest.raises(GeometryError, match=r"layers of 3\.9 mm leave the section at .*: take fewer"):
        layered(contour, edges, depth=3.9, edge=0.1, coarse=0.3, grading=0.35)
