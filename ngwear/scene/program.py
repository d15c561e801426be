"""The program of a scene: the strokes of a cycle, and the number of strokes."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, replace

from ngwear.errors import check_fields, require

PART = re.compile(r", part \d+ of \d+$")  # ending of the name of a part of a stroke


def whole_name(kind: str) -> str:
    """Name of the whole stroke, for a part of a stroke or for a whole one."""
    return PART.sub("", kind)


@dataclass(frozen=True)
class Stroke:
    """One stroke of the cycle.

    Parameters
    ----------
    name : str
    travel : float
        Sliding distance [mm], > 0.
    direction : float
        1 forward, -1 backward, along the tangent of the surface (its normal turned clockwise).
    pressure : float, or mapping of str to float
        Sealed pressure [MPa], >= 0; with several inlets (``Fluid.inlet``) that of each, by name, 0 if it is left out.
    speed : float or None
        Sliding speed [mm/s], > 0; needed for rubber with memory and for friction that depends on speed.
    """

    name: str
    _: KW_ONLY
    travel: float
    direction: float = 1.0
    pressure: float | Mapping[str, float] = 0.0
    speed: float | None = None

    def __post_init__(self) -> None:
        place = f"program.stroke '{self.name}'"
        check_fields(self, place)
        require(self.travel > 0, f"{place}.travel", self.travel, "must be greater than 0 mm")
        require(-1 <= self.direction <= 1, f"{place}.direction", self.direction, "must lie between -1 and 1")
        for pressure in self._pressures:
            require(pressure >= 0, f"{place}.pressure", self.pressure, "must be at least 0 MPa")
        require(self.speed is None or self.speed > 0, f"{place}.speed", self.speed, "must be greater than 0 mm/s")

    @property
    def _pressures(self) -> tuple[float, ...]:
        return tuple(self.pressure.values()) if isinstance(self.pressure, Mapping) else (self.pressure,)

    @property
    def highest_pressure(self) -> float:
        """Highest sealed pressure of the stroke [MPa]."""
        return max(self._pressures, default=0.0)

    def pressure_at(self, inlet: str) -> float:
        """Sealed pressure at an inlet [MPa]."""
        return self.pressure.get(inlet, 0.0) if isinstance(self.pressure, Mapping) else self.pressure

    @property
    def duration(self) -> float:
        """Duration of the stroke [s]; infinite without a speed."""
        return math.inf if self.speed is None else self.travel / self.speed


@dataclass(frozen=True, kw_only=True)
class Program:
    """Mounting, then the strokes of ``cycle`` in turn until ``strokes`` are completed.

    Parameters
    ----------
    cycle : sequence of Stroke
        Strokes as they are solved: each may be a part of a given stroke, see ``divided``.
    strokes : int
        Total number of these strokes.
    rest : float
        Time from mounting to the first stroke [s], > 0; default infinite: rubber with memory has relaxed.
    parts : int
        Number of these strokes that make one given stroke.
    """

    cycle: Sequence[Stroke]
    strokes: int
    rest: float = math.inf
    parts: int = 1

    def __post_init__(self) -> None:
        check_fields(self, "program")
        strokes = isinstance(self.cycle, Sequence) and all(isinstance(stroke, Stroke) for stroke in self.cycle)
        require(strokes, "program.stroke", self.cycle, "must be a list of strokes")
        object.__setattr__(self, "cycle", tuple(self.cycle))
        require(bool(self.cycle), "program.stroke", self.cycle, "give at least one stroke")
        require(self.strokes >= 0, "program.strokes", self.strokes, "must be at least 0")
        require(
            self.rest > 0, "program.rest", self.rest, "must be greater than 0 s; without rest the part relaxes fully"
        )

    def divided(self, parts: int) -> Program:
        """The same program with each given stroke divided into this number of equal parts."""
        if parts == self.parts:
            return self
        whole = [replace(s, name=whole_name(s.name), travel=self.parts * s.travel) for s in self.cycle[:: self.parts]]
        cycle = [
            replace(stroke, name=f"{stroke.name}, part {k + 1} of {parts}" if parts > 1 else stroke.name, travel=way)
            for stroke in whole
            for way in (stroke.travel / parts,)
            for k in range(parts)
        ]
        return replace(self, cycle=tuple(cycle), strokes=self.strokes // self.parts * parts, parts=parts)

    def counted(self, strokes: int) -> float:
        """Number of given strokes that are completed after this number of solved strokes; an int if it is whole."""
        full, more = divmod(strokes, self.parts)
        return full + more / self.parts if more else full

    @property
    def shortest_way(self) -> float:
        """Travel of the shortest given stroke [mm]."""
        return self.parts * min(stroke.travel for stroke in self.cycle)

    def slid(self, strokes: int) -> float:
        """Sliding distance after this number of solved strokes [mm]."""
        full, part = divmod(strokes, len(self.cycle))
        return full * sum(s.travel for s in self.cycle) + sum(s.travel for s in self.cycle[:part])

    @property
    def duration(self) -> float:
        """Duration of all strokes [s]."""
        return self.elapsed(self.strokes)

    def elapsed(self, strokes: int) -> float:
        """Time after this number of solved strokes [s]; infinite if one of them has no speed."""
        full, part = divmod(strokes, len(self.cycle))
        times = [stroke.duration for stroke in self.cycle]
        return (full * sum(times) if full else 0.0) + sum(times[:part])
