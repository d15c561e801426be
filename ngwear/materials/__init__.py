"""Rubber models, one in each file; they do not use a mesh."""

from ngwear.materials.base import Hyperelastic
from ngwear.materials.mooney_rivlin import MooneyRivlin
from ngwear.materials.neo_hooke import NeoHooke
from ngwear.materials.prony import Folding, PronySeries
from ngwear.materials.shift import WLF, Arrhenius
from ngwear.materials.stiffened import Stiffened

__all__ = ["WLF", "Arrhenius", "Folding", "Hyperelastic", "MooneyRivlin", "NeoHooke", "PronySeries", "Stiffened"]
