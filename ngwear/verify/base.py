"""What a verification case hands back: numbers beside their references."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any, Literal

Bound = Literal["near", "below", "above"]
BAND: tuple[tuple[float, Bound], ...] = ((0.5, "above"), (3.0, "below"))  # what is stated over what is true


@dataclass(frozen=True)
class Check:
    """One computed quantity beside its reference.

    Parameters
    ----------
    case, quantity : str
        The quantity's name carries its unit: ``"peak pressure [MPa]"``.
    value, reference : float
    tolerance : float
        Largest accepted error; a bound is met without one.
    cpu_seconds : float
        Processor time of the computation that the value comes from, imports left out; checks that share a
        solution share it.
    absolute : bool
        Take the error as a difference instead of relative to the reference.
    bound : {"near", "below", "above"}
        Whether the value shall equal the reference, or at most or at least reach it.
    """

    case: str
    quantity: str
    value: float
    reference: float
    tolerance: float
    cpu_seconds: float
    absolute: bool = False
    bound: Bound = "near"

    @property
    def error(self) -> float:
        """Distance from the reference, relative unless ``absolute`` or the reference is 0; 0 where a bound is met."""
        off = self.value - self.reference
        if self.bound == "above":
            off = -off
        if self.bound == "near":
            off = abs(off)
        elif off <= 0:
            return 0.0
        return off if self.absolute or self.reference == 0 else off / abs(self.reference)

    @property
    def passed(self) -> bool:
        """Whether the error is within the tolerance, or the bound is met; never for a value that is not a number."""
        return bool(self.error <= (self.tolerance if self.bound == "near" else 0.0))

    def __str__(self) -> str:
        wanted = f"at {'most' if self.bound == 'below' else 'least'} {self.reference:.6g}"
        if self.bound == "near":
            wanted = f"reference {self.reference:<12.6g} error {self.error:.2g} (tolerance {self.tolerance:.2g})"
        return f"{'ok  ' if self.passed else 'FAIL'} {self.case:14s} {self.quantity:60s} {self.value:<12.6g} {wanted}"

    def as_dict(self) -> dict[str, Any]:
        """What a report or a file needs, in plain types."""
        return {
            "case": self.case,
            "quantity": self.quantity,
            "value": float(self.value),
            "reference": float(self.reference),
            "error": float(self.error),
            "tolerance": float(self.tolerance) if self.bound == "near" else 0.0,
            "passed": self.passed,
            "cpu_seconds": round(float(self.cpu_seconds), 3),
        }


class Checks(list[Check]):
    """Checks of one or more cases; printed, one line each."""

    def __str__(self) -> str:
        return "\n".join(map(str, self))

    @property
    def passed(self) -> bool:
        """Whether all of them have passed."""
        return all(check.passed for check in self)


class Stopwatch:
    """Processor time of this process since the last start [s]."""

    def __init__(self) -> None:
        self.start()

    def start(self) -> None:
        """Begin anew."""
        self._since = time.process_time()

    @property
    def seconds(self) -> float:
        """Processor time since the start [s]."""
        return time.process_time() - self._since
