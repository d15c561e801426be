"""What a scene of a pin on a plate simulates, what it leaves out, and numbers that tell whether that matters."""

from __future__ import annotations

import math
from typing import Any

from ngwear.sliding.scene import KIND, PinScene


def explain_pin(scene: PinScene) -> dict[str, Any]:
    """Describe a scene: effects, unknowns of the first mesh, dimensionless numbers, and each arm's Deborah numbers."""
    from ngwear.sliding.pin import PinStage, coarsened

    pin = scene.pin
    stage = PinStage(pin, coarsened(scene.mesh), (0.0, 0.0, pin.contact_radius))
    problem, material, series = stage.problem, pin.material, pin.series
    rates = [speed / pin.contact_radius for speed in (min(scene.speeds), max(scene.speeds))]
    slow, fast = (rate / (2 * math.pi) for rate in rates)
    foldings = [scene.mesh.folding(series, speed) for speed in (min(scene.speeds), max(scene.speeds))]
    kept = "{} to {}".format(*sorted(len(folding.kept.times) for folding in foldings))
    effects = {
        "hyperelasticity": type(material).__name__,
        "memory": f"{kept} of {len(series.times)} arms in the steady state of a pin that has been running for ever",
        "contact": f"ball of {pin.radius:g} mm under {pin.load:g} N",
    }
    if pin.friction_law is not None:
        effects["friction"] = f"full sliding, {pin.friction_law.words}, in the direction of the track"
    turn = 2 * math.pi * pin.track_radius
    return {
        "scene": scene.name,
        "kind": KIND,
        "effects": effects,
        "left out": ["wear", "stick-slip", "heat", "adhesion", "inertia", "fluid film"],
        "unknowns on the first mesh": {
            name: problem.part(name).stop - problem.part(name).start for name in problem.names
        },
        "numbers": {
            "K/G [-]": material.bulk_modulus / material.shear_modulus,
            "contact radius, a guess, over thickness [-]": pin.contact_radius / pin.thickness,
            "loss factor at the slowest and the fastest [-]": [float(series.tan_delta(f)) for f in (slow, fast)],
            "shortest time of a turn [s]": turn / max(scene.speeds),
            "largest error of stress by folding [-]": max(folding.bound for folding in foldings),
        },
        "arms of the memory": {
            f"{time:.4g} s": f"G/G_inf = {ratio:.4g}, tau V/a = {time * rates[0]:.3g} to {time * rates[1]:.3g}: "
            f"{_fates(*(folding.fate(time) for folding in foldings))}"
            for time, ratio in zip(series.times, series.ratios, strict=True)
        },
    }


def _fates(slow: str, fast: str) -> str:
    return slow if slow == fast else f"at the lowest speed {slow}; at the highest {fast}"
