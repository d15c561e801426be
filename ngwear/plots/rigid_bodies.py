"""Rigid surfaces in a figure of a section: their places, worn depths and names."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.plots.counter import ALONG, DEPTH
from ngwear.plots.sections import Box
from ngwear.results.section import SectionContact
from ngwear.surfaces import Corner, Cylinder, Plane, RigidSurface

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Profile = Mapping[str, Array]

BODY, BORDER = "0.86", "0.35"
AROUND = 720  # points around a disc


def body(surface: RigidSurface, contact: SectionContact, profile: Profile, window: Box) -> Any:
    """Visible part of a rigid body as a Shapely geometry; empty for surfaces that cannot be drawn."""
    from shapely import Polygon, box

    def depth(along: Array) -> Array:
        """Worn depth of the surface at places along it in the scene's frame [mm]."""
        if DEPTH not in profile:
            return np.zeros_like(along)
        along, length = along + contact.turned, surface.length
        if math.isfinite(length):
            along = (along + length / 2) % length - length / 2
        return np.interp(along, profile[ALONG], profile[DEPTH], left=0.0, right=0.0)

    (left, low), (right, high) = window
    if isinstance(surface, Plane):
        foot, normal = np.array(surface.point) + contact.moved, np.array(surface.normal_vector)
        reach = 2 * float(np.linalg.norm(np.abs(np.array(window) - foot).max(axis=0)))
        worn = profile[ALONG] - contact.turned if ALONG in profile else np.empty(0)
        s = np.concatenate([[-reach], np.sort(worn[np.abs(worn) < reach]), [reach]])
        along = np.array([-normal[1], normal[0]])
        front = foot + s[:, None] * along - depth(s)[:, None] * normal
        back = foot + np.array([[reach], [-reach]]) * along - reach * normal
        shape = Polygon(np.vstack([front, back]))
    elif isinstance(surface, Corner):
        foot, r = np.array(surface.point) + contact.moved, surface.radius
        n, s = np.array(surface.normal_vector), np.array(surface.side)
        angle = np.linspace(0.0, np.pi / 2, AROUND // 4)[:, None]
        edge = foot - r * (n + s) + r * (np.cos(angle) * n + np.sin(angle) * s)
        far = 2 * float(np.linalg.norm(np.abs(np.array(window) - foot).max(axis=0))) + r
        shape = Polygon(np.vstack([foot - far * s, edge, foot - far * n, foot - far * (n + s)]))
    elif isinstance(surface, Cylinder):
        angle = np.linspace(-np.pi, np.pi, AROUND, endpoint=False)
        px, py = surface.push
        ray = np.stack([px * np.cos(angle) - py * np.sin(angle), py * np.cos(angle) + px * np.sin(angle)], axis=1)
        centre = np.array(surface.centre) + contact.moved
        shape = Polygon(centre + (surface.radius - depth(surface.radius * angle))[:, None] * ray)
    else:
        return Polygon()
    return shape.intersection(box(left, low, right, high))


def draw_bodies(axes: Axes, bodies: Mapping[str, Any], window: Box) -> None:
    """Fill the bodies and draw their borders, but for those inside another body and those of the view."""
    from shapely import box, union_all

    (left, low), (right, high) = window
    inside = box(left, low, right, high).buffer(-1e-6 * (right - left))
    for name, shape in bodies.items():
        for polygon in _polygons(shape):
            axes.fill(*np.array(polygon.exterior.coords).T, facecolor=BODY, edgecolor="none", zorder=1)
        others = union_all([other for key, other in bodies.items() if key != name])
        border = shape.boundary.intersection(inside).difference(others)
        for line in getattr(border, "geoms", [border]):
            if line.length > 0:
                axes.plot(*np.array(line.coords).T, color=BORDER, lw=0.9, zorder=2, solid_capstyle="butt")


def _polygons(shape: Any) -> list[Any]:
    return [part for part in getattr(shape, "geoms", [shape]) if part.geom_type == "Polygon" and not part.is_empty]


def write_in(axes: Axes, text: str, free: Any, *, inch: float, fontsize: float, colour: str = "k") -> Any:
    """Write a name where there is most room for it in a free region, level if it fits; return the space that it takes.

    Parameters
    ----------
    axes : Axes
    text : str
    free : Shapely geometry
        Where the name may stand.
    inch : float
        Length of an inch of the picture in the section [mm].
    fontsize : float
        [points].
    colour : str

    Returns
    -------
    Shapely geometry
        Empty if there was no room at all.
    """
    from shapely import Polygon, box, contains, distance, points, prepare

    if free.is_empty:
        return Polygon()
    wide, high = (0.6 * len(text) + 0.6) * fontsize / 72 * inch, 1.3 * fontsize / 72 * inch
    left, low, right, top = free.bounds
    x, y = (part.ravel() for part in np.meshgrid(np.linspace(left, right, 61), np.linspace(low, top, 61)))
    centre = free.centroid
    off = np.hypot(x - centre.x, y - centre.y) / np.hypot(right - left, top - low)
    prepare(free)
    for w, h, turn in ((wide, high, 0), (high, wide, 90)):
        around = box(x - w / 2, y - h / 2, x + w / 2, y + h / 2)
        fits = np.flatnonzero(contains(free, around))
        if len(fits) == 0:
            continue
        room = np.minimum(distance(free.boundary, points(x[fits], y[fits])), high)
        best = fits[int(np.argmax(room / high - off[fits]))]
        axes.text(
            x[best], y[best], text, rotation=turn, ha="center", va="center", fontsize=fontsize, color=colour, zorder=6
        )
        return around[best]
    return Polygon()
