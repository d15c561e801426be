"""Wear by deactivating elements: what a scene asks for, and the filter of distorted elements."""

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
    """Elements too distorted to carry load, found before each load.

    Parameters
    ----------
    corner_cosine : float
        Largest cosine of a corner's angle that an element may have [-]; inside out counts as 1.
    """

    corner_cosine: float = 0.99  # a corner of 8 degrees

    def __post_init__(self) -> None:
        check_fields(self, "deactivation.distortion")
        place = "deactivation.distortion"
        require(0 < self.corner_cosine < 1, f"{place}.corner_cosine", self.corner_cosine, "must lie between 0 and 1")

    def finds(self, cells: Cells) -> Mask:
        """Living elements that are too distorted, shape (m,)."""
        return cells.living & (cells.corner_cosines() > self.corner_cosine)


@dataclass(frozen=True, kw_only=True)
class Deactivation:
    """A section that loses elements: layers of quadrilaterals below the edges that wear.

    Surface nodes move with the wear, along their columns; those inside stay until one from the surface reaches them:
    both then become one. What is left out does not happen.

    Parameters
    ----------
    depth : float
        Thickness of the layers [mm]; their elements have sides of ``Accuracy.patch``.
    distortion : DistortionFilter or None
    damage : Criterion or None
        Only the layers are torn.
    reach : float or None
        How far from a contact that wears and carries load elements are torn [mm], what friction tears out; everywhere
        in the layers if it is not given, cracks included.
    """

    depth: float
    distortion: DistortionFilter | None = None
    damage: Criterion | None = None
    reach: float | None = None

    def __post_init__(self) -> None:
        check_fields(self, "deactivation")
        require(self.depth > 0, "deactivation.depth", self.depth, "must be greater than 0 mm")
        positive = self.reach is None or self.reach > 0
        require(positive, "deactivation.reach", self.reach, "must be greater than 0 mm, or left out")
