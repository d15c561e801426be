"""Write contour.toml: an invented rod seal after the description of the source work.

Nothing here is measured. Section about 5 x 4 mm; the lip tip at radius 10.2 (bore 20.4, 1.8 below the
22.2 rod); seven ridges left of the lip (air side), two on the right (sealed side).

    python geometries/rod_seal/make_contour.py
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np

TIP = (3.15, 10.2)  # lip tip: axial position and radius [mm]
TIP_RADIUS = 0.02
FLANKS = (45.0, 50.0)  # degrees from the rod axis, air side and sealed side
FOOT_RADIUS = 0.02  # where the flanks leave the section
PITCH = 0.33
LEFT = 0.69  # where the first left ridge begins
LEFT_BASE = (10.475, 10.302)  # radius of the ridge roots at the first and after the last left ridge
LEFT_HEIGHT = 0.10
RIGHT = 3.315
RIGHT_BASE = (10.312, 10.58)
RIGHT_HEIGHT = 0.10
SPACING = 0.0095  # ridges


def ridges(start: float, count: int, base: tuple[float, float], height: float) -> np.ndarray:
    """Sinusoidal ridges: tip and root radius pitch^2 / (2 pi^2 height) = 0.046 mm."""
    z = np.linspace(start, start + count * PITCH, 4000)
    share = (z - z[0]) / (z[-1] - z[0])
    rise = share**2 if base[1] > base[0] else 1 - (1 - share) ** 2  # flat beside the lip
    r = base[0] + (base[1] - base[0]) * rise - height / 2 * (1 - np.cos(2 * np.pi * (z - start) / PITCH))
    return resample(np.column_stack([z, r]), SPACING)


def resample(points: np.ndarray, spacing: float) -> np.ndarray:
    """Points at equal arc length, about ``spacing`` apart."""
    s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = np.linspace(0, s[-1], max(2, int(np.ceil(s[-1] / spacing)) + 1))
    return np.column_stack([np.interp(at, s, c) for c in points.T])


def rounded(vertices: list[tuple[float, float, float]], spacing: float) -> np.ndarray:
    """Polyline through (z, r, radius) with each inner vertex rounded, resampled."""
    dense = [np.array(vertices[0][:2])]
    for (a, b, c), radius in zip(
        zip(*(np.array(vertices)[i : len(vertices) - 2 + i, :2] for i in range(3)), strict=True),
        [v[2] for v in vertices[1:-1]],
        strict=True,
    ):
        e, f = (a - b) / np.linalg.norm(a - b), (c - b) / np.linalg.norm(c - b)
        half = 0.5 * np.arccos(e @ f)
        if radius == 0:
            dense.append(b)
            continue
        p, centre = b + e * radius / np.tan(half), b + (e + f) / np.linalg.norm(e + f) * radius / np.sin(half)
        sweep = np.pi - 2 * half
        turn = np.sign((b - a)[0] * (c - b)[1] - (b - a)[1] * (c - b)[0])
        for angle in np.linspace(0, turn * sweep, 60):
            cos, sin = np.cos(angle), np.sin(angle)
            dense.append(centre + np.array([[cos, -sin], [sin, cos]]) @ (p - centre))
    dense.append(np.array(vertices[-1][:2]))
    dense = np.array(dense)
    fine = [dense[:1]]
    for a, b in pairwise(dense):
        n = max(1, int(np.linalg.norm(b - a) / 0.001))
        fine.append(a + (b - a) * np.arange(1, n + 1)[:, None] / n)
    return resample(np.vstack(fine), spacing)


def quarter(z: float, r: float, start: float) -> np.ndarray:
    """Quarter circle of radius 0.4 around (z, r), from ``start`` degrees."""
    angle = np.radians(np.linspace(start, start + 90.0, 11))
    return np.column_stack([z + 0.4 * np.cos(angle), r + 0.4 * np.sin(angle)])


def edges(*, blunting: float = 0.0, tip_radius: float = TIP_RADIUS) -> list[tuple[str, np.ndarray]]:
    """Return the named edges, counter-clockwise from the foot of the back face.

    ``blunting`` takes roots nearer to the tips of the ridges, which stay where they are [mm].
    """
    left = ridges(LEFT, 7, (LEFT_BASE[0] - blunting, LEFT_BASE[1] - blunting), LEFT_HEIGHT - blunting)
    right = ridges(RIGHT, 2, (RIGHT_BASE[0] - blunting, RIGHT_BASE[1] - blunting), RIGHT_HEIGHT - blunting)
    alpha, beta = np.radians(FLANKS)
    # The rounded tip lies above the apex of the flanks.
    half = (np.pi - alpha - beta) / 2
    apex_drop = tip_radius * (1 / np.sin(half) * np.cos(half - (np.pi / 2 - alpha)) - 1)
    apex = (TIP[0], TIP[1] - apex_drop)
    foot_left = (apex[0] - (left[-1, 1] - apex[1]) / np.tan(alpha), left[-1, 1])
    foot_right = (apex[0] + (right[0, 1] - apex[1]) / np.tan(beta), right[0, 1])
    lip = rounded(
        [(*left[-1], 0), (*foot_left, FOOT_RADIUS), (*apex, tip_radius), (*foot_right, FOOT_RADIUS), (*right[0], 0)],
        TIP_RADIUS / 4,
    )
    lip[:, 1] += TIP[1] - lip[:, 1].min()
    lip[0], lip[-1] = left[-1], right[0]
    heel = rounded([(0, 11.4, 0), (0, left[0, 1], 0.15), (*left[0], 0)], 0.04)
    toe = rounded([(*right[-1], 0), (4.6, 10.62, 0.2), (5.0, 11.4, 0.3), (5.0, 12.4, 0)], 0.04)
    return [
        ("heel", heel),
        ("left ridges", left),
        ("lip", lip),
        ("right ridges", right),
        ("sealed face", toe),
        ("sealed shoulder", np.array([(5.0, 12.4), (5.0, 13.8)])),
        ("sealed round", quarter(4.6, 13.8, 0.0)),
        ("static face", np.array([(4.6, 14.2), (0.4, 14.2)])),
        ("air round", quarter(0.4, 13.8, 90.0)),
        ("back face", np.array([(0.0, 13.8), (0.0, 11.4)])),
    ]


def write(path: Path, named: list[tuple[str, np.ndarray]], corner: set[str], head: list[str]) -> None:
    """Write named edges, each up to the first point of the next; those in ``corner`` begin with one."""
    lines = list(head)
    for name, points in named:
        lines += [
            "",
            "[[edge]]",
            f'name = "{name}"',
            f"corner = {str(name in corner).lower()}  # at its first point",
            "points = [",
        ]
        lines += [f"  [{z:.6f}, {r:.6f}]," for z, r in points[:-1]]
        lines += ["]"]
    path.write_text("\n".join(lines) + "\n")


CORNER = {"heel", "back face", "sealed shoulder", "sealed round", "static face", "air round"}


def main() -> None:
    """Write the outline beside this script."""
    head = [
        'title = "Invented rod seal, section 5 x 4 mm, bore 20.4 mm"',
        'provenance = "invented after the description in 10.5772/50498; not measured; made by make_contour.py"',
        'coordinates = ["axial [mm]", "radius [mm]"]',
    ]
    write(Path(__file__).with_name("contour.toml"), edges(), CORNER, head)


if __name__ == "__main__":
    main()
