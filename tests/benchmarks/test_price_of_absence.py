"""A scene from which an effect was taken out is the scene that never had it: same unknowns, memory, modules, result.

The ratio of CPU times is printed, not judged; ``python tests/benchmarks/price_of_absence.py`` takes more rounds.
"""

import sys
from importlib.util import find_spec

import price_of_absence
import pytest


@pytest.fixture(scope="module")
def told():
    """Of scenes on coarse elements; which they are does not matter where all shall be equal to the last bit."""
    return price_of_absence.compare_facts(0.45)


@pytest.mark.slow
@pytest.mark.parametrize("effect", price_of_absence.QUICK)
def test_what_is_taken_out_leaves_nothing(effect, told):
    never, removed = told["never"][effect], told["removed"][effect]
    assert all(find_spec(f"ngwear.{module}") for module in price_of_absence.MODULES[effect]), "modules that there are"
    assert never["loaded"] == [], "modules of an effect that the scene never had"
    assert removed["absent"] == never["absent"], "unknowns, matrix entries, bytes, solver and result, to the last bit"
    assert removed["present"]["result"] != never["absent"]["result"], "the effect does something"


@pytest.mark.slow
@pytest.mark.parametrize("effect", price_of_absence.MODULES)
def test_what_is_taken_out_costs_nothing(effect, capsys):
    told, runs = price_of_absence.compare(effect, rounds=1)
    with capsys.disabled():
        sys.stdout.write(f"\n{price_of_absence.row(effect, told, runs)}\n")
    never, removed = told["never"], told["removed"]
    assert never["loaded"] == [], "modules of an effect that the scene never had"
    assert set(removed["loaded"]) <= set(price_of_absence.MODULES[effect])
    assert removed["absent"] == never["absent"], "unknowns, matrix entries, bytes, solver and result, to the last bit"
    assert {result for kind in price_of_absence.KINDS for *_, result in runs[kind]} == {never["absent"]["result"]}
    present = removed["present"]
    assert present["result"] != never["absent"]["result"], "the effect does something"


def test_what_effects_bring():
    """Unknowns by stick and slip alone; arms, a law of wear and a worn surface add none."""
    found = {e: price_of_absence.pair(e) for e in ("friction", "stick-slip", "memory", "law of wear")}
    from ngwear.loop.mounting import unworn_body
    from ngwear.loop.stage import Stage

    def unknowns(scene):
        return Stage(scene, unworn_body(scene)).problem.space.ndof

    more = {effect: unknowns(scene) - unknowns(bare) for effect, (scene, bare) in found.items()}
    assert more.pop("stick-slip") > 0
    assert set(more.values()) == {0}
