"""Friction and abrasive wear of rubber parts, seals above all, on NGSolve and Netgen.

    import ngwear as nw

    result = nw.run(nw.read_scene("scene.toml"), accuracy=0.01, out="out")
    print(result)

The names below are loaded when they are first used: ``import ngwear`` itself loads nothing.

It asks OpenBLAS for one thread, unless ``OPENBLAS_NUM_THREADS`` is set: the dense matrices here are too small for more,
and threads that wait for work take CPU time. NGSolve's own threads are another matter, and stay.
"""

import os
import sys
from importlib import import_module
from typing import Any

NUMPY_CAME_FIRST = "numpy" in sys.modules  # its OpenBLAS has read its number of threads
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

_NAMES = {
    "ngwear.geometry.outline": "Outline",
    "ngwear.scene.part": "Part",
    "ngwear.scene.contact": "Contact",
    "ngwear.scene.boundary": "Fluid Support",
    "ngwear.scene.program": "Program Stroke",
    "ngwear.scene.accuracy": "Accuracy",
    "ngwear.scene.options": "Wear Save",
    "ngwear.scene.deactivation": "Deactivation DistortionFilter",
    "ngwear.scene.scene": "Scene",
    "ngwear.scene.pin_scene": "Pin PinMesh PinScene",
    "ngwear.scene.read_scene": "read_scene",
    "ngwear.materials": "NeoHooke MooneyRivlin PronySeries WLF Arrhenius",
    "ngwear.surfaces": "Plane Corner Cylinder rod bore",
    "ngwear.laws": "Constant Lubrication Stribeck ByPressure Product WearRate "
    "PowerWear ThresholdWear SaturatingWear FrictionalEnergyWear",
    "ngwear.laws.damage": "TensileNormalStress MaximumPrincipalStress StrainEnergyDensity Fatigue",
    "ngwear.error_estimates.run": "run read_result",
    "ngwear.error_estimates.cost": "cost",
    "ngwear.explanation.explain": "explain",
    "ngwear.verify": "verify",
    "ngwear.parallel.sweep": "sweep",
    "ngwear.profiles.comparison": "compare_profile",
    "ngwear.loop.stepper": "Stepper",
    "ngwear.loop.result": "Result",
    "ngwear.sliding.run_pin": "PinResult",
    "ngwear.explanation.assumptions": "Assumed",
    "ngwear.errors": "NgwearError SceneError GeometryError MeshError ConvergenceError ResultError",
}
_MODULES = {name: module for module, names in _NAMES.items() for name in names.split()}

__all__ = ["__version__", *sorted(_MODULES)]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("ngwear.files.version").VERSION
    if name not in _MODULES:
        raise AttributeError(f"module 'ngwear' has no attribute {name!r}")
    value = getattr(import_module(_MODULES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
