"""A column under a flat surface in a fixed place, whose uniform pressure relaxes as it wears; runs by every scheme."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import lambertw

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.pressure_wear import PressureWear
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import advance
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.laws import PowerWear, SaturatingWear, ThresholdWear, WearLaw
from ngwear.materials import NeoHooke
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.boundary import Support
from ngwear.scene.contact import Contact
from ngwear.scene.options import Wear
from ngwear.scene.part import Part
from ngwear.scene.program import Program, Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import Plane
from ngwear.verify.builders import meshed
from ngwear.verify.wear_runs import steps

Array = NDArray[np.float64]
RUBBER = NeoHooke.from_young(1.0, 0.4)
CONFINED = RUBBER.bulk_modulus + 4 * RUBBER.shear_modulus / 3  # M: stress over strain where the sides are held
WIDTH, HEIGHT, PATCH, STRAIN, WEAR_RATE = 1.0, 1.0, 0.25, 1e-4, 1e-3
FIRST = CONFINED * STRAIN  # pressure before any wear [MPa]
UNIT = HEIGHT / (CONFINED * WEAR_RATE)  # way over which Archard's pressure falls to 1/e [mm]
CONTOUR = Outline.rectangle((0.0, WIDTH), (0.0, HEIGHT))
SURFACE = Plane(point=(0.0, HEIGHT * (1 - STRAIN)), normal_vector=(0.0, -1.0))
THRESHOLD = 0.4
LAWS: dict[str, tuple[WearLaw, Callable[[float], float]]] = {
    "power 2": (PowerWear(exponent=2.0, reference_pressure=FIRST), lambda x: 1 / (1 + x)),
    "power 0.5": (PowerWear(exponent=0.5, reference_pressure=FIRST), lambda x: max(0.0, 1 - x / 2) ** 2),
    "threshold": (ThresholdWear(pressure=THRESHOLD * FIRST), lambda x: THRESHOLD + (1 - THRESHOLD) * np.exp(-x)),
    "saturating": (SaturatingWear(pressure=FIRST), lambda x: float(lambertw(np.exp(1 - x)).real)),
}


def scene(law: WearLaw | None, way: float, count: int, *, scheme: str = "implicit", **contact: Any) -> Scene:
    """The column over a way [``UNIT``] in some strokes, each of them solved; ``contact`` as of ``Contact``."""
    spec: dict[str, Any] = {"specific_wear_rate": WEAR_RATE, "wear_law": law} | contact
    return Scene(
        name="column",
        part=Part(CONTOUR, material=RUBBER),
        contacts=(Contact(name="plane", edges=("top",), surface=SURFACE, **spec),),
        supports=(Support(edges=("bottom",), x=False), Support(edges=("left", "right"), y=False)),
        program=Program(cycle=(Stroke(name="turn", travel=way * UNIT / count),), strokes=count),
        accuracy=Accuracy(patch=PATCH, coarse=PATCH, mounting=PATCH),
        wear=Wear(scheme=scheme, step="each"),
        axisymmetric=False,
    )


def pressures(run: Scene) -> Array:
    """Mean pressure over the first one, at the end of each stroke [-]."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        profiles = [state.reports[-1].contacts["plane"] for state in steps(run)]
    return np.array([p.load.sum() / (WIDTH * FIRST) for p in profiles])


def depth(run: Scene) -> float:
    """Mean worn depth at the end over the indentation [-]."""
    *_, state = steps(run)
    return state.ledger.removed / (WIDTH * HEIGHT * STRAIN)


def by_backward_euler(law: WearLaw, way: float, count: int) -> float:
    """The pressure at the end [-] by plain backward Euler, the depth kept in the gap of one contact."""
    body = meshed(CONTOUR, PATCH)
    contact = OutlineContact("plane", ("top",), SURFACE, wears=True, modulus=RUBBER.shear_modulus)
    contact.pressure_wear = PressureWear(law, modulus=RUBBER.shear_modulus)
    supports = [FixedEdges(("bottom",), x=False), FixedEdges(("left", "right"), y=False)]
    problem = Problem(body, PlaneStrain(), [Elasticity(RUBBER), contact], supports=supports)
    contact.load.Set(-HEIGHT * STRAIN)
    advance(problem, {"plane approach [mm]": 0.0})
    worn, step = 0.0, WEAR_RATE * way * UNIT / count
    contact.compliance.Set(step)
    for _ in range(count):
        contact.set_worn(np.full(len(CONTOUR), worn))
        advance(problem, {})
        pressure = contact.profile().pressure.mean()
        worn += step * pressure * float(contact.wear_factor(pressure))
    return pressure / FIRST


def euler_step(law: WearLaw, pressure: float, way: float) -> float:
    """One backward Euler step of ``dq/dx = -q phi(q)`` [-], by bisection."""
    low, high = 0.0, pressure
    for _ in range(100):
        middle = 0.5 * (low + high)
        excess = middle + way * middle * float(law.factor(middle * FIRST)) - pressure
        low, high = (low, middle) if excess > 0 else (middle, high)
    return high
