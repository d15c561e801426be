"""Effects that contradict each other are refused, with the place and a way out."""

import pytest

from ngwear.errors import SceneError
from ngwear.scene.read_scene import read_scene

FRICTIONLESS, WEARLESS = ("friction = 0.1\n", ""), ("specific_wear_rate = 1.0e-3\n", "")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ((FRICTIONLESS, ("force = 0.5", "force = 0.5\nsticks = true")), r"'roller'\.sticks = True: without friction"),
        ((FRICTIONLESS, ("force = 0.5", "force = 0.5\nsticks = false")), r"'roller'\.sticks = False: without friction"),
        (
            (WEARLESS, ("force = 0.5", 'force = 0.5\nwear_law = { law = "power", exponent = 2.0 }')),
            r"'roller'\.wear_law.*specific_wear_rate is 0",
        ),
        (
            (
                ("specific_wear_rate = 1.0e-3", "slides = false"),
                ("friction = 0.1", 'friction = { law = "stribeck", boundary = 1.0, full = 0.5, speed = 9.0 }'),
                ("travel = 10.0", "travel = 10.0\nspeed = 1.0"),
            ),
            r"'roller'\.friction.*does not slide.*give a number",
        ),
        (
            (
                ("specific_wear_rate = 1.0e-3", "slides = false"),
                ("friction = 0.1", 'friction = { law = "lubrication", distance = [0, 9], coefficient = [0.1, 1] }'),
            ),
            r"'roller'\.friction.*does not slide.*give a number",
        ),
        ((("strokes = 4", "strokes = 4\nrest = 60.0"),), r"program\.rest = 60\.0: only rubber with memory"),
        ((("specific_wear_rate = 1.0e-3", "counter_wear_rate = 1.0e-5"),), r"counter_wear_rate.*specific_wear_rate as"),
        ((("travel = 10.0", "travel = 10.0\npressure = 1.0"),), r"pressure = 1\.0: .*needs a \[fluid\] table"),
    ],
)
def test_contradictions_say_which_and_why(tmp_path, write_sheet, changes, message):
    with pytest.raises(SceneError, match=message):
        read_scene(write_sheet(tmp_path, *changes))


STICKS, DEACTIVATES = ("force = 0.5", "force = 0.5\nsticks = true"), ("[wear]", "[deactivation]\ndepth = 0.3\n\n[wear]")


@pytest.mark.parametrize(
    ("order", "changes", "message"),
    [
        (1, (STICKS,), r"accuracy\.order = 1: must be 2 or 3 where friction may stick, as in contact 'roller'"),
        (3, (DEACTIVATES, ('step = "each"', 'step = "each"\nremesh = "never"')), r"order = 3: .* deactivates elements"),
        (4, (), r"accuracy\.order = 4: must be one of \[1, 2, 3\]"),
    ],
)
def test_orders_that_an_effect_cannot_have_are_refused(tmp_path, write_sheet, order, changes, message):
    with pytest.raises(SceneError, match=message):
        read_scene(write_sheet(tmp_path, *changes, ("[accuracy]", f"[accuracy]\norder = {order}")))


def test_other_orders_are_taken(tmp_path, write_sheet):
    assert read_scene(write_sheet(tmp_path / "1", ("[accuracy]", "[accuracy]\norder = 1"))).accuracy.order == 1
    sticking = write_sheet(tmp_path / "3", STICKS, ("[accuracy]", "[accuracy]\norder = 3"))
    assert read_scene(sticking).accuracy.order == 3
