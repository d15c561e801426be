"""What a block of rubber between two plates holds of the fluid beside it.

A block of 2 mm by 1 mm (neo-Hooke, G = 1 MPa, K/G = 1e5, plane strain) is squeezed between frictionless plates to 0.8
of its height, its far side held, its near side under a fluid. All is homogeneous, and the fluid adds its pressure to
the Cauchy stress of incompressible rubber everywhere, as in an O-ring in its groove: the plates are pressed with

    p_c = G (1/0.8² - 0.8²) + p.

By the contact stress (Liu, Wang, Chen & Suo, *Elastic leak of a seal*, Extreme Mech. Lett. 1 (2014) 54: a seal leaks
where the fluid's pressure surpasses it) that is what the seal holds in each stroke, always more than the fluid has.
"""

from __future__ import annotations

from ngwear.geometry.outline import Outline
from ngwear.loop.run import run as run_scene
from ngwear.materials import NeoHooke
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Fluid, Support
from ngwear.scene.contact import Contact
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Plane
from ngwear.verify.base import Check, Stopwatch

CASE = "leak_pressure"
LENGTH, HEIGHT, SQUEEZED, EDGE = 2.0, 1.0, 0.8, 0.25
PRESSURES = (0.0, 0.5, 3.0)  # MPa
RUBBER = NeoHooke(shear=1.0, bulk_modulus=1e5)
TOLERANCE = 1e-3


def scene() -> Scene:
    """The block, and a stroke at each pressure."""
    lower, upper = ((1 - SQUEEZED) / 2 * HEIGHT, 1.0), ((1 + SQUEEZED) / 2 * HEIGHT, -1.0)
    plates = {"bottom": lower, "top": upper}
    return Scene(
        name="block in a groove",
        part=Part(Outline.rectangle((0.0, LENGTH), (0.0, HEIGHT)), material=RUBBER),
        contacts=tuple(
            Contact(
                name=f"{side} plate",
                edges=(side,),
                surface=Plane(point=(0.0, y), normal_vector=(0.0, up)),
                refine=True,
            )
            for side, (y, up) in plates.items()
        ),
        supports=(Support(edges=("left",), y=False),),
        fluid=Fluid(edges=("bottom", "right", "top"), inlet=("right",), leak_pressure=True),
        program=Program(
            cycle=tuple(Stroke(name=f"{p:g} MPa", travel=1.0, pressure=p) for p in PRESSURES), strokes=len(PRESSURES)
        ),
        accuracy=Accuracy(patch=EDGE, coarse=EDGE, mounting=EDGE),
        axisymmetric=False,
    )


def run() -> list[Check]:
    """Each pressure."""
    watch = Stopwatch()
    rows = run_scene(scene(), figures=False).records.rows
    squeezed = RUBBER.shear * (SQUEEZED**-2 - SQUEEZED**2)
    return [
        Check(
            CASE,
            f"leak pressure in a stroke under {pressure:g} MPa [MPa]",
            row["leak pressure [MPa]"],
            squeezed + pressure,
            TOLERANCE,
            watch.seconds,
        )
        for pressure, row in zip(PRESSURES, rows[-len(PRESSURES) :], strict=True)
    ]
