"""Rigid counter-surfaces, given by their gap function, one in each file; they do not use a mesh."""

from ngwear.surfaces.base import RigidSurface
from ngwear.surfaces.corner import Corner
from ngwear.surfaces.cylinder import Cylinder
from ngwear.surfaces.plane import Plane, bore, rod
from ngwear.surfaces.sphere import Sphere
from ngwear.surfaces.worn import WornProfile

__all__ = ["Corner", "Cylinder", "Plane", "RigidSurface", "Sphere", "WornProfile", "bore", "rod"]
