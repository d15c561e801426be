"""Scenes whose surfaces leave no room for the part, or whose fluids cannot be where the scene puts them."""

from dataclasses import replace

import pytest

import ngwear as nw
from ngwear.loop.run import run
from ngwear.verify.leak_pressure import scene as block


@pytest.fixture(scope="module")
def ring():
    return nw.read_scene("geometries/o_ring/scene.toml")


def with_surfaces(scene, **surfaces):
    named = {name.replace("_", " "): surface for name, surface in surfaces.items()}
    return replace(scene, contacts=[replace(c, surface=named.get(c.name, c.surface)) for c in scene.contacts])


def wall(x, side):
    return nw.Plane(point=(x, 0.0), normal_vector=(side, 0.0))


@pytest.mark.parametrize(
    ("surfaces", "place", "says"),
    [
        ({"rod": nw.rod(diameter=20.0), "groove_bottom": nw.bore(diameter=20.0)}, "groove bottom", "wrong side"),
        ({"air_wall": wall(-0.1, 1.0), "sealed_wall": wall(-0.2, -1.0)}, "sealed wall", "wrong side"),
        ({"air_wall": wall(4.0, 1.0), "sealed_wall": wall(9.0, -1.0)}, "air wall", "wrong side"),
        ({"air_wall": wall(-1.2, 1.0), "sealed_wall": wall(1.2, -1.0)}, "contact.surface", "make the groove wider"),
    ],
)
def test_surfaces_without_room_are_refused(ring, surfaces, place, says):
    with pytest.raises(nw.SceneError, match=says) as refused:
        with_surfaces(ring, **surfaces)
    assert place in refused.value.place


def test_two_surfaces_that_pass_each_other_are_refused():
    """Below and above the middle of the section, so that each alone is on the right side."""
    squeezed = block()
    lower, upper = (
        replace(c, surface=replace(c.surface, point=(0.0, y)))
        for c, y in zip(squeezed.contacts, (0.49, 0.495), strict=True)
    )
    replace(squeezed, contacts=[lower, replace(upper, surface=replace(upper.surface, point=(0.0, 0.51)))])
    with pytest.raises(nw.SceneError, match=r"wrong side|leaves no room"):
        replace(squeezed, contacts=[lower, upper])


def test_a_part_that_fills_a_little_more_than_its_room_may_try(ring):
    """It fills 0.97 of a groove of 3.4 mm, and 1.03 of one of 3.2 mm: 2000 MPa times 0.03 is 26 times G."""
    for half in (1.7, 1.6):
        with_surfaces(ring, air_wall=wall(-half, 1.0), sealed_wall=wall(half, -1.0))


def test_an_inlet_inside_a_surface_is_refused():
    squeezed = block()
    with pytest.raises(nw.SceneError, match="inside the surface of contact 'bottom plate' all along") as refused:
        replace(squeezed, fluid=replace(squeezed.fluid, inlet=["bottom"]))
    assert refused.value.place == "fluid.inlet"


def test_an_inlet_in_two_pieces_is_refused_if_the_part_has_room_to_move(ring):
    """From the second piece the fluid did not go on, and pressed on the wall where the ring touched it."""
    with pytest.raises(nw.SceneError, match="lies in 2 pieces, and a fluid goes on from one") as refused:
        replace(ring, fluid=replace(ring.fluid, inlet=["sealed side", "air side"]))
    assert refused.value.place == "fluid.inlet"
    replace(ring, fluid=replace(ring.fluid, inlet=["sealed side", "groove side"]))
    cycle = [replace(stroke, pressure={"left": 5.0, "right": 5.0}) for stroke in ring.program.cycle]
    inlets = {"left": ["air side"], "right": ["sealed side"]}
    replace(ring, fluid=replace(ring.fluid, inlet=inlets), program=replace(ring.program, cycle=cycle))


def test_inlets_that_touch_need_the_same_pressure():
    squeezed = block()
    sides = nw.Fluid(edges=["right", "top", "left"], inlet={"one": ["right"], "other": ["top", "left"]})
    high = [
        replace(c, surface=replace(c.surface, point=(0.0, 2.0))) if c.name == "top plate" else c
        for c in squeezed.contacts
    ]
    free = replace(
        squeezed, contacts=high, fluid=None, program=nw.Program(strokes=1, cycle=[nw.Stroke("in", travel=1.0)])
    )

    def under(**pressure):
        cycle = [nw.Stroke("in", travel=1.0, pressure=pressure)]
        return replace(free, fluid=sides, program=nw.Program(strokes=1, cycle=cycle))

    under(one=2.0, other=2.0)
    with pytest.raises(nw.SceneError, match="'right' and 'top', but stroke 'in' gives them 2 and 1 MPa"):
        under(one=2.0, other=1.0)


def test_fluids_that_meet_are_told_of():
    """Around the free top of a block, between two inlets with unlike pressures."""
    squeezed = block()
    low = replace(squeezed.contacts[0], surface=replace(squeezed.contacts[0].surface, point=(0.0, 0.0)))
    fluid = nw.Fluid(edges=["right", "top", "left"], inlet={"one": ["right"], "other": ["left"]})
    cycle = [nw.Stroke("in", travel=1.0, pressure={"one": 0.2, "other": 0.1})]
    supports = [nw.Support(edges=["bottom"])]
    scene = replace(
        squeezed, contacts=[low], supports=supports, fluid=fluid, program=nw.Program(strokes=1, cycle=cycle)
    )
    summary = run(scene, figures=False).summary
    assert any("'one' meets the fluid of inlet 'other', which has less" in warning for warning in summary["warnings"])
    assert {"one"} <= {found["inlet"] for found in summary["blow-by"]}
