"""Pictures of a pin on a plate."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ngwear.sliding.pin import PinSlide
from ngwear.sliding.scene import Pin

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WHOLE, SURFACE, INTERNAL, HEAT = "#222222", "#1b6ca8", "#d1495b", "#e8871e"


def draw_friction(slides: Sequence[PinSlide]) -> Figure:
    """Friction coefficient against speed and its parts, by force and by energy."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 4.5), layout="constrained")
    axis = figure.subplots()
    ordered = sorted(slides, key=lambda s: s.speed)
    speed = [s.speed for s in ordered]
    axis.semilogx(speed, [s.friction for s in ordered], "o-", color=WHOLE, label="whole")
    axis.semilogx(speed, [s.surface_friction for s in ordered], "s-", color=SURFACE, label="from surface friction")
    axis.semilogx(speed, [s.internal_friction for s in ordered], "s-", color=INTERNAL, label="from the pressure")
    axis.semilogx(speed, [s.slip_work for s in ordered], "--", color=SURFACE, label="heat of the slip")
    axis.semilogx(speed, [s.dissipation for s in ordered], "--", color=INTERNAL, label="heat in the rubber")
    axis.set_ylim(bottom=0)
    axis.set_xlabel("sliding speed [mm/s]")
    axis.set_ylabel("friction coefficient [-]")
    axis.grid(alpha=0.3, which="both")
    axis.legend(ncols=2)
    return figure


def draw_contact(slides: Sequence[PinSlide]) -> Figure:
    """Penetration and contact area against speed."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 4.5), layout="constrained")
    left = figure.subplots()
    right = left.twinx()
    ordered = sorted(slides, key=lambda s: s.speed)
    speed = [s.speed for s in ordered]
    (depth,) = left.semilogx(speed, [s.depth for s in ordered], "o-", color=SURFACE)
    (area,) = right.semilogx(speed, [s.patch.area for s in ordered], "s-", color=INTERNAL)
    left.set_xlabel("sliding speed [mm/s]")
    left.set_ylabel("penetration [mm]", color=SURFACE)
    right.set_ylabel("contact area [mm²]", color=INTERNAL)
    left.set_ylim(0, 1.25 * depth.get_ydata().max())
    right.set_ylim(0, 1.25 * area.get_ydata().max())
    left.grid(alpha=0.3, which="both")
    left.legend([depth, area], ["penetration", "contact area"], loc="lower left")
    return figure


def draw_sheet(pin: Pin, slide: PinSlide) -> Figure:
    """The deformed sheet with its pressure: from the side in perspective, and the contact from above."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13, 5.2), layout="constrained")
    grid = figure.add_gridspec(1, 2, width_ratios=(1.3, 1))
    space = figure.add_subplot(grid[0], projection="3d")
    above = figure.add_subplot(grid[1])
    colours = ScalarMappable(Normalize(0.0, slide.peak), "viridis")
    _draw_surface(space, pin, slide, colours)
    _draw_patch(above, slide, colours)
    figure.colorbar(colours, ax=above, label="contact pressure [MPa]")
    figure.suptitle(f"{slide.speed:g} mm/s, the pin moves towards +x; penetration {slide.depth:.3f} mm")
    return figure


def _loaded(slide: PinSlide) -> np.ndarray:
    """Faces that carry more than a rounding of the peak."""
    return slide.faces.pressure > 0.01 * slide.peak


def _draw_surface(axis: Axes, pin: Pin, slide: PinSlide, colours: object) -> None:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    corners = slide.faces.corners
    reach = np.ptp(slide.patch.edge[:, 0])
    shown = np.abs(corners[..., :2]).max(axis=(1, 2)) < 1.2 * reach
    faces = Poly3DCollection(corners[shown], edgecolors="0.3", linewidths=0.15)
    colour = colours.to_rgba(slide.faces.pressure[shown])
    colour[~_loaded(slide)[shown]] = (0.88, 0.88, 0.88, 1.0)
    faces.set_facecolor(colour)
    axis.add_collection3d(faces)
    axis.set_xlim(-reach, reach)
    axis.set_ylim(-reach, reach)
    axis.set_zlim(0, 1.1 * pin.thickness)
    axis.set_box_aspect((2 * reach, 2 * reach, 1.1 * pin.thickness), zoom=1.25)
    axis.view_init(elev=32, azim=-62)
    axis.set_xlabel("x [mm]")
    axis.set_ylabel("y [mm]")
    axis.set_zlabel("z [mm]")


def _draw_patch(axis: Axes, slide: PinSlide, colours: object) -> None:
    from matplotlib.collections import PolyCollection

    loaded = _loaded(slide)
    patch = PolyCollection(slide.faces.corners[loaded][..., :2], edgecolors="face", linewidths=0.2)
    patch.set_facecolor(colours.to_rgba(slide.faces.pressure[loaded]))
    axis.add_collection(patch)
    edge = np.vstack([slide.patch.edge, slide.patch.edge[:1]])
    axis.plot(*edge.T, color="#d1495b", lw=1.5, label="contact's edge")
    axis.plot(0, 0, "w+")
    axis.set_aspect("equal")
    axis.set_xlabel("along the track, x [mm]")
    axis.set_ylabel("towards the track's centre, y [mm]")
    axis.legend(loc="upper right")
