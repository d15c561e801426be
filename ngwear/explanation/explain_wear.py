"""Describe a wear scene: effects with their cost, solver, and neglected effects with numbers and a verdict."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from ngwear.explanation.assumptions import Assumed
from ngwear.laws import Constant, FrictionLaw
from ngwear.loop.element_sizes import with_contact_lengths, with_mounting_lengths
from ngwear.loop.law_changes import friction_range
from ngwear.materials import Folding
from ngwear.scene.boundary import TRAPPED
from ngwear.scene.contact import Contact
from ngwear.scene.deactivation import Deactivation
from ngwear.scene.holding import free_directions
from ngwear.scene.scene import Scene
from ngwear.wear.archard import critical_distance

if TYPE_CHECKING:  # these modules load the solver
    from ngwear.equilibrium.problem import Problem
    from ngwear.explanation.contact_pressures import Pressing
    from ngwear.loop.stage import Stage


def explain_wear(
    scene: Scene, *, assumed: Assumed | None = None, on_mount: Callable[[float], None] | None = None
) -> dict[str, Any]:
    """Describe a wear scene: each effect with its cost, the solver, and each neglected effect with its numbers.

    The part is mounted once on a coarse mesh to find the contact pressures, without memory and wear.

    Parameters
    ----------
    scene : Scene
    assumed : Assumed or None
        Constants that the scene does not give.
    on_mount : callable or None
        Called with the completed fraction of the mounting.

    Raises
    ------
    MeshError
        If the section cannot be meshed.
    """
    from ngwear.explanation.contact_pressures import press
    from ngwear.explanation.effect_costs import costs
    from ngwear.explanation.neglected_effects import left_out
    from ngwear.loop.mounting import unworn_body
    from ngwear.loop.stage import Stage

    assumed, across = assumed or Assumed(), scene.accuracy.across
    scene = with_mounting_lengths(scene)
    stage = Stage(scene, unworn_body(scene, across))
    problem, material = stage.problem, scene.part.material
    brought = costs(problem, _owners(scene, problem.names))
    pressing = press(scene, stage, on_mount=on_mount)
    if across is not None and pressing.states:
        scene = with_contact_lengths(stage, list(pressing.states), across)
    absent = left_out(scene, pressing, has_stick_slip=stage.has_stick_slip, assumed=assumed)
    present = _present(scene)
    rate = max((c.wear_rate.highest for c in scene.contacts), default=0.0)
    critical = critical_distance(scene.accuracy.lengths.patch, rate, material.plane_strain_modulus)
    return {
        "scene": scene.name,
        "kind": "axisymmetric" if scene.axisymmetric else "plane strain",
        "effects": present,
        "left out": list(absent),
        "unknowns on the mounting mesh": {
            name: problem.part(name).stop - problem.part(name).start for name in problem.names
        },
        "unknowns": {name: brought.unknowns.get(name, 0) for name in present},
        "matrix entries": {name: brought.entries.get(name, 0) for name in present},
        "memory [MB]": {name: brought.memory.get(name, 0.0) for name in present} | _kept(scene, stage, pressing),
        "solver": solver_in_words(problem, _unsymmetric(scene)),
        "numbers": {
            "element edge in the contact [mm]": scene.accuracy.lengths.patch,
            "K/G [-]": material.bulk_modulus / material.shear_modulus,
            "highest sealed pressure / G [-]": max(s.highest_pressure for s in scene.program.cycle)
            / material.shear_modulus,
            "longest stroke / critical explicit wear distance [-]": max(s.travel for s in scene.program.cycle)
            / critical,
            **_memory_numbers(scene),
        },
        **({"arms of the memory": arms} if (arms := _arms(scene)) is not None else {}),
        "absent": {name: verdict.as_dict() for name, verdict in absent.items()},
        "assumed": assumed.in_data_sheet_units(),
    }


def _present(scene: Scene) -> dict[str, str]:
    """Each effect of the scene, with a text."""
    present = {"hyperelasticity": type(scene.part.material).__name__}
    present |= {f"contact '{c.name}'": f"edges {', '.join(c.edges)}" for c in scene.contacts}
    frictions = [(c, law) for c in scene.contacts if (law := c.friction_law) is not None]
    present |= {f"friction at '{c.name}'": _friction_in_words(scene, c, law) for c, law in frictions}
    if scene.fluid is not None:
        inlets = ", ".join(edge for edges in scene.fluid.inlets.values() for edge in edges)
        present["fluid pressure"] = f"from {inlets} to the first point in contact"
        if scene.fluid.pockets == TRAPPED:
            present["fluid pressure"] += "; pockets that contacts cut off keep theirs"
        if not any(stroke.highest_pressure for stroke in scene.program.cycle):
            present["fluid pressure"] += (
                "; no stroke has a pressure: without [fluid] the result is the same in less time"
            )
    if free := free_directions(scene):
        along = " and ".join("xy"[axis] for axis in free)
        present["room to move"] = f"nothing holds the part along {along}: it moves until a surface stops it"
    if scene.worn_edges:
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
    folding = scene.folding
    if folding is not None:
        present["memory"] = _memory_in_words(scene, folding)
    return present


def _owners(scene: Scene, names: Sequence[str]) -> dict[str, str]:
    """Effect to which each unknown belongs."""
    owners = dict.fromkeys(names, "hyperelasticity")
    for c in scene.contacts:
        owners |= {
            name: f"contact '{c.name}'" for name in (f"{c.name} pressure", f"{c.name} approach") if name in names
        }
    for c in scene.contacts:
        owners |= {name: f"friction at '{c.name}'" for name in names if name.startswith(f"{c.name} traction ")}
    return owners


def _unsymmetric(scene: Scene) -> list[str]:
    """Effects whose tangent is not symmetric."""
    found = [f"friction at '{c.name}'" for c in scene.contacts if c.friction_law is not None]
    return found + ["fluid pressure"] * (scene.fluid is not None)


def solver_in_words(problem: Problem, unsymmetric: Sequence[str]) -> str:
    """Name of the direct solver of a problem, and the reason."""
    from ngwear.equilibrium.linear import has_pardiso

    if problem.symmetric:
        return f"LDLT, {'pardiso' if has_pardiso() else 'sparsecholesky'} (symmetric terms only)"
    name = "pardiso" if has_pardiso() else "umfpack"
    return f"LU, {name} (unsymmetric: {', '.join(unsymmetric)}; without, LDLT would keep half the factors)"


def _kept(scene: Scene, stage: Stage, pressing: Pressing) -> dict[str, float]:
    """Memory of data that effects store from step to step [MB], without the matrix."""
    from ngwear.explanation.contact_pressures import history_points
    from ngwear.explanation.effect_costs import MEGABYTE

    strokes, outline = len(scene.program.cycle), len(stage.body.contour)
    found = {}
    if scene.worn_edges:  # area over way, twice, and depth, of each contact and stroke; rates of the states
        sizes = 3 * strokes * len(scene.contacts) * outline + strokes * stage.problem.space.ndof
        found["wear"] = 8 * sizes / MEGABYTE
    folding = scene.folding
    if folding is not None:
        points = history_points(stage, pressing.states) if scene.arms is not None else 0
        found["memory"] = 8 * 4 * points * (len(folding.kept.times) + strokes) / MEGABYTE
    return found


def _deactivation_in_words(deactivation: Deactivation) -> str:
    distortion, damage, reach = deactivation.distortion, deactivation.damage, deactivation.reach
    parts = [f"layers {deactivation.depth:g} mm deep; surface nodes wear through them"]
    if distortion is not None:
        parts.append(f"distorted beyond a corner cosine of {distortion.corner_cosine:g}")
    if damage is not None:
        where = "" if reach is None else f" within {reach:g} mm of the contact"
        over = "" if damage.length is None else f", averaged over {damage.length:g} mm,"
        parts.append(f"torn where the {damage.name}{over} exceeds {damage.critical:g}{where}")
    return "; ".join(parts)


def _friction_in_words(scene: Scene, contact: Contact, law: FrictionLaw) -> str:
    words = f"{'stick and slip' if scene.may_stick(contact) else 'full sliding'}, {law.words}"
    if not isinstance(law, Constant):
        low, high = friction_range(scene, contact)
        met = f"{low:g}" if low == high else f"{low:g} to {high:g}"
        words += f"; mu = {met} over the program" + (" at p = 0" if law.depends_on_pressure else "")
    return f"{words}: {scene.why_it_may_stick(contact)}"


def _wear_in_words(scene: Scene, contact: Contact) -> str:
    rate, end = contact.wear_rate, scene.program.slid(scene.program.strokes)
    low, high = rate.curve.extremes(0.0, end)
    return f"by lubrication, {len(rate.distance)} rows; k = {low:g} to {high:g} mm²/N over the program"


def _memory_in_words(scene: Scene, folding: Folding) -> str:
    kept, fast, slow = len(folding.kept.times), len(folding.fast), len(folding.slow)
    rest = scene.program.rest
    before = f"mounted {rest:g} s before" if math.isfinite(rest) else "mounted and relaxed before"
    return f"{kept} arms kept; {fast} left out as always relaxed, {slow} added to the elastic part; {before}"


def _memory_numbers(scene: Scene) -> dict[str, float]:
    folding = scene.folding
    if folding is None:
        return {}
    step = min(stroke.duration for stroke in scene.program.cycle)
    return {
        "G0/G of the arms kept [-]": folding.kept.instantaneous,
        "elastic part over long-term stiffness [-]": folding.stiffening,
        "largest error of stress by arms left out [-]": folding.bound,
        "shortest stroke [s]": scene.program.parts * step,
        "shortest time step [s]": step,
        "all strokes [s]": scene.program.duration,
    }


def _arms(scene: Scene) -> dict[str, str] | None:
    """Each arm: its stiffness, Deborah numbers of the strokes, and whether it needs a memory."""
    prony, folding, arms = scene.part.prony, scene.folding, {}
    if prony is None or folding is None:
        return None
    for time, ratio in zip(prony.times, prony.ratios, strict=True):
        deborah = {f"{time / stroke.duration:.3g}": None for stroke in scene.program.cycle}
        arms[f"{time:.4g} s"] = f"G/G_inf = {ratio:.4g}, tau/D = {', '.join(deborah)}: {folding.fate(time)}"
    return arms
