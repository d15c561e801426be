"""Every quick case against its reference, and the checks themselves."""

import subprocess
import sys
from dataclasses import replace
from functools import partial
from importlib.util import find_spec

import pytest

from ngwear.errors import SceneError
from ngwear.loop.run import run as run_scene
from ngwear.verify import ALL, CASES, QUICK, checks_of, chosen, listing, no_loss, torn_seal, verify
from ngwear.verify.base import Check

SHORT = (  # what is quick and protects most; the others of ``ngwear verify`` without names take a minute
    "tangents",
    "locking",
    "hertz",
    "p1a",
    "ring",
    "leak_pressure",
    "lost_elements",
)
SLOW = tuple(case for case in CASES if case not in SHORT)
# Missed, with the reason in the case's docstring; a check that comes to pass must leave this list.
MISSED = {
    "o_ring_squeeze": {"force, squeeze 10%, Lindley [N/mm]"},
    "hunter_transient": {"relative error of the direct solve, at most that in time, at 200 mm/s [-]"},
}


@pytest.mark.parametrize("case", [*SHORT, *(pytest.param(case, marks=pytest.mark.slow) for case in SLOW)])
def test_case_meets_its_reference(case):
    checks = verify(case)
    told = {
        c.quantity: f"{c.value:.8g}, {c.bound} {c.reference:.8g} wanted, error {c.error:.2e} above {c.tolerance:.1e}"
        for c in checks
        if not c.passed
    }
    assert checks, f"{case} checks nothing"
    assert set(told) == MISSED.get(case, set()), f"{case}: {told}"


def test_an_hour_of_the_torn_seal_goes_on_after_a_kill(tmp_path, monkeypatch):
    scene = no_loss.scene("implicit")
    monkeypatch.setattr(torn_seal, "_scene", lambda name: replace(scene, program=replace(scene.program, strokes=4)))
    monkeypatch.setattr(torn_seal, "sweep", lambda hour, names: [hour(name) for name in names])

    def kill(state):
        if state.strokes == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(torn_seal, "run_scene", partial(run_scene, on_step=kill))
    with pytest.raises(KeyboardInterrupt):
        list(checks_of("torn_seal", tmp_path))
    strokes = []
    monkeypatch.setattr(torn_seal, "run_scene", partial(run_scene, on_step=lambda state: strokes.append(state.strokes)))
    (place,) = (tmp_path / "torn_seal").iterdir()
    torn_seal._hour(place.parent, place.name)
    assert strokes == [4]


def test_unknown_case_is_refused_and_the_known_ones_named():
    with pytest.raises(SceneError, match=r"lame.*known: all, .*hertz.*ring"):
        verify("ring", "lame")


def test_without_names_a_minute_is_chosen_and_all_by_one_word():
    assert chosen() == list(QUICK)
    assert chosen([ALL]) == chosen(["hertz", ALL]) == list(CASES)
    assert chosen(["ring", "hertz"]) == ["ring", "hertz"]
    assert 30.0 < sum(CASES[name].seconds for name in QUICK) < 75.0
    assert not set(QUICK) & set(MISSED), "what is chosen for everybody passes"
    assert all(find_spec(case.module) for case in CASES.values())


def test_the_listing_tells_seconds_and_what_is_compared():
    lines = listing()
    assert [line.split()[0] for line in lines if line.startswith("  ")] == sorted(CASES, key=lambda n: n not in QUICK)
    assert all(case.compares and (case.seconds > 0 or not case.quick) for case in CASES.values())
    assert max(map(len, lines)) <= 120


def test_listing_the_cases_loads_no_solver():
    code = "import sys, ngwear.verify as v; sys.exit(not v.CASES or 'ngsolve' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


@pytest.mark.parametrize(
    ("value", "reference", "options", "error", "passed"),
    [
        (101.0, 100.0, {}, 0.01, True),
        (103.0, 100.0, {}, 0.03, False),
        (101.0, 100.0, {"absolute": True}, 1.0, False),
        (0.01, 0.0, {}, 0.01, True),
        (float("nan"), 1.0, {}, None, False),
        (2.9, 2.8, {"bound": "above"}, 0.0, True),
        (2.79, 2.8, {"bound": "above"}, 0.01 / 2.8, False),
        (float("nan"), 2.8, {"bound": "above"}, None, False),
        (2.7, 2.8, {"bound": "below"}, 0.0, True),
        (2.81, 2.8, {"bound": "below"}, 0.01 / 2.8, False),
    ],
)
def test_check_measures_its_error(value, reference, options, error, passed):
    check = Check("case", "quantity [-]", value, reference, 0.02, 0.0, **options)
    assert check.passed is passed
    assert check.as_dict()["passed"] is passed
    if error is not None:
        assert check.error == pytest.approx(error)
