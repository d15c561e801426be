"""Laws of friction and of wear, one in each file; they do not use a mesh."""

from ngwear.laws.base import Curve, FrictionLaw
from ngwear.laws.constant import Constant, law_of
from ngwear.laws.energy_wear import FrictionalEnergyWear
from ngwear.laws.lubrication import Lubrication
from ngwear.laws.power_wear import PowerWear
from ngwear.laws.pressure import ByPressure
from ngwear.laws.product import Product
from ngwear.laws.saturating_wear import SaturatingWear
from ngwear.laws.stribeck import Stribeck
from ngwear.laws.threshold_wear import ThresholdWear
from ngwear.laws.wear_law import WearLaw
from ngwear.laws.wear_rate import WearRate

__all__ = [
    "ByPressure",
    "Constant",
    "Curve",
    "FrictionLaw",
    "FrictionalEnergyWear",
    "Lubrication",
    "PowerWear",
    "Product",
    "SaturatingWear",
    "Stribeck",
    "ThresholdWear",
    "WearLaw",
    "WearRate",
    "law_of",
]
