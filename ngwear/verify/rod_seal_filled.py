"""The rod seal of a rubber that remembers, 200 strokes, against the elastic one of the same long-term stiffness.

geometries/rod_seal/scene_filled.toml: the arms of ``ngwear.materials.library.filled_rubber`` (representative, not
measured), 20 mm/s; the part has relaxed on the rod before the first stroke. Memory shall cost at most twice the work,
counted in solves and Newton iterations, and keep all books: forces in balance with the arms' stresses, area with the
law. What it changes in worn depth is small where both strokes wear: an arm that is slow against a stroke carries
``gamma (S - mean of S)``, which over the strokes of a cycle adds up to nothing; a fast one has relaxed. The leftmost
ridge touches in the pressurised stroke only, and the stiffer rubber gives way to the pressure less: it wears half as
much. These are comparisons, not references: their tolerances are bands.
"""

from __future__ import annotations

from ngwear.loop.result import Result
from ngwear.loop.run import run as run_scene
from ngwear.results.recorder import depths
from ngwear.verify.base import Bound, Check, Stopwatch
from ngwear.verify.rod_seal import imbalance, run_and_watch, shipped_scene

CASE = "rod_seal_filled"
LEFTMOST = 1.02  # mm: between the first two ridges


def _leftmost(result: Result) -> float:
    """Depth of the ridge farthest to the left [mm]."""
    before = result.records.scene.part.outline
    return float(depths(before, result.end.contour)[before.points[:, 0] < LEFTMOST].max())


def run() -> list[Check]:
    """Run both scenes."""
    watch = Stopwatch()
    scene = shipped_scene("scene_filled.toml")
    result, first = run_and_watch(scene)
    other = run_scene(shipped_scene())
    found, elastic = result.summary, other.summary
    seconds = watch.seconds
    ridge = _leftmost(result) / _leftmost(other)
    errors = found["error estimates"]
    balance = max(imbalance(r.forces) for r in (*first, *result.end.reports))
    peak = "last outward rod peak pressure [MPa]"

    def check(quantity: str, value: float, reference: float, tolerance: float = 0.0, bound: Bound = "near") -> Check:
        return Check(CASE, quantity, value, reference, tolerance, seconds, bound=bound)

    return [
        check("strokes done [-]", found["strokes"], 200),
        check("solves over the elastic run's [-]", found["solves"] / elastic["solves"], 2.0, bound="below"),
        check(
            "Newton iterations over the elastic run's [-]",
            found["Newton iterations"] / elastic["Newton iterations"],
            2.0,
            bound="below",
        ),
        check("lip depth over the elastic one [-]", found["lip depth [mm]"] / elastic["lip depth [mm]"], 1.0, 0.03),
        check("leftmost ridge's depth over the elastic one [-]", ridge, 0.5, 0.3),
        check("last outward peak pressure over the elastic one [-]", found[peak] / elastic[peak], 1.0, 0.05),
        check("area removed against the law [-]", errors["area against the law [-]"], 0.0, 1e-3),
        check("area changed by a remesh [-]", errors["area in a remesh [-]"], 0.0, 1e-6),
        check("sum of all forces over the largest [-]", balance, 0.0, 1e-6),
        check("strokes in which the seal leaks [-]", sum(r["leaks [-]"] for r in result.records.rows), 0),
    ]
