"""Read ``result.h5`` of a wear run."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import ResultError
from ngwear.files.hdf5 import get_series, name_of, require_layout
from ngwear.files.result_folder import FIELDS
from ngwear.results.surface_text import surfaces_of
from ngwear.surfaces import RigidSurface

Array = NDArray[np.float64]
WEAR_RATE = "specific wear rate [mm^2 per N]"  # attribute of a contact in the file
CONTACT, PART = "contact", "part"  # kind of a group of a stroke: a contact, or data of the part


@dataclass(frozen=True)
class Snapshot:
    """Outline and contact profiles at one solved stroke.

    ``stroke`` is the number of completed strokes, a fraction after a part of a stroke; ``time`` [s] is infinite without
    speeds. ``section`` (see ``ngwear.results.section``) and ``elements`` are empty unless saved at this stroke.
    """

    stroke: float
    kind: str
    outline: Array
    profiles: dict[str, dict[str, Array]]
    section: dict[str, NDArray[np.generic]] = field(default_factory=dict)
    elements: dict[str, NDArray[Any]] = field(default_factory=dict)
    time: float = math.inf


@dataclass(frozen=True)
class ResultFile:
    """Contents of ``result.h5``.

    Attributes
    ----------
    scene : str
    outline : array, shape (n, 2)
        Outline as given in the scene [mm].
    edges : tuple of str, length n
        Edge name of each segment of the outline.
    wear_rates : dict
        Specific wear rate k of each contact that wears, mean over the run [mm²/N].
    worn_edges : tuple of str
    has_memory : bool
        Whether the rubber has memory.
    laws_vary : bool
        Whether a law of friction or wear changes with the sliding distance.
    damage : tuple or None
        Name of the criterion that tears elements and its critical value; None without one.
    errors : dict of str to float
        Error estimates, as in ``summary.json``.
    series : dict of array
        Columns of ``series.csv``; row i belongs to snapshot i.
    snapshots : list of Snapshot
    surfaces : dict of str to RigidSurface
        Rigid surface of each contact in its final position, of the kinds that a file can hold.
    """

    scene: str
    outline: Array
    edges: tuple[str, ...]
    wear_rates: dict[str, float]
    worn_edges: tuple[str, ...]
    has_memory: bool
    laws_vary: bool
    damage: tuple[str, float] | None
    errors: dict[str, float]
    series: dict[str, Array]
    snapshots: list[Snapshot]
    surfaces: dict[str, RigidSurface] = field(default_factory=dict)

    @property
    def kinds(self) -> list[str]:
        """Names of the strokes of the cycle, in their order."""
        return list(dict.fromkeys(s.kind for s in self.snapshots))

    def at(self, stroke: float, kind: str) -> Snapshot:
        """The snapshot of a kind of stroke that is nearest to a stroke; the last of several."""
        mine = [s for s in self.snapshots if s.kind == kind]
        return min(reversed(mine), key=lambda s: abs(s.stroke - stroke))


def read_result(folder: Path | str) -> ResultFile:
    """Read a run's ``result.h5``.

    Raises
    ------
    ResultError
        If the file is missing, damaged, or of another layout.
    """
    import h5py

    file = Path(folder) / FIELDS
    if not file.is_file():
        raise ResultError(f"{file} does not exist: give the folder of a finished run (see ngwear run --out)")
    try:
        with h5py.File(file, "r") as h5:
            require_layout(h5, file)
            worn = {name_of(g): g.attrs for g in h5["contacts"].values() if g.attrs[WEAR_RATE] > 0}
            return ResultFile(
                scene=str(h5.attrs["scene"]),
                outline=h5["outline/points [mm]"][()],
                edges=tuple(h5["outline/edges"].asstr()[()]),
                wear_rates={name: float(attributes[WEAR_RATE]) for name, attributes in worn.items()},
                worn_edges=tuple(
                    dict.fromkeys(str(edge) for attributes in worn.values() for edge in attributes["edges"])
                ),
                has_memory=bool(h5.attrs.get("memory", False)),
                laws_vary=bool(h5.attrs.get("laws over distance", False)),
                damage=(
                    (str(h5.attrs["damage criterion"]), float(h5.attrs["critical damage"]))
                    if "damage criterion" in h5.attrs
                    else None
                ),
                errors=json.loads(h5.attrs.get("summary", "{}")).get("error estimates", {}),
                series=get_series(h5),
                snapshots=[_snapshot(group) for group in h5["strokes"].values()],
                surfaces=surfaces_of(h5),
            )
    except (OSError, KeyError, ValueError, AttributeError, TypeError, RuntimeError) as error:
        raise ResultError(f"{file} cannot be read as a result of ngwear: {error}") from error


def _snapshot(group: Any) -> Snapshot:
    """Read one stroke of the file."""
    found: dict[str, dict[str, dict[str, NDArray[Any]]]] = {CONTACT: {}, PART: {}}
    for item in group.values():
        if "holds" in item.attrs:
            content = {name_of(values): values[()] for values in item.values()}
            found[item.attrs["holds"]][name_of(item)] = content
    return Snapshot(
        stroke=group.attrs["stroke"].item(),
        kind=str(group.attrs["kind"]),
        outline=group["outline [mm]"][()],
        profiles=found[CONTACT],
        section=found[PART].get("section", {}),
        elements=found[PART].get("elements", {}),
        time=float(group.attrs.get("time [s]", math.inf)),
    )
