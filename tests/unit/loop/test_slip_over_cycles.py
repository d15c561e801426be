"""What of a slip counts for all cycles of a jump."""

import numpy as np
import pytest

from ngwear.loop.slip_over_cycles import slip_per_cycle
from ngwear.loop.state import Phase
from ngwear.scene.program import Stroke

OUT, BACK = Stroke(name="out", travel=2.0), Stroke(name="back", travel=2.0, direction=-1)
OWN, OTHER = np.array([0.0, 0.2, 0.5]), np.array([0.1, 0.0, 0.4])
BOTH = [Phase(np.zeros(1), shares={"rod": OWN}), Phase(np.zeros(1), shares={"rod": OTHER})]


def test_what_one_stroke_slips_more_than_the_other_counts_once():
    assert slip_per_cycle((OUT, BACK), BOTH, 0, 10)["rod"] * 10 == pytest.approx([0.0, 0.2, 9 * 0.4 + 0.5])
    assert slip_per_cycle((OUT, BACK), BOTH, 1, 10)["rod"] * 10 == pytest.approx([0.1, 0.0, 10 * 0.4])


@pytest.mark.parametrize(
    ("cycle", "repeats"),
    [((OUT, BACK), 1), ((OUT, OUT), 10), ((OUT, Stroke(name="back", travel=1.0, direction=-1)), 10), ((OUT,), 10)],
)
def test_single_strokes_and_motions_that_do_not_come_back_are_taken_as_they_are(cycle, repeats):
    assert slip_per_cycle(cycle, BOTH, 0, repeats)["rod"].tolist() == OWN.tolist()


def test_nothing_is_known_of_a_contact_that_slides_or_of_a_new_mesh():
    assert slip_per_cycle((OUT, BACK), [Phase(np.zeros(1)), BOTH[1]], 0, 10) is None
    assert slip_per_cycle((OUT, BACK), [BOTH[0], Phase(np.zeros(1))], 0, 10)["rod"].tolist() == OWN.tolist()
