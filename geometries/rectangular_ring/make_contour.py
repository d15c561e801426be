"""Write contour.toml: a ring of rectangular section, 3.0 x 3.3 mm, with rounded corners.

python geometries/rectangular_ring/make_contour.py
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

BORE, WIDTH, HEIGHT, ROUND = 19.7, 3.0, 3.3, 0.3  # mm
STEP, TURN = 0.1, 0.15  # distance of points on a straight line [mm], and turn between points of a round [rad]

Corner = tuple[float, float, float, str]  # x, y, radius or 0, and the name of the edge that begins there


def rounded(corners: list[Corner]) -> list[tuple[str, np.ndarray]]:
    """Named edges of a polygon whose corners are rounded; corners of one name in a row make one edge."""
    rounds = []
    for i, (x, y, radius, _) in enumerate(corners):
        here = np.array([x, y])
        if radius == 0:
            rounds.append(here[None])
            continue
        sides = [np.array(corners[j % len(corners)][:2]) - here for j in (i - 1, i + 1)]
        u, w = (side / np.linalg.norm(side) for side in sides)
        half = math.acos(np.clip(u @ w, -1, 1)) / 2
        centre = here + radius / math.sin(half) * (u + w) / np.linalg.norm(u + w)
        start, end = (math.atan2(*(here + radius / math.tan(half) * side - centre)[::-1]) for side in (u, w))
        turn = (end - start + math.pi) % (2 * math.pi) - math.pi
        angle = np.linspace(start, start + turn, max(6, math.ceil(abs(turn) / min(TURN, STEP / radius)) + 1))
        rounds.append(centre + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    edges: list[tuple[str, np.ndarray]] = []
    for i, (arc, corner) in enumerate(zip(rounds, corners, strict=True)):
        line = rounds[(i + 1) % len(corners)][0] - arc[-1]
        parts = max(1, math.ceil(np.linalg.norm(line) / STEP))
        points = np.concatenate([arc, arc[-1] + line * np.arange(1, parts)[:, None] / parts])
        if edges and edges[-1][0] == corner[3]:
            points = np.concatenate([edges.pop()[1], points])
        edges.append((corner[3], points))
    return edges


def write(folder: Path, title: str, edges: list[tuple[str, np.ndarray]]) -> None:
    """Write an outline into a folder."""
    lines = [f'title = "{title}"', 'provenance = "invented, typical proportions"']
    for name, points in edges:
        rows = ", ".join(f"[{x:.5f}, {y:.5f}]" for x, y in points)
        lines.append(f'[[edge]]\nname = "{name}"\ncorner = false\npoints = [{rows}]')
    (folder / "contour.toml").write_text("\n".join(lines) + "\n")


def main() -> None:
    """Write the outline beside this file."""
    half, inner, outer = WIDTH / 2, BORE / 2, BORE / 2 + HEIGHT
    corners = [(-half, inner, "rod side"), (half, inner, "sealed side"), (half, outer, "groove side")]
    corners.append((-half, outer, "air side"))
    edges = rounded([(x, y, ROUND, name) for x, y, name in corners])
    write(Path(__file__).parent, f"Rectangular ring {BORE} x {WIDTH} x {HEIGHT}", edges)


if __name__ == "__main__":
    main()
