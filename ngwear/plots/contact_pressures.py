"""Panels of the pressure along each contact, new and worn."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ngwear.plots.style import COLOURS
from ngwear.results.section import Section, SectionContact
from ngwear.surfaces import Plane, RigidSurface

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Labelled = Mapping[str, Section]

LEVEL = 1e-9  # of a normal's component: below, a plane lies along an axis
ROOM = 0.08  # of the length in contact, to either side of it


def pressed(sections: Sequence[Section], surfaces: Iterable[str]) -> list[str]:
    """Contacts that carry pressure in any of some states; those of the surfaces that are known come first."""
    known = {name for section in sections for name in section.contacts}
    names = [*(name for name in surfaces if name in known), *sorted(known - set(surfaces))]
    return [n for n in names if any(s.contacts[n].pressure.max(initial=0.0) > 0 for s in sections)]


def coordinate(name: str, surface: RigidSurface | None, contact: SectionContact) -> tuple[Array, str]:
    """Coordinate of a contact's nodes along it [mm], and its name: x or y on a plane along it, else along the surface.

    A surface that is not known takes the coordinate in which the contact is longer.
    """
    x, y = contact.place.T
    if isinstance(surface, Plane) or surface is None:
        nx, ny = surface.normal_vector if isinstance(surface, Plane) else (float(np.ptp(x) < np.ptp(y)), 0.0)
        if abs(ny) < LEVEL or abs(nx) < LEVEL or surface is None:
            upright = abs(nx) > LEVEL
            return (y, "y [mm]") if upright else (x, "x [mm]")
    return np.asarray(surface.along(x - contact.moved[0], y - contact.moved[1])), f"along {name} [mm]"


def draw_pressure(axes: Axes, name: str, surface: RigidSurface | None, states: Labelled) -> None:
    """Draw the pressure along one contact in some states, by their labels, where it is in contact."""
    low, high, top = [], [], 0.0
    lines = [(2.2, 0.55)] * (len(states) - 1) + [(1.2, 1.0)]  # so that both lines are visible where they agree
    for (label, section), colour, (width, alpha) in zip(states.items(), COLOURS, lines, strict=False):
        contact = section.contacts[name]
        along, title = coordinate(name, surface, contact)
        on = contact.pressure > 0
        if on.any():
            low.append(along[on].min())
            high.append(along[on].max())
        top = max(top, float(contact.pressure.max(initial=0.0)))
        x, p = _line(along, contact)
        axes.plot(x, p, color=colour, label=label, lw=width, alpha=alpha, solid_joinstyle="round")
    room = ROOM * max(max(high) - min(low), 1e-6)
    axes.set_xlim(min(low) - room, max(high) + room)
    axes.set_ylim(0, 1.1 * top)
    axes.set_xlabel(title, labelpad=1)
    axes.set_title(name, loc="left", fontsize="medium", pad=3)


def _line(along: Array, contact: SectionContact) -> tuple[Array, Array]:
    """The line through the nodes, broken where no mesh edge joins two, and without stretches of no pressure."""
    n = len(contact.pressure)
    joined = np.zeros(n, dtype=bool)  # node i to the next one, around
    first, second = contact.edges.T
    joined[first[second == (first + 1) % n]] = True
    joined[second[first == (second + 1) % n]] = True
    return _line_through(along, contact.pressure, joined)


def line_over_x(place: Array, pressure: Array) -> tuple[Array, Array]:
    """Pressure over x of a contact's nodes in the order of the outline, with gaps (nan) where there is none.

    ``place``, shape (k, 2). The last node is joined to the first one if they lie as close as others.
    """
    if len(place) == 0:
        return place[:, 0], pressure
    apart = np.linalg.norm(np.roll(place, -1, axis=0) - place, axis=1)
    joined = np.ones(len(place), dtype=bool)
    joined[-1] = apart[-1] <= apart[:-1].max(initial=0.0)
    return _line_through(place[:, 0], pressure, joined)


def _line_through(along: Array, pressure: Array, joined: NDArray[np.bool_]) -> tuple[Array, Array]:
    """The line through nodes, of which some are joined to the next one, around; gaps where no two carry pressure."""
    n = len(pressure)
    joined = joined & ((pressure > 0) | (np.roll(pressure, -1) > 0))
    begin = int(np.flatnonzero(~joined)[-1] + 1) % n if not joined.all() else 0
    order = (begin + np.arange(n)) % n
    shown = (joined | np.roll(joined, 1))[order]
    breaks = np.flatnonzero(~joined[order[:-1]]) + 1
    x, y = np.where(shown, along[order], np.nan), np.where(shown, pressure[order], np.nan)
    return np.insert(x, breaks, np.nan), np.insert(y, breaks, np.nan)
