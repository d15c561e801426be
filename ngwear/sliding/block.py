"""The rubber block under a sliding cylinder, with given element sizes along its top."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.memory import Memory
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.errors import ConvergenceError
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.body import Body
from ngwear.geometry.outline import Outline
from ngwear.geometry.sizing import SizeField
from ngwear.materials import Hyperelastic
from ngwear.surfaces import Cylinder

Array = NDArray[np.float64]
FORCE, SLIDE = "cylinder force [N]", "cylinder slide [mm]"


@dataclass(frozen=True)
class Block:
    """A cylinder under force on a block in plane strain; the bottom is bonded, the sides slide.

    Attributes
    ----------
    problem : Problem
    contact : OutlineContact
    """

    problem: Problem
    contact: OutlineContact

    @classmethod
    def under(
        cls, body: Body, material: Hyperelastic, memory: Memory, *, radius: float, load: float, slides: bool = False
    ) -> Block:
        """Put a cylinder above x = 0 on the top of a rectangular body, touching, with its load [N/mm]."""
        depth = float(np.ptp(body.contour.points[:, 1]))
        cylinder = Cylinder(centre=(0.0, depth + radius), radius=radius)
        contact = OutlineContact(
            "cylinder", ("top",), cylinder, force_controlled=True, slides=slides, modulus=material.shear_modulus
        )
        supports = [FixedEdges(("bottom",)), FixedEdges(("left", "right"), y=False)]
        problem = Problem(body, PlaneStrain(), [Elasticity(material), memory, contact], supports=supports)
        problem.set_loads({FORCE: load})
        return cls(problem, contact)

    @property
    def indentation(self) -> float:
        """Of the cylinder [mm]."""
        return float(self.problem.fields[self.contact.travel_name].vec[0])

    def indent(self, depth: float) -> None:
        """Move the cylinder into the block by a depth [mm], as a start state."""
        self.problem.fields[self.contact.travel_name].vec[0] = depth

    @property
    def friction(self) -> float:
        """Horizontal over vertical force, positive if it brakes a cylinder that moves towards +x [-]."""
        along, across = self.contact.force()
        return -float(along / across)

    @property
    def ends(self) -> Array:
        """Where the contact starts and ends along x [mm], shape (2,)."""
        zones = self.contact.profile().zones()
        if len(zones) != 1:
            raise ConvergenceError(f"the contact has {len(zones)} pieces; a smooth cylinder has one: refine the mesh")
        return np.sort([zones[0].start[0], zones[0].end[0]])


def meshed_block(x: tuple[float, float], depth: float, places: Array, sizes: Array, *, grading: float) -> Body:
    """Rectangle from y = 0 to ``depth``, with elements of the given sizes at places of shape (n, 2) [mm]."""
    return Body(Outline.rectangle(x, (0.0, depth)), SizeField(places, sizes, depth / 4, grading=grading))


def march(start: float, stop: float, size: Callable[[float], float]) -> Array:
    """Places from start to stop, each ``size`` of the last one further."""
    places = [start]
    while places[-1] < stop:
        places.append(places[-1] + size(places[-1]))
    places[-1] = stop
    return np.array(places)
