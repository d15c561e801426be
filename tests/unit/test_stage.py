"""First touch of a surface under force."""

import numpy as np

from ngwear.geometry.contour import Contour
from ngwear.materials import NeoHooke
from ngwear.scene import Accuracy, ContactSpec, Program, Scene, Stroke, SupportSpec
from ngwear.stepper import Stepper
from ngwear.surfaces import Plane


def test_surface_under_force_finds_several_ridges_of_one_height():
    """The three nearest points of the outline are then three tips, not one tip and what is beside it."""
    top = [(x, 1.05 if k % 2 else 1.0) for k, x in enumerate(np.linspace(1.8, 0.2, 7))]
    outline = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), *top, (0.0, 1.0)]
    names = ("bottom", "right", *(("top",) * 8), "left")
    plane = Plane(point=(0.0, 1.05), normal_vector=(0.0, -1.0))
    scene = Scene(
        name="three ridges",
        contour=Contour(np.array(outline), names, np.ones(len(outline), dtype=bool)),
        material=NeoHooke(shear=1.0, bulk_modulus=100.0),
        contacts=(ContactSpec(name="lid", edges=("top",), surface=plane, force=0.2, refine=True),),
        supports=(SupportSpec(edges=("bottom",)),),
        program=Program(cycle=(Stroke(name="stroke", travel=1.0),), strokes=1),
        accuracy=Accuracy(patch=0.05, coarse=0.3, mounting=0.05),
    )
    state = Stepper(scene).start()
    contact = state.stage.contacts["lid"]
    assert abs(contact.force()[1] + 0.2) < 1e-8
    assert len(contact.profile().zones()) == 3
