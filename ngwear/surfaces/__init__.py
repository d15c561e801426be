"""Rigid counter-surfaces given by their gap, one a file; they know no mesh."""

from ngwear.surfaces.base import RigidSurface
from ngwear.surfaces.cylinder import Cylinder
from ngwear.surfaces.plane import Plane, bore, rod
from ngwear.surfaces.sphere import Sphere
from ngwear.surfaces.worn import WornProfile

__all__ = ["Cylinder", "Plane", "RigidSurface", "Sphere", "WornProfile", "bore", "rod"]
