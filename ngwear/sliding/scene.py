"""A pin on a plate at several speeds, as plain frozen data."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from ngwear.errors import SceneError
from ngwear.sliding.pin import Pin, PinMesh


@dataclass(frozen=True, kw_only=True)
class PinScene:
    """What ``ngwear run`` needs to slide a pin on a plate.

    Parameters
    ----------
    name : str
    pin : Pin
    speeds : tuple of float
        [mm/s], each > 0.
    mesh : PinMesh
    vtk : bool
        Whether the deformed sheet is written for ParaView, one file a speed.

    Raises
    ------
    SceneError
        For a speed that is not positive or given twice, or rubber without memory.
    """

    name: str
    pin: Pin
    speeds: tuple[float, ...]
    mesh: PinMesh = field(default_factory=PinMesh)
    vtk: bool = False

    def __post_init__(self) -> None:
        if not self.speeds:
            raise SceneError("program.speeds", self.speeds, "give at least one speed")
        for i, speed in enumerate(self.speeds):
            if not 0 < speed < math.inf:
                raise SceneError(f"program.speeds[{i}]", speed, "steady sliding needs a speed above 0 mm/s")
            if speed in self.speeds[:i]:
                raise SceneError(f"program.speeds[{i}]", speed, "is given twice")
        if self.pin.series is None:
            raise SceneError("material.prony", None, "is missing: without memory friction does not depend on speed")
