"""A folder of results whose files are replaced as a whole, so that a kill leaves the last good ones."""

from __future__ import annotations

import csv
import io
import os
import resource
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import ResultError

SERIES, FIELDS, SUMMARY, CHECKPOINT = "series.csv", "result.h5", "summary.json", "checkpoint.pkl"
COMPLETED, GAVE_UP = "completed", "gave up"


class OutFolder:
    """A run's folder.

    Parameters
    ----------
    path : Path
    begun : str
        Name of what stands in it once a run has begun.
    resume : bool
        Whether a run that has begun may go on.

    Raises
    ------
    ResultError
        If the folder holds another run, cannot be written, or the disk is full.
    """

    def __init__(self, path: Path, begun: str, *, resume: bool) -> None:
        self.path = Path(path)
        if self.path.exists() and not self.path.is_dir():
            raise ResultError(f"{self.path} is a file; give a folder for the results")
        if not resume and (self.path / begun).exists():
            raise ResultError(f"{self.path} already holds a run: go on with --resume, or give another folder")
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ResultError(f"{self.path} cannot be made: {error.strerror}") from error
        if not os.access(self.path, os.W_OK):
            raise ResultError(f"{self.path} cannot be written to: no permission")

    def replace(self, name: str, write: Callable[[IO[bytes]], Any]) -> None:
        """Write a file beside the old one, then put it in its place."""
        try:
            with tempfile.NamedTemporaryFile(dir=self.path, prefix=f".{name}.", delete=False) as file:
                temporary = Path(file.name)
                try:
                    write(file)
                    file.flush()
                    os.fsync(file.fileno())
                except BaseException:
                    temporary.unlink(missing_ok=True)
                    raise
            temporary.replace(self.path / name)
        except OSError as error:
            raise ResultError(
                f"{self.path / name} cannot be written: {error.strerror or error}; the last saved state is kept: "
                "free some space or permission and go on with --resume"
            ) from error

    def write_series(self, rows: list[dict[str, Any]]) -> None:
        """One line a row, columns named ``"quantity [unit]"``."""
        text = io.StringIO()
        if rows:
            writer = csv.DictWriter(text, fieldnames=list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        self.replace(SERIES, lambda file: file.write(text.getvalue().encode()))

    def clear(self) -> None:
        """Clear away what a kill has left half-written."""
        for left in self.path.glob(".*.*"):
            if left.name.startswith(tuple(f".{name}." for name in (SERIES, FIELDS, SUMMARY, CHECKPOINT))):
                left.unlink(missing_ok=True)


def peak_memory() -> float:
    """Peak resident memory of this process [MB]; on Linux its own, without what the one before it has left."""
    status = Path("/proc/self/status")
    if status.exists():
        own = [line.split()[1] for line in status.read_text().splitlines() if line.startswith("VmHWM:")]
        if own:
            return int(own[0]) / 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def put_series(h5: Any, rows: list[dict[str, Any]]) -> None:
    """Write the columns of ``series.csv`` into an open HDF5 file."""
    import h5py

    group = h5.create_group("series")
    for column in rows[0] if rows else ():
        values = [row[column] for row in rows]
        group[column] = np.array(values, dtype=h5py.string_dtype()) if isinstance(values[0], str) else values


def get_series(h5: Any) -> dict[str, NDArray[Any]]:
    """The columns again. One such as "force x [N/mm]" holds a slash, which HDF5 reads as a path."""
    series: dict[str, NDArray[Any]] = {}

    def take(name: str, item: Any) -> None:
        if hasattr(item, "dtype"):
            values = item[()]
            series[name] = values.astype(str) if values.dtype.kind in "OS" else values

    h5["series"].visititems(take)
    return series
