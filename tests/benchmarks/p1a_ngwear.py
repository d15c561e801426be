"""Problem P1a with ngwear, one load step, the whole sheet: the subject of ``test_race_p1a.py``.

Triangles of order 2, small under the cylinder and along the bonded bottom below it, large elsewhere.

Usage: python p1a_ngwear.py
"""

import numpy as np

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import advance
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.body import Body
from ngwear.geometry.outline import Outline
from ngwear.geometry.sizing import SizeField
from ngwear.materials import MooneyRivlin
from ngwear.surfaces import Cylinder

WIDTH, THICKNESS, RADIUS, DEPTH = 20.0, 2.0, 5.0, 0.30
PATCH, BOTTOM, COARSE, GRADING = 0.2, 0.3, 1.0, 0.4  # element edges [mm], their growth [-]


def main():
    """Solve and print the force [N/mm]."""
    outline = Outline.rectangle((-WIDTH / 2, WIDTH / 2), (0.0, THICKNESS))
    top = [(x, THICKNESS) for x in np.linspace(-2.0, 2.0, 28)]
    bottom = [(x, 0.0) for x in np.linspace(-3.5, 3.5, 29)]
    sizes = np.repeat([PATCH, BOTTOM], [len(top), len(bottom)])
    body = Body(outline, SizeField(np.array(top + bottom), sizes, COARSE, grading=GRADING))

    rubber = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1000.0)
    cylinder = Cylinder(centre=(0.0, THICKNESS + RADIUS), radius=RADIUS)
    contact = OutlineContact("roller", ("top",), cylinder, modulus=rubber.shear_modulus)
    problem = Problem(body, PlaneStrain(), [Elasticity(rubber), contact], supports=[FixedEdges(("bottom",))])
    work = advance(problem, {"roller approach [mm]": DEPTH})
    print(f"dofs {problem.space.ndof} iterations {work.iterations} force {-contact.force()[1]:.6f}")  # noqa: T201


if __name__ == "__main__":
    main()
