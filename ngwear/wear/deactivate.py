"""Wear by deactivating elements: what a scene asks for, and the filter of distorted elements."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import require
from ngwear.geometry.cells import Cells
from ngwear.wear.damage import Criterion

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True)
class DistortionFilter:
    """Elements too distorted to carry load, found before each load.

    Parameters
    ----------
    corner_cosine : float
        Largest cosine of a corner's angle that an element may have [-]; inside out counts as 1.
    thinnest : float
        Least corner Jacobian over that of the element as it was made, below which it counts as inside out [-]: worn
        evenly, an element keeps right angles until nothing is left of it.
    """

    corner_cosine: float = 0.99
    thinnest: float = 0.05

    def __post_init__(self) -> None:
        place = "deactivation.distortion"
        require(0 < self.corner_cosine < 1, f"{place}.corner_cosine", self.corner_cosine, "must lie between 0 and 1")
        require(0 < self.thinnest < 0.5, f"{place}.thinnest", self.thinnest, "must lie between 0 and 0.5")

    def finds(self, cells: Cells) -> Mask:
        """Living elements that are too distorted, shape (m,)."""
        flat = cells.least_jacobians() < self.thinnest * cells.made
        return cells.living & (flat | (cells.corner_cosines() > self.corner_cosine))

    def pass_on(self, cells: Cells, distorted: Mask, moved: dict[int, Array]) -> tuple[Cells, dict[int, Array]]:
        """Let nodes of distorted elements that the worn surface has reached take its place.

        ``moved`` is how each point of the surface has gone; what comes back, how those beneath have. Without this a
        surface worn beyond an element would fall back to the element's far side.
        """
        sides, owner = cells.sides(distorted)
        points, surface = cells.points.copy(), set(cells.rim.tolist())
        ahead: dict[int, tuple[float, int]] = {}
        for (a, b), element in zip(sides.tolist(), owner.tolist(), strict=True):
            near = self.thinnest * float(np.sqrt(cells.made[element]))
            for top, below in ((a, b), (b, a)):
                way = moved.get(top)
                if way is None or below in surface or below in moved:
                    continue
                beyond = float((cells.points[top] - cells.points[below]) @ way) / float(np.linalg.norm(way))
                if beyond > -near and beyond > ahead.get(below, (-np.inf, -1))[0]:
                    ahead[below] = (beyond, top)
        went = {}
        for below, (_, top) in ahead.items():
            went[below] = cells.points[top] - cells.points[below]
            points[below] = cells.points[top]
        return replace(cells, points=points), went


@dataclass(frozen=True, kw_only=True)
class Deactivation:
    """A section that loses elements: layers of quadrilaterals below the edges that wear.

    Surface nodes move with the wear, those inside stay. What is left out does not happen.

    Parameters
    ----------
    depth : float
        Thickness of the layers [mm]; their elements have sides of ``Accuracy.patch``.
    distortion : DistortionFilter or None
    damage : Criterion or None
        Only the layers are torn.
    """

    depth: float
    distortion: DistortionFilter | None = None
    damage: Criterion | None = None

    def __post_init__(self) -> None:
        require(self.depth > 0, "deactivation.depth", self.depth, "must be greater than 0 mm")
