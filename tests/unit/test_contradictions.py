"""Effects that contradict each other are refused, with the place and a way out."""

import pytest

from ngwear.errors import SceneError
from ngwear.scenefile import read_scene

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
            r"'roller'\.friction.*stands still.*give a number",
        ),
        (
            (
                ("specific_wear_rate = 1.0e-3", "slides = false"),
                ("friction = 0.1", 'friction = { law = "lubrication", distance = [0, 9], coefficient = [0.1, 1] }'),
            ),
            r"'roller'\.friction.*stands still.*give a number",
        ),
        ((("strokes = 4", "strokes = 4\nrest = 60.0"),), r"program\.rest = 60\.0: only rubber with memory"),
        ((("specific_wear_rate = 1.0e-3", "counter_wear_rate = 1.0e-5"),), r"counter_wear_rate.*specific_wear_rate as"),
        ((("travel = 10.0", "travel = 10.0\npressure = 1.0"),), r"pressure = 1\.0: .*needs a \[fluid\] table"),
    ],
)
def test_contradictions_say_which_and_why(tmp_path, write_sheet, changes, message):
    with pytest.raises(SceneError, match=message):
        read_scene(write_sheet(tmp_path, *changes))
