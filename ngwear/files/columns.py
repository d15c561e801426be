"""Named columns of numbers from CSV files."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import SceneError

Array = NDArray[np.float64]


def read_columns(path: Path | str, needed: Sequence[str], one_of: Sequence[str] = ()) -> dict[str, Array]:
    """Read the columns ``needed`` and at least one of ``one_of``; lines that begin with # are skipped.

    Raises
    ------
    SceneError
        If the file or a column is missing, or a value is not a number.
    """
    path = Path(path)
    if not path.is_file():
        raise SceneError("file", str(path), "there is no such file")
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise SceneError("file", str(path), f"cannot be read as a table of text: {error}") from None
    columns = {(name or "").strip() for name in rows[0]} if rows else set()
    missing = [name for name in needed if name not in columns]
    if one_of and not columns & set(one_of):
        missing.append(" or ".join(one_of))
    if missing:
        raise SceneError(str(path), sorted(columns), f"columns missing: {missing}; name them with their units")
    table: dict[str, Array] = {}
    for name in columns & {*needed, *one_of}:
        values = []
        for number, row in enumerate(rows, start=2):
            text = next(v for k, v in row.items() if (k or "").strip() == name)
            try:
                values.append(float(text))
            except (TypeError, ValueError):
                raise SceneError(f"{path}, line {number}, {name}", text, "must be a number (decimal point)") from None
        table[name] = np.array(values)
    return table
