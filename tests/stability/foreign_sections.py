"""Sections that nobody drew: eight kinds of seals with random proportions, for ``foreign.py``.

Each kind is drawn in its own coordinates: x along the axis from the air to the sealed side, y from the innermost point
of the section outwards, both in mm.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from shapely import Polygon

POINTS_ALONG = 40  # points on a straight line as long as the section is high
FREE = 0.05  # least share of the groove that stays empty
TURN = 0.15  # most that the outline turns from one point of a round to the next [rad]


@dataclass(frozen=True)
class Room:
    """The radial room of a section, all in mm.

    Attributes
    ----------
    height : float
        Radial height of the section before mounting.
    inner, outer : float
        How much of it overlaps the inner and the outer surface.
    tip : float
        Radius of lips and edges.
    """

    height: float
    inner: float
    outer: float
    tip: float

    @property
    def gland(self) -> float:
        """Distance of the two surfaces."""
        return self.height - self.inner - self.outer


@dataclass(frozen=True)
class Shape:
    """An outline: points counter-clockwise, the edge of each segment, and what an engineer would say about the edges.

    Attributes
    ----------
    points : array, shape (n, 2)
    names : tuple of str, length n
    inlet : tuple of str
        Edges that the fluid always wets.
    hidden : tuple of str
        Edges that face a surface, but lie behind another part of the section.
    """

    points: np.ndarray
    names: tuple[str, ...]
    inlet: tuple[str, ...]
    hidden: tuple[str, ...] = ()

    def facing(self, direction: tuple[float, float]) -> list[str]:
        """Edges, but for the hidden ones, with a stretch whose outward normal points along a direction."""
        along = np.roll(self.points, -1, axis=0) - self.points
        normal = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
        faces = normal @ direction > 0.3
        names = dict.fromkeys(name for name, face in zip(self.names, faces, strict=True) if face)
        return [name for name in names if name not in self.hidden]

    def groove_width(self, inner: float, outer: float) -> float:
        """Least width of a groove between two radii that leaves some of it empty; ValueError if the outline crosses."""
        section = Polygon(self.points)
        if not section.is_valid:
            raise ValueError("the section crosses itself")
        return 2 * section.area * section.centroid.y / (1 - FREE) / (outer**2 - inner**2)

    def contour(self, title: str) -> str:
        """The outline as a contour file."""
        lines, points = [f'title = "{title}"', 'provenance = "drawn at random"'], []
        for i, (name, (x, y)) in enumerate(zip(self.names, self.points, strict=True)):
            points.append(f"[{x:.5f}, {y:.5f}]")
            if self.names[i + 1 : i + 2] != (name,):
                lines += ["[[edge]]", f'name = "{name}"', "corner = false", f"points = [{', '.join(points)}]"]
                points = []
        return "\n".join(lines) + "\n"


Corner = tuple[float, float, float, str]  # x, y, radius of its round, name of the edge that starts there


def rounded(corners: list[Corner], step: float) -> tuple[np.ndarray, tuple[str, ...]]:
    """A polygon with rounds at its corners, as points with the names of their edges.

    A round takes at most half of the shorter side beside it. Straight lines get a point every ``step``.
    """
    pieces: list[tuple[str, np.ndarray]] = []
    for i, (x, y, radius, name) in enumerate(corners):
        before, here, after = np.array([corners[i - 1][:2], (x, y), corners[(i + 1) % len(corners)][:2]], dtype=float)
        pieces.append((name, _round(before, here, after, radius)))
    points, names = [], []
    for i, (name, arc) in enumerate(pieces):
        end = pieces[(i + 1) % len(pieces)][1][0]
        parts = max(1, math.ceil(np.linalg.norm(end - arc[-1]) / step))
        line = arc[-1] + (end - arc[-1]) * np.arange(1, parts)[:, None] / parts
        mine = [*arc, *line]
        points += mine
        names += [name] * len(mine)
    return np.array(points), tuple(names)


def _round(before: np.ndarray, here: np.ndarray, after: np.ndarray, radius: float) -> np.ndarray:
    """Points of the round at one corner."""
    sides = np.stack([before - here, after - here])
    lengths = np.linalg.norm(sides, axis=1)
    u, w = sides / lengths[:, None]
    half = math.acos(np.clip(u @ w, -1.0, 1.0)) / 2
    reach = min(radius / math.tan(half), 0.49 * lengths.min())
    radius = reach * math.tan(half)
    if radius == 0 or half > 0.499 * math.pi:
        return here[None]
    centre = here + radius / math.sin(half) * (u + w) / np.linalg.norm(u + w)
    start, end = (math.atan2(*(here + reach * side - centre)[::-1]) for side in (u, w))
    turn = (end - start + math.pi) % (2 * math.pi) - math.pi
    angle = np.linspace(start, start + turn, max(5, math.ceil(abs(turn) / TURN) + 1))
    return centre + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _shape(corners: list[Corner], room: Room, inlet: tuple[str, ...], hidden: tuple[str, ...] = ()) -> Shape:
    return Shape(*rounded(corners, room.height / POINTS_ALONG), inlet, hidden)


SIDES = ("rod side", "sealed side", "groove side", "air side")


def o_ring(rng: np.random.Generator, room: Room) -> Shape:
    """A circle."""
    count = int(rng.choice([20, 30, 40, 60]))
    angle = np.linspace(-0.75 * math.pi, 1.25 * math.pi, 4 * count, endpoint=False)
    points = 0.5 * room.height * (1 + np.stack([np.cos(angle), np.sin(angle)], axis=1))
    return Shape(points, tuple(np.repeat(SIDES, count).tolist()), ("sealed side",))


def x_ring(rng: np.random.Generator, room: Room) -> Shape:
    """Four round lobes with round valleys between them."""
    half, lobe, valley = 0.5 * room.height, room.height * rng.uniform(0.2, 0.26), room.height * rng.uniform(0.06, 0.1)
    c, depth = half - lobe, half - valley
    root = (c**2 + (depth - c) ** 2 - lobe**2) / (
        2 * (lobe - (depth - c))
    )  # radius of the valley, tangent to the lobes
    lean = math.atan2(c, depth + root - c)
    inside = np.linspace(-lean, lean, 11)[1:-1]
    outside = np.linspace(-0.5 * math.pi - lean, lean, 26)
    side = np.concatenate(
        [
            np.stack([root * np.sin(inside), root * np.cos(inside) - depth - root], axis=1),
            np.stack([c + lobe * np.cos(outside), lobe * np.sin(outside) - c], axis=1),
        ]
    )
    turns = (np.array([[math.cos(a), math.sin(a)], [-math.sin(a), math.cos(a)]]) for a in np.arange(4) * math.pi / 2)
    points = np.concatenate([side @ turn for turn in turns]) + half
    return Shape(points, tuple(np.repeat(SIDES, len(side)).tolist()), ("sealed side",))


def lip(rng: np.random.Generator, room: Room) -> Shape:
    """A base with a lip towards the rod; its back is pressed in a bore, a throat parts the lip from it."""
    high, length = room.height, room.height * rng.uniform(1.1, 1.6)
    heel = room.inner + high * rng.uniform(0.03, 0.08)  # stays clear of the rod
    free = high - heel
    above, below = heel + free * rng.uniform(0.33, 0.42), high - free * rng.uniform(0.3, 0.38)  # the throat's sides
    throat, tip, bend = length * rng.uniform([0.35, 0.86, 0.3], [0.5, 0.94, 0.45])
    round_ = 0.06 * high
    corners = [
        (0.0, heel, round_, "heel"),
        (bend, heel, 3 * round_, "air flank"),
        (tip, 0.0, room.tip, "lip"),
        (length, 0.5 * above, round_, "lip end"),
        (0.96 * length, 0.85 * above, round_, "throat"),
        (throat, above, 1.5 * round_, "throat"),
        (throat, below, 1.5 * round_, "throat"),
        (length * rng.uniform(0.75, 1.0), below, room.tip, "back end"),
    ]
    corners += [(corners[-1][0], high, round_, "back"), (0.0, high, round_, "air face")]
    return _shape(corners, room, ("lip end", "throat", "back end"), ("throat",))


def ridge(rng: np.random.Generator, room: Room) -> Shape:
    """A ring with a bead on the rod side."""
    high, width = room.height, room.height * rng.uniform(0.9, 1.5)
    bead = max(room.inner + 0.05 * high, 0.18 * high) + high * rng.uniform(0.0, 0.1)
    half = min(bead * rng.uniform(0.7, 1.3), 0.3 * width)
    at, round_ = width * rng.uniform(0.38, 0.62), max(room.tip, 0.04 * high)
    corners = [
        (0.0, bead, round_, "air shoulder"),
        (at - half, bead, round_, "bead"),
        (at, 0.0, max(room.tip, 0.15 * bead), "bead"),
        (at + half, bead, round_, "sealed shoulder"),
        (width, bead, round_, "sealed side"),
        (width, high, round_, "groove side"),
        (0.0, high, round_, "air side"),
    ]
    return _shape(corners, room, ("sealed side",))


def u_cup(rng: np.random.Generator, room: Room) -> Shape:
    """Two lips with a throat between them; base and flanks stay clear of both surfaces."""
    gland, rod = room.gland, room.inner  # rod: height of the rod's surface
    length = gland * rng.uniform(1.1, 1.5)
    tip, bend, throat, end = length * rng.uniform([0.87, 0.5, 0.4, 0.88], [0.93, 0.6, 0.56, 0.95])
    clear, middle, wide = gland * rng.uniform([0.015, 0.46, 0.06], [0.04, 0.54, 0.11])
    round_ = 0.05 * gland
    corners = [
        (0.0, rod + clear, round_, "heel"),
        (bend, rod + clear, 2.4 * round_, "inner flank"),
        (tip, 0.0, room.tip, "inner lip"),
        (length, rod + 0.06 * gland, 0.5 * round_, "inner face"),
        (end, rod + 0.24 * gland, round_, "throat"),
        (throat, rod + middle - wide, 1.4 * round_, "throat"),
        (throat, rod + middle + wide, 1.4 * round_, "throat"),
        (end, rod + 0.76 * gland, round_, "outer face"),
        (length, rod + 0.94 * gland, 0.5 * round_, "outer lip"),
        (tip, room.height, room.tip, "outer flank"),
        (bend, rod + gland - clear, 2.4 * round_, "back"),
        (0.0, rod + gland - clear, round_, "base"),
    ]
    return _shape(corners, room, ("inner face", "throat", "outer face"), ("throat",))


def d_ring(rng: np.random.Generator, room: Room) -> Shape:
    """Flat on the bottom of a piston's groove, round to the bore."""
    high, width = room.height, room.height * rng.uniform(0.8, 1.2)
    flank, round_ = high - 0.5 * width, max(room.tip, 0.05 * high)
    corners = [
        (0.0, 0.0, round_, "groove side"),
        (width, 0.0, round_, "sealed side"),
        (width, high, 0.49 * width, "bore side"),
        (0.0, high, 0.49 * width, "bore side"),
        (0.0, 0.9 * flank, 0.0, "air side"),
    ]
    return _shape(corners, room, ("sealed side",))


def wiper(rng: np.random.Generator, room: Room) -> Shape:
    """A lip seal turned round: its lip keeps dirt out."""
    names = {"heel": "rod side", "air flank": "lip back", "lip": "scraper", "air face": "inner face"}
    names |= {"lip end": "lip front", "throat": "dirt groove", "back end": "shoulder"}
    other = lip(rng, room)
    points = np.array([other.points[:, 0].max(), 0.0]) + other.points * [-1.0, 1.0]
    turned = [names.get(name, name) for name in other.names]
    return Shape(points[::-1], tuple([*turned[-2::-1], turned[-1]]), (), ("dirt groove",))


def rectangle(rng: np.random.Generator, room: Room) -> Shape:
    """A rectangular ring with rounded corners."""
    high, width, round_ = room.height, room.height * rng.uniform(0.7, 1.5), max(room.tip, 0.04 * room.height)
    corners = [(0.0, 0.0), (width, 0.0), (width, high), (0.0, high)]
    return _shape([(x, y, round_, name) for (x, y), name in zip(corners, SIDES, strict=True)], room, ("sealed side",))


KINDS: dict[str, Callable[[np.random.Generator, Room], Shape]] = {
    "O-ring": o_ring,
    "X-ring": x_ring,
    "lip": lip,
    "ridge": ridge,
    "U-cup": u_cup,
    "D-ring": d_ring,
    "wiper": wiper,
    "rectangle": rectangle,
}
