"""Explicit and implicit wear on one mesh: four critical steps ripple, ten do not.

A rubber block of 1.6 x 1 mm in plane strain, nearly incompressible (E = 1 MPa, nu = 0.4995), bottom bonded, sides free,
wears on a rigid plane that presses it with a mean of 1e-4 MPa, without friction. As it wears off evenly in the end,
the true pressure tends to its mean. A step longer than ``ds_crit = 4 h / (pi k E*)`` makes the explicit scheme amplify
the mesh's shortest wave (numerics of the half-plane: each step multiplies a ripple by 1 - k ds E* q / 2); backward
Euler inside the contact damps every wave. Measured is p_max / p_mean over the middle 80 % of the top after the same
number of steps on the same outline and elements of h = 0.05 mm: explicit at 4 ds_crit above 2, implicit at 10 ds_crit
below 1.05. Worn area is k F s to 1e-6 in both: volume is no test of stability.
"""

from __future__ import annotations

import math
import warnings

import numpy as np

from ngwear.effects.contact_profile import ContactProfile
from ngwear.geometry.outline import Outline
from ngwear.materials import NeoHooke
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Support
from ngwear.scene.contact import Contact
from ngwear.scene.options import Wear
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Plane
from ngwear.verify.base import Bound, Check, Stopwatch
from ngwear.verify.wear_runs import steps
from ngwear.wear.archard import critical_distance

RUBBER = NeoHooke.from_young(1.0, 0.4995)
HALF, HEIGHT, PATCH = 0.8, 1.0, 0.05  # the top is halved five times: elements of just 0.05 mm
MEAN, WEAR_RATE, STEPS = 1e-4, 1e-3, 30
CRITICAL = critical_distance(PATCH, WEAR_RATE, RUBBER.plane_strain_modulus)


def scene(scheme: str, times: float) -> Scene:
    """The block with a scheme and a stroke of ``times`` the critical distance, every stroke solved."""
    counter = Plane(point=(0.0, HEIGHT), normal_vector=(0.0, -1.0))
    return Scene(
        name=f"{scheme} wear",
        part=Part(Outline.rectangle((-HALF, HALF), (0.0, HEIGHT)), material=RUBBER),
        contacts=(
            Contact(name="plane", edges=("top",), surface=counter, force=2 * HALF * MEAN, specific_wear_rate=WEAR_RATE),
        ),
        supports=(Support(edges=("bottom",)),),
        program=Program(cycle=(Stroke(name="turn", travel=times * CRITICAL),), strokes=STEPS),
        accuracy=Accuracy(patch=PATCH, coarse=0.2, mounting=PATCH),
        wear=Wear(scheme=scheme, step="each"),
        axisymmetric=False,
    )


def roughness(profile: ContactProfile) -> float:
    """p_max / p_mean over the middle 80 % of the top [-]."""
    inside = np.abs(profile.reference[:, 0]) <= 0.8 * HALF
    pressure, weight = profile.nominal_pressure[inside], profile.weight[inside]
    return float(pressure.max() / (pressure @ weight / weight.sum()))


def run() -> list[Check]:
    """Both schemes: roughness of the pressure and worn area."""
    checks = []
    cases: tuple[tuple[str, float, float, Bound], ...]
    cases = ("explicit", 4.0, 2.0, "above"), ("implicit", 10.0, 1.05, "below")
    for scheme, times, limit, bound in cases:
        clock = Stopwatch()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # the scheme says itself that it is unstable
            *_, state = steps(scene(scheme, times))
        rough = roughness(state.reports[-1].contacts["plane"])
        law = WEAR_RATE * 2 * HALF * MEAN * STEPS * times * CRITICAL
        seconds = clock.seconds
        checks += [
            Check(
                "stability_pair",
                f"p_max / p_mean, {scheme}, {times:.0f} critical steps [-]",
                rough,
                limit,
                math.nan,
                seconds,
                bound=bound,
            ),
            Check(
                "stability_pair", f"worn area over k F s, {scheme} [-]", state.ledger.removed / law, 1.0, 1e-6, seconds
            ),
        ]
    return checks
