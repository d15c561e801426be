"""What a scene simulates, what it leaves out, and the numbers that tell whether that matters."""

from __future__ import annotations

import math
from typing import Any

from ngwear.drift import friction_range
from ngwear.laws import Constant
from ngwear.scene import ContactSpec, Scene
from ngwear.wear.archard import critical_distance
from ngwear.wear.deactivate import Deactivation


def explain(scene: Scene) -> dict[str, Any]:
    """Describe a scene: effects, unknowns on the mounting mesh, solver, dimensionless numbers.

    Raises
    ------
    MeshError
        If the section cannot be meshed.
    """
    from ngwear.equilibrium.linear import has_pardiso
    from ngwear.mounting import unworn_body
    from ngwear.stage import Stage

    stage = Stage(scene, unworn_body(scene))
    problem, material = stage.problem, scene.material
    rate = max((c.wear_rate.highest for c in scene.contacts), default=0.0)
    critical = critical_distance(scene.accuracy.patch, rate, material.plane_strain_modulus)
    travel = max(s.travel for s in scene.program.cycle)
    present = {"hyperelasticity": type(material).__name__}
    present |= {f"contact '{c.name}'": f"edges {', '.join(c.edges)}" for c in scene.contacts}
    present |= {f"friction at '{c.name}'": _friction_in_words(scene, c) for c in scene.contacts if c.friction_law}
    if scene.fluid is not None:
        present["fluid pressure"] = f"from {', '.join(scene.fluid.inlet)} to the first point in contact"
    if rate > 0:
        laws = [c.wear_law.words if c.wear_law else "Archard" for c in scene.contacts if c.wears]
        how = f"{scene.wear.scheme}, step '{scene.wear.step}', new meshes '{scene.wear.remesh}'"
        present["wear"] = f"{' / '.join(dict.fromkeys(laws))}, {how}"
    if scene.deactivation is not None:
        present["elements that may be lost"] = _deactivation_in_words(scene.deactivation)
    present |= {f"wear rate at '{c.name}'": _wear_in_words(scene, c) for c in scene.contacts if c.wear_rate.varies}
    present |= {
        f"wear of the surface of '{c.name}'": f"k = {c.counter_wear_rate:g} mm²/N, a profile that moves with it"
        for c in scene.contacts
        if c.counter_wear_rate > 0
    }
    if scene.prony is not None:
        present["memory"] = _memory_in_words(scene)
    left_out = ["heat", "adhesion", "inertia", "fluid film"]
    if not stage.remembers:
        left_out.insert(0, "stick-slip")
    if scene.prony is None:
        left_out.insert(0, "viscosity")
    return {
        "scene": scene.name,
        "kind": "axisymmetric" if scene.axisymmetric else "plane strain",
        "effects": present,
        "left out": left_out,
        "unknowns on the mounting mesh": {
            name: problem.part(name).stop - problem.part(name).start for name in problem.names
        },
        "solver": "LDLT (symmetric terms only)"
        if problem.symmetric
        else f"LU, {'pardiso' if has_pardiso() else 'umfpack'} (friction or a follower pressure is unsymmetric)",
        "numbers": {
            "K/G [-]": material.bulk_modulus / material.shear_modulus,
            "highest sealed pressure / G [-]": max(s.pressure for s in scene.program.cycle) / material.shear_modulus,
            "longest stroke / critical explicit wear distance [-]": travel / critical,
            **_memory_numbers(scene),
        },
        **({"arms of the memory": _arms(scene)} if scene.prony is not None else {}),
    }


def _deactivation_in_words(deactivation: Deactivation) -> str:
    distortion, damage, reach = deactivation.distortion, deactivation.damage, deactivation.reach
    told = [f"layers {deactivation.depth:g} mm deep; surface nodes wear through them"]
    if distortion is not None:
        told.append(f"distorted beyond a corner cosine of {distortion.corner_cosine:g}")
    if damage is not None:
        where = "" if reach is None else f" within {reach:g} mm of the contact"
        over = "" if damage.length is None else f", averaged over {damage.length:g} mm,"
        told.append(f"torn where the {damage.name}{over} exceeds {damage.critical:g}{where}")
    return "; ".join(told)


def _friction_in_words(scene: Scene, contact: ContactSpec) -> str:
    law = contact.friction_law
    words = f"{'stick and slip' if scene.may_stick(contact) else 'full sliding'}, {law.words}"
    if not isinstance(law, Constant):
        low, high = friction_range(scene, contact)
        met = f"{low:g}" if low == high else f"{low:g} to {high:g}"
        words += f"; the scene meets mu = {met}" + (" at p = 0" if law.depends_on_pressure else "")
    return f"{words}: {scene.why_it_may_stick(contact)}"


def _wear_in_words(scene: Scene, contact: ContactSpec) -> str:
    rate, end = contact.wear_rate, scene.program.slid(scene.program.strokes)
    low, high = rate.curve.extremes(0.0, end)
    return f"by lubrication, {len(rate.distance)} rows; the scene meets k = {low:g} to {high:g} mm²/N"


def _memory_in_words(scene: Scene) -> str:
    folding = scene.folding
    kept, fast, slow = len(folding.kept.times), len(folding.fast), len(folding.slow)
    rest = scene.program.rest
    before = f"mounted {rest:g} s before" if math.isfinite(rest) else "mounted and relaxed before"
    return f"{kept} arms kept; {fast} folded to nothing, {slow} into the elastic part; {before}"


def _memory_numbers(scene: Scene) -> dict[str, float]:
    if scene.prony is None:
        return {}
    folding = scene.folding
    return {
        "G0/G of the arms kept [-]": folding.kept.instantaneous,
        "elastic part over long-term stiffness [-]": folding.stiffening,
        "largest error of stress by folding [-]": folding.bound,
        "shortest stroke [s]": min(stroke.duration for stroke in scene.program.cycle),
        "all strokes [s]": scene.program.duration,
    }


def _arms(scene: Scene) -> dict[str, str]:
    """Each arm: what becomes of it, its stiffness, and Deborah's number of every kind of stroke."""
    folding = scene.folding
    told = {}
    for time, ratio in zip(scene.prony.times, scene.prony.ratios, strict=True):
        deborah = {f"{time / stroke.duration:.3g}": None for stroke in scene.program.cycle}
        told[f"{time:.4g} s"] = f"G/G_inf = {ratio:.4g}, tau/D = {', '.join(deborah)}: {folding.fate(time)}"
    return told
