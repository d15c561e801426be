"""Every case of the stability matrix holds, or ends in its documented report."""

import pytest
from matrix import CASES

PARAMETERS = [
    pytest.param(
        case,
        id=f"{case.family}: {case.label}",
        marks=[pytest.mark.xfail(reason=case.fails, strict=True, raises=AssertionError)] if case.fails else [],
    )
    for case in CASES
]


@pytest.mark.parametrize("case", PARAMETERS)
def test_holds_or_reports(case):
    case.judge()


def test_the_matrix_is_as_large_as_promised():
    assert len(CASES) >= 60
    assert len({(case.family, case.label) for case in CASES}) == len(CASES)
