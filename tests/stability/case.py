"""One hard case: how to solve it, and what is expected of it."""

import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass

from physics import Finding

from ngwear.errors import NgwearError

HOLDS, REPORTS = "holds", "reports"


@dataclass(frozen=True)
class Case:
    """A row of the matrix.

    Attributes
    ----------
    family, label : str
        What is hard, and by how much.
    solve : callable
        Returns the findings; raises, or warns, where a report is due.
    reports : str
        Pattern of the documented report; without one the case has to hold.
    """

    family: str
    label: str
    solve: Callable[[], list[Finding]]
    reports: str = ""

    def judge(self) -> tuple[str, list[Finding]]:
        """Solve the case: ``"holds"`` or ``"reports"``, and its findings; AssertionError where neither is true."""
        findings, said_so = [], ""
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always", RuntimeWarning)
            try:
                findings = self.solve()
            except NgwearError as error:
                said_so = f"{type(error).__name__}: {error}"
        if said_so:
            assert self.reports, said_so
            assert re.search(self.reports, said_so, re.DOTALL), f"another report than the documented one: {said_so}"
            return REPORTS, []
        said = [str(w.message) for w in heard if issubclass(w.category, RuntimeWarning)]
        broken = [str(f) for f in findings if not f.holds]
        assert findings, "nothing was measured"
        assert not broken, "; ".join(broken)
        if self.reports:
            assert any(re.search(self.reports, text) for text in said), f"no report; said {said}"
            return REPORTS, findings
        assert not said, f"an unexpected warning: {said}"
        return HOLDS, findings
