"""Names, columns and the layout of ``result.h5``.

HDF5 reads a slash in a name as a path: "force x [N/mm]" is stored as "force x [N per mm]", and its attribute ``name``
holds the name of the column in ``series.csv``.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import ResultError
from ngwear.files.subnormal import without_subnormals
from ngwear.files.version import VERSION

MANY = 1000  # numbers; below, compression saves nothing: each chunk has an overhead
LAYOUT = 2  # 1: as ngwear 0.1 wrote it, slashes in names and no attribute "layout"


def write(file: IO[bytes], fill: Callable[[Any], None]) -> None:
    """Write an HDF5 file that ``fill`` fills. It is built in memory, because HDF5 crashes on a full disk."""
    import h5py

    memory = io.BytesIO()
    with h5py.File(memory, "w") as h5:
        fill(h5)
    file.write(memory.getbuffer())


def stored_name(name: str) -> str:
    """The name in the file, without characters that HDF5 does not allow."""
    kept = name.replace("/", " per ")
    return kept if kept.strip(".") else f"'{kept}'"


def name_of(item: Any) -> str:
    """Original name of a dataset or group."""
    return str(item.attrs.get("name", item.name.rsplit("/", 1)[-1]))


def put(group: Any, name: str, values: Any, *, compressed: bool = False) -> None:
    """Store values under a name; ``compressed`` applies to large arrays only."""
    stored = _free(group, stored_name(name))
    data = without_subnormals(np.asarray(values))
    how = {"compression": "gzip", "compression_opts": 4, "shuffle": True} if compressed and data.size >= MANY else {}
    _note(group.create_dataset(stored, data=data, **how), name, stored)


def subgroup(group: Any, name: str) -> Any:
    """Create a group within a group."""
    stored = _free(group, stored_name(name))
    made = group.create_group(stored)
    _note(made, name, stored)
    return made


def _free(group: Any, stored: str) -> str:
    while stored in group:
        stored += "'"
    return stored


def _note(item: Any, name: str, stored: str) -> None:
    if name != stored:
        item.attrs["name"] = name


def put_series(h5: Any, rows: list[dict[str, Any]]) -> None:
    """Write the columns of ``series.csv`` into an open HDF5 file."""
    import h5py

    group = h5.create_group("series")
    for column in rows[0] if rows else ():
        values = [row[column] for row in rows]
        put(group, column, np.array(values, dtype=h5py.string_dtype()) if isinstance(values[0], str) else values)


def get_series(h5: Any) -> dict[str, NDArray[Any]]:
    """Read the columns, by their names in ``series.csv``."""
    series = {name_of(item): item[()] for item in h5["series"].values()}
    return {name: values.astype(str) if values.dtype.kind in "OS" else values for name, values in series.items()}


def mark(h5: Any, scene: str) -> None:
    """Write ngwear version, layout and scene name into a file."""
    h5.attrs["ngwear"], h5.attrs["layout"], h5.attrs["scene"] = VERSION, LAYOUT, scene


def require_layout(h5: Any, file: Path) -> None:
    """Refuse a file of another layout.

    Raises
    ------
    ResultError
        If the layout differs; the message says the remedy.
    KeyError
        If the file is not of ngwear.
    """
    made_by, layout = str(h5.attrs["ngwear"]), int(h5.attrs.get("layout", 1))
    if layout != LAYOUT:
        raise ResultError(
            f"{file} has layout {layout}, written by ngwear {made_by}; this is ngwear {VERSION}, which reads "
            f"layout {LAYOUT}: run the scene again into another folder, or take ngwear {made_by}"
        )
