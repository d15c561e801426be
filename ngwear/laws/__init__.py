"""Laws of friction and of wear, one a file; they know no mesh."""

from ngwear.laws.base import Curve, FrictionLaw
from ngwear.laws.constant import Constant, law_of
from ngwear.laws.lubrication import Lubrication
from ngwear.laws.pressure import ByPressure
from ngwear.laws.product import Product
from ngwear.laws.stribeck import Stribeck
from ngwear.laws.wear_rate import WearRate

__all__ = ["ByPressure", "Constant", "Curve", "FrictionLaw", "Lubrication", "Product", "Stribeck", "WearRate", "law_of"]
