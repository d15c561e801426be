"""A scene from which an effect was taken out is the scene that never had it: same unknowns, memory, calls and result.

CPU times scatter; ``python tests/benchmarks/price_of_absence.py`` measures them.
"""

import price_of_absence
import pytest


@pytest.mark.parametrize("effect", price_of_absence.MODULES)
def test_what_is_taken_out_costs_nothing(effect):
    told, _ = price_of_absence.compare(effect, rounds=0)
    never, removed = told["never"], told["removed"]
    assert never["loaded"] == [], "modules of an effect that the scene never had"
    assert set(removed["loaded"]) <= set(price_of_absence.MODULES[effect])
    assert removed["absent"] == never["absent"], "unknowns, matrix entries, bytes, solver, result by its bits, calls"
    present = removed["present"]
    assert present["result"] != never["absent"]["result"], "the effect does something"


def test_what_effects_bring():
    """Unknowns by stick and slip alone; arms, a law of wear and a worn surface add none."""
    found = {e: price_of_absence.pair(e) for e in ("friction", "stick-slip", "memory", "law of wear")}
    from ngwear.mounting import unworn_body
    from ngwear.stage import Stage

    def unknowns(scene):
        return Stage(scene, unworn_body(scene)).problem.space.ndof

    more = {effect: unknowns(scene) - unknowns(bare) for effect, (scene, bare) in found.items()}
    assert more.pop("stick-slip") > 0
    assert set(more.values()) == {0}
