"""One verb: run cases and hand back their checks."""

from __future__ import annotations

from pathlib import Path

from ngwear.verify import checks_of, chosen
from ngwear.verify.base import Check


class Checks(list[Check]):
    """Checks of one or more cases; printed, one line each."""

    def __str__(self) -> str:
        return "\n".join(str(check) for check in self)

    @property
    def passed(self) -> bool:
        """Whether all of them have passed."""
        return all(check.passed for check in self)


def verify(*cases: str, out: Path | str | None = None) -> Checks:
    """Compare with references that others derived.

    Parameters
    ----------
    *cases : str
        Their names; without any, those that together take about a minute.
    out : path or None
        Folder in which cases that take hours keep their runs, to go on with.

    Raises
    ------
    SceneError
        For a name that is no case.
    """
    folder = None if out is None else Path(out)
    return Checks(check for name in chosen(cases or None) for check in checks_of(name, folder))
