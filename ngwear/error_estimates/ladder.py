"""Ladders of settings, and what a run on one of their rungs found."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from ngwear.files.result_folder import COMPLETED

STOPPED = "stopped"
Setting = tuple[int, ...]  # a rung of each ladder


@dataclass(frozen=True, kw_only=True)
class Ladder:
    """One knob that trades time for error, from coarse to fine.

    Parameters
    ----------
    name : str
        In words, such as ``"element edge"``.
    column : str
        Name and unit, such as ``"element edge [mm]"``.
    values : tuple of float
        Falling. 0 stands for a setting without this error at all, such as each stroke solved.
    labels : tuple of str
        Each value in words, such as ``"0.05 mm"``.
    own : int
        The scene's rung.
    growth : float
        A first guess of p in ``seconds ~ value^-p``, until there are measured ones.
    most_solves : int
        Solves that a value of 0 takes; 0 if it changes nothing about their number.
    smooth : bool
        Whether an error that falls by a power of the value can be expected.
    remaining : float
        What the finest run errs by over its difference from the one before, where no order shows.
    """

    name: str
    column: str
    values: tuple[float, ...]
    labels: tuple[str, ...]
    own: int
    growth: float
    most_solves: int = 0
    smooth: bool = True
    remaining: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Measurement:
    """What one run found and took.

    Attributes
    ----------
    status : str
        ``"completed"``, ``"gave up"``, or ``"stopped"`` for lack of time.
    message : str
        Why it gave up or was stopped.
    values : mapping of str to float
        What users read, by name and unit.
    cpu, wall : float
        Seconds of the process from its start.
    memory : float
        Its peak [MB].
    solves : int
    needed : float
        About how many seconds it would have taken, if it was stopped; nan if not even that is known.
    """

    status: str
    message: str = ""
    values: Mapping[str, float] = field(default_factory=dict)
    cpu: float = 0.0
    wall: float = 0.0
    memory: float = 0.0
    solves: int = 0
    needed: float = math.nan

    @property
    def ok(self) -> bool:
        """Whether the run reached its end."""
        return self.status == COMPLETED


def rung_of(base: Setting, ladder: int, rung: int) -> Setting:
    """The base with another rung of one ladder."""
    return (*base[:ladder], rung, *base[ladder + 1 :])


def told(ladders: tuple[Ladder, ...], setting: Setting) -> dict[str, str]:
    """A setting in words, by the ladders' names."""
    return {ladder.name: ladder.labels[i] for ladder, i in zip(ladders, setting, strict=True)}
