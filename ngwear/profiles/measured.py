"""A profilometer's table, read from a CSV file and checked."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import SceneError

Array = NDArray[np.float64]
UNITS = {"mm": 1.0, "µm": 1e-3, "μm": 1e-3, "um": 1e-3}  # micro sign and Greek mu
FEWEST = 20  # points: five for each of the four numbers that are fitted
LARGEST_HOLE = 0.1  # of the profile's length, beyond which a note says so: areas may then err by as much
WRONG_UNIT = 1000**0.5  # beyond, a ratio is nearer to 1000 than to 1


@dataclass(frozen=True)
class Profile:
    """Heights along a line on the surface.

    Parameters
    ----------
    x : array, shape (n,)
        Place along the line [mm], rising; where it begins does not matter.
    z : array, shape (n,)
        Height [mm], positive out of the material; its zero does not matter.
    notes : tuple of str
        Corrections made while reading.

    Raises
    ------
    SceneError
        For fewer than 20 points, places that do not rise, or heights that are all the same.
    """

    x: Array
    z: Array
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if len(self.x) != len(self.z) or len(self.x) < FEWEST:
            raise SceneError("profile", (len(self.x), len(self.z)), f"give at least {FEWEST} pairs of x and z")
        if not (np.isfinite(self.x).all() and np.isfinite(self.z).all() and (np.diff(self.x) > 0).all()):
            raise SceneError("profile", "x, z", "must be finite, and x must rise")
        if not np.ptp(self.z) > 0:
            raise SceneError("profile z", float(self.z[0]), "all heights are the same: is this the right column?")

    @property
    def length(self) -> float:
        """From the first point to the last [mm]."""
        return float(self.x[-1] - self.x[0])

    def turned(self, *, upside_down: bool = False, mirrored: bool = False) -> Profile:
        """The profile with its heights' sign, or the direction of its line, reversed."""
        x, z = self.x, -self.z if upside_down else self.z
        return Profile(-x[::-1], z[::-1], self.notes) if mirrored else Profile(x, z, self.notes)


def read_profile(path: Path | str, *, length: float | None = None) -> Profile:
    """Read columns ``x [mm]`` and ``z [mm]``, or either in ``[µm]`` or ``[um]``.

    Lines that begin with ``#`` are skipped. Rows without a number (blank or NaN) are gaps and left out, rows out of
    order are sorted, and heights at the same place averaged; the profile's notes say so.

    Parameters
    ----------
    path : Path or str
    length : float or None
        Of the edge that was measured, as the scene has it [mm]: to recognise another unit.

    Raises
    ------
    SceneError
        If the file is missing or not such a table, has no units, or its places cannot be in the stated unit.
    """
    path = Path(path)
    if not path.is_file():
        raise SceneError("profile", str(path), "there is no such file")
    content = path.read_bytes()
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("latin-1")  # many instruments' µ
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip() and not line.startswith("#")]
    if not lines:
        raise SceneError("profile", str(path), "the file is empty")
    delimiter = max(",;\t", key=lines[0][1].count)
    header, *rows = [next(csv.reader([line], delimiter=delimiter)) for _, line in lines]
    numbers = [n for n, _ in lines[1:]]
    x, z = (_column(path, name, header, rows, numbers, length if name == "x" else None) for name in "xz")
    notes = []
    known = np.isfinite(x) & np.isfinite(z)
    if not known.all():
        notes.append(f"{int((~known).sum())} of {len(known)} points have no value and were left out")
    if known.sum() < max(FEWEST, len(known) / 2):
        raise SceneError(
            str(path), int(known.sum()), f"only so many of {len(known)} points have values; at least {FEWEST} must"
        )
    x, z = x[known], z[known]
    if (np.diff(x) < 0).any() and (np.diff(x) > 0).any():
        notes.append("x went back and forth: the points were sorted")
    places, which, count = np.unique(x, return_inverse=True, return_counts=True)
    if len(places) < len(x):
        notes.append(f"{len(x) - len(places)} points lie at the place of another: their heights were averaged")
    heights = np.bincount(which, weights=z) / count
    if len(places) > 1:
        hole = int(np.argmax(np.diff(places)))
        if places[hole + 1] - places[hole] > LARGEST_HOLE * (places[-1] - places[0]):
            notes.append(f"nothing is known between x = {places[hole]:.4g} and {places[hole + 1]:.4g} mm")
    profile = Profile(places, heights, tuple(notes))
    ratio = profile.length / length if length else 1.0
    if not 1 / WRONG_UNIT < ratio < WRONG_UNIT:
        raise SceneError(
            f"{path}, x",
            profile.length,
            f"so many mm long, where the edge measures {length:.4g} mm: {guess_unit(ratio)}",
        )
    return profile


def guess_unit(ratio: float) -> str:
    """The likely unit of values that are ``ratio`` times what they should be, as numbers of mm."""
    if ratio > WRONG_UNIT:
        return "are the values in µm? Name the column's unit [µm]"
    if ratio < 1 / WRONG_UNIT:
        return "are the values in mm under a header that says µm, or in m? Write mm and name the unit [mm]"
    return "the values look like mm; name the unit [mm]"


def _column(
    path: Path,
    name: str,
    header: Sequence[str],
    rows: Sequence[Sequence[str]],
    numbers: Sequence[int],
    length: float | None,
) -> Array:
    """One column in mm, NaN where it has no number."""
    found = {title.strip().partition("[")[0].strip(): i for i, title in enumerate(header)}
    if name not in found:
        raise SceneError(str(path), list(header), f"column '{name} [mm]' or '{name} [µm]' is missing")
    place = found[name]
    values = np.array([_number(path, n, header[place], row, place) for n, row in zip(numbers, rows, strict=True)])
    unit = header[place].partition("[")[2].rpartition("]")[0].strip()
    if unit in UNITS:
        return values * UNITS[unit]
    remedy = f"name its unit: '{name} [mm]' or '{name} [µm]'"
    if length and np.isfinite(values).any():
        extent = float(np.ptp(values[np.isfinite(values)]))
        remedy += f"; from end to end it is {extent:.4g}, where the edge measures {length:.4g} mm: "
        remedy += guess_unit(extent / length)
    raise SceneError(f"{path}, column", header[place], remedy)


def _number(path: Path, line: int, title: str, row: Sequence[str], place: int) -> float:
    text = row[place].strip() if place < len(row) else ""
    try:
        return float(text) if text else np.nan
    except ValueError:
        raise SceneError(
            f"{path}, line {line}, {title}", text, "must be a number (decimal point), or blank for a gap"
        ) from None
