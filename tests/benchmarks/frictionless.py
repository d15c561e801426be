"""Problem P1a through the program's scene or by hand from its parts: the subjects of ``test_frictionless_cost``.

The sheet under the roller, the whole of it, solved from rest in one step of 0.30 mm on one mesh. By hand there is
elasticity and contact; neither imports a module of friction. Each line read asks for one solve; each line written
tells its CPU seconds, Newton iterations and force [N/mm]; the first one tells unknowns, solver and whether it was told
that the matrix is symmetric.

Usage: python frictionless.py scene | hand
"""

import sys
import time

import numpy as np

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.equilibrium.attempts import solve
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.body import Body
from ngwear.geometry.outline import Outline
from ngwear.geometry.sizing import SizeField
from ngwear.materials import MooneyRivlin
from ngwear.surfaces import Cylinder

WIDTH, THICKNESS, RADIUS, DEPTH = 20.0, 2.0, 5.0, 0.30
PATCH, COARSE = 0.05, 0.35  # element edges [mm]
RUBBER = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1000.0)
ROLLER = Cylinder(centre=(0.0, THICKNESS + RADIUS - DEPTH), radius=RADIUS)
FRICTION = ("ngwear.effects.friction", "ngwear.effects.stick_slip", "ngwear.effects.coefficient")


def sheet():
    """The meshed sheet, fine under the roller."""
    outline = Outline.rectangle((-WIDTH / 2, WIDTH / 2), (0.0, THICKNESS))
    at = np.arange(-1.9, 1.9 + PATCH / 2, PATCH)
    seeds = np.stack([at, np.full(len(at), THICKNESS)], axis=1)
    return Body(outline, SizeField(seeds, np.full(len(at), PATCH), COARSE))


def by_hand():
    """Elasticity and contact, and nothing else."""
    contact = OutlineContact("roller", ("top",), ROLLER, modulus=RUBBER.shear_modulus)
    problem = Problem(sheet(), PlaneStrain(), [Elasticity(RUBBER), contact], supports=[FixedEdges(("bottom",))])
    assert not set(FRICTION) & set(sys.modules), "friction is imported"
    return problem, contact


def through_scene():
    """What the program makes of a scene without friction; it imports no more."""
    from ngwear.loop.stage import Stage
    from ngwear.scene.boundary import Support
    from ngwear.scene.contact import Contact
    from ngwear.scene.part import Part
    from ngwear.scene.program import Program, Stroke
    from ngwear.scene.scene import Scene

    body = sheet()
    scene = Scene(
        name="P1a",
        part=Part(body.base, material=RUBBER),
        contacts=(Contact(name="roller", edges=("top",), surface=ROLLER),),
        supports=(Support(edges=("bottom",)),),
        program=Program(cycle=(Stroke(name="turn", travel=1.0),), strokes=1),
        axisymmetric=False,
    )
    stage = Stage(scene, body)
    stage.problem.set_loads(stage.stroke_loads(scene.program.cycle[0]))
    assert not set(FRICTION) & set(sys.modules), "friction is imported"
    return stage.problem, stage.contacts["roller"]


def main(kind):
    """Answer every line with a solve from rest."""
    problem, contact = {"scene": through_scene, "hand": by_hand}[kind]()
    rest = problem.state.vec.FV().NumPy().copy()

    def solved():
        problem.state.vec.FV().NumPy()[:] = rest
        start = time.process_time()
        report = solve(problem)
        seconds = time.process_time() - start
        assert report.converged, report
        return f"{seconds!r} {report.iterations} {float(-contact.force()[1])!r}\n"

    solved()  # the first one also orders the unknowns
    tell = sys.stdout
    tell.write(f"{problem.space.ndof} {problem.solver.name} {problem.symmetric}\n")
    tell.flush()
    for _ in sys.stdin:
        tell.write(solved())
        tell.flush()


if __name__ == "__main__":
    main(sys.argv[1])
