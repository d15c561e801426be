"""Ladder: the values of one parameter from coarse to fine; and the measurement of a run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from ngwear.files.result_folder import COMPLETED

STOPPED = "stopped"
Setting = tuple[int, ...]  # level on each ladder


@dataclass(frozen=True, kw_only=True)
class Ladder:
    """Values of one parameter that trades computing time for error, from coarse to fine.

    Parameters
    ----------
    name : str
        Name, such as ``"element edge"``.
    column : str
        Name and unit, such as ``"element edge [mm]"``.
    values : tuple of float
        Decreasing. 0 means without this error, such as each stroke solved.
    labels : tuple of str
        Each value as text, such as ``"0.05 mm"``.
    own : int
        Level of the scene.
    growth : float
        First guess of p in ``seconds ~ value^-p``, until it is measured.
    most_solves : int
        Number of solves with a value of 0; 0 if the parameter does not change it.
    smooth : bool
        Whether the error is expected to be a power of the value.
    remaining : float
        Error of the finest run over its difference from the one before, if no order is observed [-].
    """

    name: str
    column: str
    values: tuple[float, ...]
    labels: tuple[str, ...]
    own: int
    cost_exponent: float
    most_solves: int = 0
    smooth: bool = True
    remaining: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Measurement:
    """Results, time and memory of one run.

    Attributes
    ----------
    status : str
        ``"completed"``, ``"gave up"``, or ``"stopped"`` for lack of time.
    message : str
        Why it gave up or was stopped.
    values : mapping of str to float
        Main results, by name and unit.
    cpu, wall : float
        CPU and wall time of the process from its start [s].
    memory : float
        Peak memory of the process [MB].
    solves : int
    needed : float
        Estimated wall time of the whole run if it was stopped [s]; nan if not known.
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
        """Whether the run was completed."""
        return self.status == COMPLETED


def with_level(base: Setting, ladder: int, level: int) -> Setting:
    """The base setting with another level on one ladder."""
    return (*base[:ladder], level, *base[ladder + 1 :])


def labels_of(ladders: tuple[Ladder, ...], setting: Setting) -> dict[str, str]:
    """Labels of a setting by the names of the ladders."""
    return {ladder.name: ladder.labels[i] for ladder, i in zip(ladders, setting, strict=True)}
