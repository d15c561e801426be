"""Outlines in files: TOML, CSV and STEP read, TOML written."""

from __future__ import annotations

import csv
import tomllib
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import tomli_w
from numpy.typing import NDArray

from ngwear.errors import GeometryError

# Between a polygon's turns along a round (12 points a circle at least) and a chamfer of 45 degrees.
CORNER_ANGLE = np.radians(30.0)  # a file that marks no corners gets one where the polygon turns by more


class Drawing(NamedTuple):
    """Contents of an outline file: the arguments of ``Outline``."""

    points: NDArray[np.float64]
    names: tuple[str, ...]
    corners: NDArray[np.bool_]
    provenance: str


def read_drawing(path: Path) -> Drawing:
    """Read an outline file, ``.toml``, ``.csv``, ``.step`` or ``.stp``.

    Raises
    ------
    GeometryError
        If the file cannot be read.
    """
    readers = {".toml": _toml, ".csv": _csv, ".step": _step, ".stp": _step}
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise GeometryError(f"outlines are read from {', '.join(readers)}, not from '{path.suffix}'")
    if not path.is_file():
        raise GeometryError("there is no such outline file")
    try:
        return reader(path)
    except OSError as error:
        raise GeometryError(f"cannot be read: {error.strerror or error}") from None
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError) as error:
        raise GeometryError(f"cannot be read as an outline: {error!r}") from error


def write_drawing(drawing: Drawing, path: Path) -> None:
    """Write an outline as TOML with all digits; a new ``[[edge]]`` starts at each change of name and each corner.

    Raises
    ------
    GeometryError
        If the file cannot be written.
    """
    points, names, corners, provenance = drawing
    starts = [i for i in range(len(points)) if i == 0 or corners[i] or names[i] != names[i - 1]]
    edges = [
        {"name": names[i], "corner": bool(corners[i]), "points": points[i:end].tolist()}
        for i, end in zip(starts, [*starts[1:], len(points)], strict=True)
    ]
    try:
        path.write_text(tomli_w.dumps({"provenance": provenance, "edge": edges}), encoding="utf-8")
    except OSError as error:
        raise GeometryError(f"{path} cannot be written: {error.strerror}") from None


def _toml(path: Path) -> Drawing:
    """``[[edge]]`` tables in counter-clockwise order: name, corner (at its first point), points [[x, y], ...]."""
    data: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))
    edges = data.get("edge", [])
    if not isinstance(edges, list) or not all(isinstance(edge, dict) for edge in edges):
        raise GeometryError("edge must be a list of tables [[edge]]")
    unknown = set(data) - {"title", "provenance", "coordinates", "edge"}
    if unknown:
        raise GeometryError(
            f"unknown keys {sorted(unknown)}; an outline has title, provenance, coordinates and [[edge]]"
        )
    points, names, corners = [], [], []
    for number, edge in enumerate(edges):
        unknown = set(edge) - {"name", "corner", "points"}
        if unknown:
            raise GeometryError(f"edge[{number}]: unknown keys {sorted(unknown)}; an edge has name, corner and points")
        if "name" not in edge:
            raise GeometryError(f"edge[{number}] has no name: name every edge by what it does")
        own = [[float(x), float(y)] for x, y in edge["points"]]
        points += own
        names += [str(edge["name"])] * len(own)
        corners += [bool(edge.get("corner", True))] + [False] * (len(own) - 1)
    return Drawing(np.array(points), tuple(names), np.array(corners), str(data.get("provenance", path.name)))


def _csv(path: Path) -> Drawing:
    """Columns ``x [mm], y [mm], edge`` and optionally ``corner`` (0 or 1), one row a point, counter-clockwise."""
    with path.open(newline="", encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    columns = set(rows[0]) if rows else set()
    missing = {"x [mm]", "y [mm]", "edge"} - columns
    if missing:
        raise GeometryError(
            f"columns {sorted(missing)} are missing; expected 'x [mm]', 'y [mm]', 'edge' and perhaps 'corner'"
        )
    points = np.array([[float(row["x [mm]"]), float(row["y [mm]"])] for row in rows])
    names = tuple((row["edge"] or "").strip() for row in rows)
    marked = "corner" in columns
    corners = np.array([bool(int(row["corner"])) for row in rows]) if marked else _sharp(points)
    return Drawing(points, names, corners, path.name)


def _sharp(points: np.ndarray) -> np.ndarray:
    ahead = np.roll(points, -1, axis=0) - points
    angle = np.arctan2(ahead[:, 1], ahead[:, 0])
    return np.abs((angle - np.roll(angle, 1) + np.pi) % (2 * np.pi) - np.pi) > CORNER_ANGLE


def _step(path: Path) -> Drawing:
    """The first face of the file, in its x-y plane; edges keep their names or are called ``edge 1`` and so on."""
    import netgen.occ as occ

    try:
        shape = occ.OCCGeometry(str(path)).shape
    except Exception as error:  # netgen's own class derives from Exception alone
        raise GeometryError(f"cannot be read as STEP: {error}") from error
    faces = list(shape.faces)
    if len(faces) != 1:
        raise GeometryError(f"holds {len(faces)} faces; export one plane section")
    box = shape.bounding_box
    if box[1].z - box[0].z > 1e-6:
        raise GeometryError("the section does not lie in the x-y plane of the file")
    pieces = []
    for number, edge in enumerate(faces[0].edges, 1):
        pieces.append((edge.name or f"edge {number}", _sampled(edge)))
    return _joined(pieces, path.name)


def _sampled(edge: Any, max_turn: float = 0.2) -> np.ndarray:  # rad: a spline errs by 4e-6 of the radius
    """Points along an OCC edge, dense enough that the polygon turns by at most ``max_turn`` rad at a point."""
    a, b = edge.parameter_interval
    for count in (1, 4, 8, 16, 32, 64, 128, 256, 512):
        s = np.linspace(a, b, count + 1)
        points = np.array([[p.x, p.y] for p in (edge.Value(float(v)) for v in s)])
        probe = np.array([[p.x, p.y] for p in (edge.Value(float(v)) for v in np.linspace(a, b, 4 * count + 1))])
        turn = np.abs(np.diff(np.unwrap(np.arctan2(*np.diff(probe, axis=0).T[::-1])))) if count else np.zeros(1)
        if turn.sum() / count <= max_turn:
            break
    return points


def _joined(pieces: list[tuple[str, np.ndarray]], provenance: str) -> Drawing:
    """Chain edge polylines head to tail into a counter-clockwise outline."""
    scale = max(np.ptp(np.vstack([p for _, p in pieces]), axis=0))
    rest = pieces[1:]
    chain = [pieces[0]]
    while rest:
        tail = chain[-1][1][-1]
        for k, (name, points) in enumerate(rest):
            if np.linalg.norm(points[0] - tail) < 1e-6 * scale:
                chain.append((name, points))
            elif np.linalg.norm(points[-1] - tail) < 1e-6 * scale:
                chain.append((name, points[::-1]))
            else:
                continue
            del rest[k]
            break
        else:
            raise GeometryError(f"the section's edges do not join at {tail.tolist()}; a section has one closed outline")
    points = np.vstack([p[:-1] for _, p in chain])
    names = [name for name, p in chain for _ in p[:-1]]
    x, y = points.T
    if x @ np.roll(y, -1) - y @ np.roll(x, -1) < 0:
        points = np.roll(points[::-1], 1, axis=0)
        names = names[::-1]
    starts = np.array([any(np.allclose(p, end) for _, own in chain for end in (own[0], own[-1])) for p in points])
    return Drawing(points, tuple(names), starts, provenance)
