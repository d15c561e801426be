"""What a scene simulates, what it leaves out, and the numbers that tell whether that matters."""

from __future__ import annotations

from typing import Any

from ngwear.scene import Scene
from ngwear.wear.archard import critical_distance


def explain(scene: Scene) -> dict[str, Any]:
    """Describe a scene: effects, unknowns on the mounting mesh, solver, dimensionless numbers.

    Raises
    ------
    MeshError
        If the section cannot be meshed.
    """
    from ngwear.equilibrium.linear import has_pardiso
    from ngwear.geometry.body import Body
    from ngwear.refinement import mounting_field
    from ngwear.stage import Stage

    stage = Stage(scene, Body(scene.contour, mounting_field(scene)))
    problem, material = stage.problem, scene.material
    rate = max((c.specific_wear_rate for c in scene.contacts), default=0.0)
    critical = critical_distance(scene.accuracy.patch, rate, material.plane_strain_modulus)
    travel = max(s.travel for s in scene.program.cycle)
    present = {"hyperelasticity": type(material).__name__}
    present |= {f"contact '{c.name}'": f"edges {', '.join(c.edges)}" for c in scene.contacts}
    present |= {
        f"friction at '{c.name}'": f"full sliding, mu = {c.friction:g}: every stroke is longer than the elastic slip"
        for c in scene.contacts
        if c.friction > 0
    }
    if scene.fluid is not None:
        present["fluid pressure"] = f"from {', '.join(scene.fluid.inlet)} to the first point in contact"
    if rate > 0:
        present["wear"] = f"Archard, {scene.wear.scheme}, step '{scene.wear.step}'"
    return {
        "scene": scene.name,
        "kind": "axisymmetric" if scene.axisymmetric else "plane strain",
        "effects": present,
        "left out": ["viscosity", "stick-slip", "heat", "adhesion", "inertia", "fluid film"],
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
        },
    }
