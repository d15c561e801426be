"""A lip that a fluid lifts like a check valve, and a foot that holds the fluid: a pocket is between them."""

import numpy as np

import ngwear as nw
from ngwear.geometry.outline import Outline
from ngwear.surfaces import Plane

POINTS = np.array(
    [[0, 0.9], [0.85, 0.06], [1, 0.1], [0.45, 0.9], [2, 0.9], [2, -0.03], [3, -0.03], [3, 2], [0, 2]]
)  # a lip that leans into the pocket, so that the fluid from the left lifts it, and a foot that holds the fluid
NAMES = ("lip", "tip", "inside", "roof", "flank", "foot", "right", "top", "left")
WET = NAMES[:6]
HIGH = 0.05  # MPa


def valve(pockets, pressures=(HIGH, 0.0), strokes=2):
    """A block with a lip and a foot on a plate, held at its top; the fluid comes from the left."""
    outline = Outline(POINTS, NAMES, np.ones(len(POINTS), dtype=bool))
    plate = nw.Contact("plate", edges=WET, surface=Plane(point=(0.0, 0.1), normal_vector=(0.0, 1.0)))
    return nw.Scene(
        "valve",
        nw.Part(outline, material=nw.NeoHooke(shear=1.0, bulk_modulus=1000.0)),
        contacts=[plate],
        supports=[nw.Support(edges=["top"])],
        fluid=nw.Fluid(edges=["left", *WET], inlet=["left"], pockets=pockets),
        program=nw.Program(
            strokes=strokes,
            cycle=[nw.Stroke(f"{i}: {p} MPa", travel=1.0, pressure=p) for i, p in enumerate(pressures)],
        ),
        accuracy=nw.Accuracy(patch=0.05, coarse=0.2, mounting=0.05),
        axisymmetric=False,
    )
