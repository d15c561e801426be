"""A rubber part: outline of its section, and material."""

from __future__ import annotations

from dataclasses import dataclass

from ngwear.errors import require
from ngwear.geometry.outline import Outline
from ngwear.materials import Hyperelastic, PronySeries


@dataclass(frozen=True)
class Part:
    """A rubber part.

    Parameters
    ----------
    outline : Outline
        Outline of the section [mm]; (axial, radial) in an axisymmetric scene.
    material : Hyperelastic
        Long-term hyperelastic behaviour.
    prony : PronySeries or None
        Viscoelastic arms at the scene's temperature, moduli relative to the long-term one; None: elastic rubber.
    """

    outline: Outline
    material: Hyperelastic
    prony: PronySeries | None = None

    def __post_init__(self) -> None:
        require(isinstance(self.outline, Outline), "contour", self.outline, "must be an Outline, as Outline.read gives")
        says = "must be a hyperelastic material, such as NeoHooke(shear=1.0, bulk_modulus=1000.0)"
        require(isinstance(self.material, Hyperelastic), "material", self.material, says)
        known = self.prony is None or isinstance(self.prony, PronySeries)
        require(known, "material.prony", self.prony, "must be a PronySeries")
