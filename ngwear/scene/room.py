"""Whether the surfaces of a scene leave room for the part, and whether its fluids can be where the scene puts them."""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import SceneError, require
from ngwear.scene.holding import free_directions
from ngwear.surfaces import Plane

if TYPE_CHECKING:
    from shapely import Polygon

Array = NDArray[np.float64]

OPPOSITE = -0.999  # cosine of the angle between the normals of two surfaces that face each other
FAR = 100.0  # sizes of the section: what reaches so far is open
HARDEST = 30.0  # times G: pressure of a part that fills more than its room; three times the highest p/G that is of use


def refuse_without_room(scene: Any) -> None:
    """SceneError if surfaces leave no room, or less than the part fills; ``Scene`` calls this.

    Only planes, rods and bores that the scene places count. A part that fills more than its room is compressed: its
    pressure is ``K (V / V_room - 1)``.
    """
    fixed = [c for c in scene.contacts if type(c.surface) is Plane and c.force is None]
    for one, other in combinations(fixed, 2):
        n, m = np.array(one.surface.normal_vector), np.array(other.surface.normal_vector)
        if n @ m > OPPOSITE * np.linalg.norm(n) * np.linalg.norm(m):
            continue
        apart = float(n @ (np.array(other.surface.point) - np.array(one.surface.point)) / np.linalg.norm(n))
        remedy = (
            f"leaves no room: it lies {-apart:.4g} mm beyond the surface of contact '{one.name}'; check diameters, "
            "points and normals of both"
        )
        require(apart > 0, f"contact '{other.name}'.surface", other.surface, remedy)
    room, part = _room(scene, fixed), _volume(scene, np.asarray(scene.part.outline.points))
    if room is None:
        return
    over, rubber = part / room - 1, scene.part.material
    unit = "mm³" if scene.axisymmetric else "mm²"
    require(
        over * rubber.bulk_modulus <= HARDEST * rubber.shear_modulus,
        "contact.surface",
        [contact.name for contact in fixed],
        f"these surfaces enclose {room:.4g} {unit}, and the part fills {part:.4g} {unit}: rubber hardly changes its "
        f"volume, and would press with about {over * rubber.bulk_modulus:.3g} MPa; make the groove wider or deeper, or "
        "the part smaller",
    )


def refuse_fluids(scene: Any) -> None:
    """SceneError if no fluid reaches an inlet, or two inlets with unlike pressures touch; ``Scene`` calls this.

    So is an inlet in several pieces of a part with room to move: a fluid goes on from one piece only.
    """
    contour, floats = scene.part.outline, bool(free_directions(scene))
    for name, edges in scene.fluid.inlets.items():
        mine = contour.on(tuple(edges))
        pieces = int(np.count_nonzero(mine & ~np.roll(mine, 1)))
        remedy = (
            f"lies in {pieces} pieces, and a fluid goes on from one: name the edges between them, too, or give each "
            'piece an inlet of its own, as in inlet = { "left" = ["..."], "right" = ["..."] }'
        )
        require(pieces <= 1 or not floats, _place(name), list(edges), remedy)
        x, y = contour.points[mine | np.roll(mine, 1)].T
        for contact in scene.contacts:
            remedy = (
                f"lies inside the surface of contact '{contact.name}' all along: no fluid reaches it; name edges that "
                "stay free"
            )
            free = contact.force is not None or bool((contact.surface.gap(x, y) > 0).any())
            require(free, _place(name), list(edges), remedy)
    owner = {edge: name for name, edges in scene.fluid.inlets.items() for edge in edges}
    names = list(contour.names)
    for here, there in zip(names, names[1:] + names[:1], strict=True):
        one, other = owner.get(here), owner.get(there)
        if one is None or other is None or one == other:
            continue
        for stroke in scene.program.cycle:
            if stroke.pressure_at(one) != stroke.pressure_at(other):
                raise SceneError(
                    _place(one),
                    list(scene.fluid.inlets[one]),
                    f"meets inlet '{other}' between the edges '{here}' and '{there}', but stroke '{stroke.name}' gives "
                    f"them {stroke.pressure_at(one):g} and {stroke.pressure_at(other):g} MPa: leave an edge between "
                    "them that a surface touches",
                )


def _place(inlet: str) -> str:
    return "fluid.inlet" if inlet == "fluid" else f"fluid.inlet.{inlet}"


def _room(scene: Any, fixed: list[Any]) -> float | None:
    """Volume between the surfaces [mm³], or its section in plane strain [mm²]; None if they do not enclose it."""
    from shapely import box

    points = np.asarray(scene.part.outline.points)
    low, high = points.min(axis=0), points.max(axis=0)
    far = FAR * float((high - low).max())
    space: Polygon = box(low[0] - far, max(low[1] - far, 0.0) if scene.axisymmetric else low[1] - far, *(high + far))
    bounds = space.bounds
    for contact in fixed:
        space = space.intersection(_half_plane(contact.surface, 4 * far))
    if space.is_empty or any(math.isclose(a, b) for a, b in zip(space.bounds, bounds, strict=True) if b != 0.0):
        return None
    return _volume(scene, np.array(space.exterior.coords)[:-1])


def _half_plane(plane: Plane, far: float) -> Polygon:
    from shapely import Polygon

    n = np.array(plane.normal_vector) / np.linalg.norm(plane.normal_vector)
    along, p = np.array([n[1], -n[0]]), np.array(plane.point)
    return Polygon([p + far * along, p - far * along, p - far * along + far * n, p + far * along + far * n])


def _volume(scene: Any, points: Array) -> float:
    """Volume of the ring with this section [mm³], or area of the section in plane strain [mm²]."""
    from shapely import Polygon

    section = Polygon(points)
    return float(section.area * (2 * math.pi * section.centroid.y if scene.axisymmetric else 1.0))
