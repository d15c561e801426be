"""Result folder; its files are replaced as a whole, so that an interruption leaves complete files."""

from __future__ import annotations

import csv
import io
import json
import os
import secrets
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

from ngwear.errors import ResultError
from ngwear.files.subnormal import without_subnormals
from ngwear.files.version import VERSION

SERIES, FIELDS, SUMMARY, CHECKPOINT = "series.csv", "result.h5", "summary.json", "checkpoint.npz"
OLD_CHECKPOINT = "checkpoint.pkl"  # of ngwear 0.1; not read, because a pickle can run any program
COMPLETED, GAVE_UP = "completed", "gave up"


class OutFolder:
    """The folder of a run.

    Parameters
    ----------
    path : Path
    begun : str
        Name of the file that shows that the folder holds a run.
    resume : bool
        Whether a run in the folder may be continued.

    Raises
    ------
    ResultError
        If the folder holds another run, or one of an older ngwear, cannot be written, or the disk is full.
    """

    def __init__(self, path: Path, begun: str, *, resume: bool) -> None:
        self.path = Path(path)
        if self.path.exists() and not self.path.is_dir():
            raise ResultError(f"{self.path} is a file; give a folder for the results")
        if begun == CHECKPOINT and (self.path / OLD_CHECKPOINT).exists():
            raise ResultError(
                f"{self.path} holds a run of ngwear 0.1 ({OLD_CHECKPOINT}); this is ngwear {VERSION}, which cannot "
                "continue it: run the scene again in another folder, or finish it with ngwear 0.1"
            )
        if not resume and (self.path / begun).exists():
            raise ResultError(f"{self.path} already holds a run: continue it with --resume, or give another folder")
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ResultError(f"{self.path} cannot be made: {error.strerror}") from error
        if not os.access(self.path, os.W_OK):
            raise ResultError(f"{self.path} cannot be written to: no permission")

    def replace(self, name: str, write: Callable[[IO[bytes]], Any]) -> None:
        """Write a temporary file, then replace the old one."""
        temporary = self.path / f".{name}.{secrets.token_hex(4)}"
        try:
            try:
                with temporary.open("x+b") as file:
                    write(file)
                    file.flush()
                    os.fsync(file.fileno())
                temporary.replace(self.path / name)
            except BaseException:
                temporary.unlink(missing_ok=True)
                raise
        except OSError as error:
            raise ResultError(
                f"{self.path / name} cannot be written: {error.strerror or error}; the last saved state is kept: "
                "free some disk space or correct the permission, then continue with --resume"
            ) from error

    def write_series(self, rows: list[dict[str, Any]]) -> None:
        """Write ``series.csv``: one line for each row, columns named ``"quantity [unit]"``."""
        self.write_table(SERIES, rows)

    def write_table(self, name: str, rows: list[dict[str, Any]]) -> None:
        """Write a CSV file: one line for each row; the keys of the first row are the columns."""
        text = io.StringIO()
        if rows:
            writer = csv.DictWriter(text, fieldnames=list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(without_subnormals(row) for row in rows)
        self.replace(name, lambda file: file.write(text.getvalue().encode()))

    def write_json(self, name: str, content: Any) -> None:
        """Write numbers, text, lists and dicts as JSON."""
        text = json.dumps(without_subnormals(content), indent=2) + "\n"
        self.replace(name, lambda file: file.write(text.encode()))

    def clear(self) -> None:
        """Remove temporary files of an interrupted process."""
        for left in self.path.glob(".*.*"):
            if left.name.startswith(tuple(f".{name}." for name in (SERIES, FIELDS, SUMMARY, CHECKPOINT))):
                left.unlink(missing_ok=True)
