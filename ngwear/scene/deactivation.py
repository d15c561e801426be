"""Settings for wear by deactivated elements, and the filter of distorted elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import check_fields, require
from ngwear.geometry.cells import Cells
from ngwear.laws.damage import Criterion

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True)
class DistortionFilter:
    """Deactivates elements that are too distorted to carry load, before each load step.

    Parameters
    ----------
    corner_cosine : float
        Largest allowed cosine of a corner angle [-]; an inverted element counts as 1.
    """

    corner_cosine: float = 0.99  # a corner of 8 degrees

    def __post_init__(self) -> None:
        check_fields(self, "deactivation.distortion")
        place = "deactivation.distortion"
        require(0 < self.corner_cosine < 1, f"{place}.corner_cosine", self.corner_cosine, "must lie between 0 and 1")

    def finds(self, cells: Cells) -> Mask:
        """Mask of the active elements that are too distorted, shape (m,)."""
        return cells.living & (cells.corner_cosines() > self.corner_cosine)


@dataclass(frozen=True, kw_only=True)
class Deactivation:
    """Deactivate elements of the section: layers of quadrilaterals below the edges that wear.

    Surface nodes move with the wear along their columns. Nodes inside do not move; a surface node that reaches one is
    merged with it. A mechanism that is None is not simulated.

    Parameters
    ----------
    depth : float
        Thickness of the layers [mm]; the side of their elements is ``Accuracy.patch``.
    distortion : DistortionFilter or None
        Deactivates distorted elements.
    damage : Criterion or None
        Deactivates torn elements, in the layers only.
    reach : float or None
        Elements are torn only within this distance from a contact that wears and carries load [mm]. Default:
        everywhere in the layers, so that cracks can grow.
    """

    depth: float
    distortion: DistortionFilter | None = None
    damage: Criterion | None = None
    reach: float | None = None

    def __post_init__(self) -> None:
        check_fields(self, "deactivation")
        require(self.depth > 0, "deactivation.depth", self.depth, "must be greater than 0 mm")
        positive = self.reach is None or self.reach > 0
        require(positive, "deactivation.reach", self.reach, "must be greater than 0 mm, or be removed")
