"""A body from its arrays is the body, to the last bit: points, numbers, curves, and where it has been moved to."""

from dataclasses import replace

import ngsolve as ng
import numpy as np
import pytest

from ngwear.errors import MeshError
from ngwear.geometry.body import Body
from ngwear.geometry.outline import Outline
from ngwear.geometry.saved_mesh import as_arrays, from_arrays
from ngwear.geometry.sizing import SizeField


def wavy(seed):
    """A star-shaped outline with random waves, a corner, and two names."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(30, 80))
    angle = 2 * np.pi * np.arange(n) / n
    radius = 1 + sum(rng.uniform(-0.08, 0.08) * np.cos(k * angle + rng.uniform(0, 6)) for k in range(2, 5))
    points = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1) + (0.0, 3.0)
    corners = np.zeros(n, dtype=bool)
    corners[[0, n // 2]] = True
    return Outline(points, ("lip",) * (n // 2) + ("back",) * (n - n // 2), corners)


def fine_at_the_lip(outline, coarse=0.3):
    return SizeField(outline.points[3:6], np.array([0.06, 0.04, 0.06]), coarse)


def told(body):
    """Where the elements lie and how they are curved, and the numbers of all things."""
    mesh = body.mesh
    inside = mesh.MapToAllElements(ng.IntegrationRule(ng.TRIG, 5), ng.VOL)
    along = mesh.MapToAllElements(ng.IntegrationRule(ng.SEGM, 5), ng.BND)
    places = [np.asarray(f(inside)) for f in (ng.x, ng.y, ng.specialcf.JacobianMatrix(2))]
    edges = [[v.nr for v in edge.vertices] for edge in mesh.edges]
    ends = [(el.mat, [v.nr for v in el.vertices], [e.nr for e in el.edges]) for el in mesh.Elements(ng.BND)]
    numbers = [[v.nr for v in el.vertices] + [e.nr for e in el.edges] for el in mesh.Elements(ng.VOL)]
    line = [getattr(body.outline, name).tolist() for name in ("element", "vertices", "edge", "t", "names")]
    return [
        *(array.tobytes() for array in (*places, np.asarray(ng.specialcf.normal(2)(along)))),
        *(edges, ends, numbers, line, mesh.GetBoundaries(), mesh.GetMaterials()),
    ]


@pytest.mark.parametrize("seed", range(8))
def test_a_body_comes_back_to_the_last_bit(seed):
    outline = wavy(seed)
    body = Body(outline, fine_at_the_lip(outline), on_chord=bool(seed % 2))
    back = Body.from_data(body.to_data())
    assert told(back) == told(body)
    for one in (body, back):  # goes on as it did
        points = one.base.points + 1e-3 * np.sin(7 * one.base.points) * np.sin(1.0 + seed)
        one.move_to(replace(one.base, points=points))
    assert told(back) == told(body)
    assert told(Body.from_data(body.to_data())) == told(body)


@pytest.mark.parametrize(
    "damage",
    [
        lambda a: a | {"triangles": a["triangles"] + 1},
        lambda a: a | {"triangles": a["triangles"] - 1},
        lambda a: a | {"triangles": a["triangles"].astype(float)},
        lambda a: a | {"triangles": a["triangles"][:, :2]},
        lambda a: a | {"segments": a["segments"] + 10**6},
        lambda a: a | {"pieces": a["pieces"][1:]},
        lambda a: a | {"pieces": a["pieces"] + 1},
        lambda a: a | {"points": a["points"] * np.nan},
        lambda a: a | {"points": a["points"].ravel()},
        lambda a: a | {"segments": a["segments"][:0], "pieces": a["pieces"][:0]},
    ],
)
def test_arrays_that_fit_no_mesh_are_refused_before_the_mesher_sees_them(damage):
    outline = wavy(1)
    body = Body(outline, fine_at_the_lip(outline))
    arrays = as_arrays(body.mesh)
    with pytest.raises(MeshError, match="the arrays are not those of a mesh"):
        from_arrays(body.base, body.nodes, damage(arrays))
    with pytest.raises(MeshError, match="the arrays are not those of a mesh"):
        from_arrays(body.base, body.nodes + 10**6, arrays)
