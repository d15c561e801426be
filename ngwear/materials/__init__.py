"""Rubber models, one a file; they know no mesh."""

from ngwear.materials.base import Hyperelastic
from ngwear.materials.mooney_rivlin import MooneyRivlin
from ngwear.materials.neo_hooke import NeoHooke

__all__ = ["Hyperelastic", "MooneyRivlin", "NeoHooke"]
