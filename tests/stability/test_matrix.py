"""Every case of the stability matrix holds, or ends in its documented report."""

import pytest
from matrix import CASES


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.family}: {case.label}")
def test_holds_or_reports(case):
    case.judge()


def test_the_matrix_is_as_large_as_promised():
    assert len(CASES) >= 60
    assert len({(case.family, case.label) for case in CASES}) == len(CASES)
