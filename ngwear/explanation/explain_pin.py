"""Describe a pin scene: effects with their cost, and neglected effects with numbers and a verdict."""

from __future__ import annotations

import math
from typing import Any

from ngwear.explanation.assumptions import Assumed
from ngwear.explanation.neglected_effects_pin import left_out
from ngwear.scene.pin_scene import KIND, PinScene


def explain_pin(scene: PinScene, *, assumed: Assumed | None = None) -> dict[str, Any]:
    """Describe a pin scene: each effect with its cost on the first mesh, and each neglected effect with its numbers.

    Parameters
    ----------
    scene : PinScene
    assumed : Assumed or None
        Constants that the scene does not give.
    """
    from ngwear.explanation.effect_costs import MEGABYTE, costs
    from ngwear.explanation.explain_wear import solver_in_words
    from ngwear.sliding.pin import PinStage, coarsened

    pin, assumed = scene.pin, assumed or Assumed()
    stage = PinStage(pin, coarsened(scene.mesh), (0.0, 0.0, pin.contact_radius))
    problem, material, series = stage.problem, pin.material, pin.arms
    rates = [speed / pin.contact_radius for speed in (min(scene.speeds), max(scene.speeds))]
    slow, fast = (rate / (2 * math.pi) for rate in rates)
    foldings = [scene.mesh.folding(series, speed) for speed in (min(scene.speeds), max(scene.speeds))]
    kept = "{} to {}".format(*sorted(len(folding.kept.times) for folding in foldings))
    effects = {
        "hyperelasticity": type(material).__name__,
        "memory": f"{kept} of {len(series.times)} arms in the steady state",
        "contact": f"ball of {pin.radius:g} mm under {pin.load:g} N",
    }
    if pin.friction_law is not None:
        effects["friction"] = f"full sliding, {pin.friction_law.words}, in the direction of the track"
    owners = {name: "contact" if name.startswith("pin ") else "hyperelasticity" for name in problem.names}
    brought = costs(problem, owners)
    memory = dict.fromkeys(effects, 0.0) | brought.memory
    if stage.memory is not None:
        memory["memory"] = stage.memory.nbytes / MEGABYTE
    absent = left_out(scene, assumed)
    turn = 2 * math.pi * pin.track_radius
    return {
        "scene": scene.name,
        "kind": KIND,
        "effects": effects,
        "left out": list(absent),
        "unknowns on the first mesh": {
            name: problem.part(name).stop - problem.part(name).start for name in problem.names
        },
        "unknowns": {name: brought.unknowns.get(name, 0) for name in effects},
        "matrix entries": {name: brought.entries.get(name, 0) for name in effects},
        "memory [MB]": memory,
        "solver": solver_in_words(problem, ["friction"]),
        "numbers": {
            "K/G [-]": material.bulk_modulus / material.shear_modulus,
            "contact radius, a guess, over thickness [-]": pin.contact_radius / pin.thickness,
            "loss factor at the slowest and the fastest [-]": [float(series.tan_delta(f)) for f in (slow, fast)],
            "shortest time of a turn [s]": turn / max(scene.speeds),
            "largest error of stress by arms left out [-]": max(folding.bound for folding in foldings),
        },
        "arms of the memory": {
            f"{time:.4g} s": f"G/G_inf = {ratio:.4g}, tau V/a = {time * rates[0]:.3g} to {time * rates[1]:.3g}: "
            f"{_fates(*(folding.fate(time) for folding in foldings))}"
            for time, ratio in zip(series.times, series.ratios, strict=True)
        },
        "absent": {name: verdict.as_dict() for name, verdict in absent.items()},
        "assumed": assumed.in_data_sheet_units(),
    }


def _fates(slow: str, fast: str) -> str:
    return slow if slow == fast else f"at the lowest speed {slow}; at the highest {fast}"
