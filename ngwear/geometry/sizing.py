"""Element sizes: small in the contact, growing with the distance from there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ngwear.geometry.outline import Array, Outline


@dataclass(frozen=True)
class SizeField:
    """Wanted element edge h(X) = min(coarse, min over seeds of (h_seed + grading |X - seed|)) [mm].

    Parameters
    ----------
    seeds : array, shape (k, 2)
        Places with small elements; may be empty.
    sizes : array, shape (k,)
        Element edge there [mm].
    coarse : float
        Element edge far away [mm].
    grading : float
        Growth of the edge with distance [-].
    turn, elsewhere : float
        Largest turn of the outline between two mesh nodes where the field is finest, and elsewhere [rad].
    finest : float or None
        Up to which edge it is finest [mm]; default the smallest of ``sizes``.
    per_radius : float
        Element edges over the outline's radius of curvature, at least [-]; 0 for none.
    """

    seeds: Array
    sizes: Array
    coarse: float
    grading: float = 0.25  # as of ``scene.accuracy``
    turn: float = 0.26  # 15 degrees
    elsewhere: float = 0.5  # as of ``loop.refinement``
    per_radius: float = 2.0  # Netgen's own
    finest: float | None = None

    def __call__(self, points: Array) -> Array:
        """Element edge wanted at points of shape (n, 2); shape (n,)."""
        points = np.atleast_2d(points)
        h = np.full(len(points), self.coarse)
        if len(self.seeds):
            h = np.minimum(h, (self.sizes + self.grading * _distances(points, self.seeds)).min(axis=1))
        return h


def _distances(points: Array, seeds: Array) -> Array:
    """From each point to each seed, shape (n, k); SciPy's ``cdist`` takes longer to load than to compute."""
    square = np.subtract.outer(points[:, 0], seeds[:, 0])
    square *= square
    along = np.subtract.outer(points[:, 1], seeds[:, 1])
    along *= along
    square += along
    distances: Array = np.sqrt(square, out=square)
    return distances


def fitted(contour: Outline, field: SizeField, *, on_chord: bool = False) -> Outline:
    """Return the outline with points inserted until no segment is longer than 1.3 h.

    Segments are halved on the spline, or on the polygon (``on_chord``), whose area then stays exactly the same.
    """
    while True:
        middle = np.arange(len(contour), dtype=float) + 0.5
        ends = field(contour.points)
        h = np.minimum(np.minimum(ends, np.roll(ends, -1)), field(contour.at(middle)))
        long = contour.lengths > 1.3 * h  # halves are then 0.65 h at least: neither is off by more than 0.35 h
        if not long.any():
            return contour
        contour = contour.inserted(middle[long], on_chord=on_chord)


def smoothed(contour: Outline, edges: tuple[str, ...], longest: float) -> Outline:
    """Return the outline with points inserted on the spline where the named edges are curved.

    After that no curved segment there is longer than ``longest`` [mm]: an edge that wears must not be refined later,
    because a point put on the spline of a curved segment changes the polygon's area.
    """
    return _halved(contour, edges, longest, curved=True)


def divided(contour: Outline, edges: tuple[str, ...], longest: float) -> Outline:
    """Return the outline with points inserted on the straight segments of the named edges longer than ``longest``."""
    return _halved(contour, edges, longest, curved=False)


def _halved(contour: Outline, edges: tuple[str, ...], longest: float, *, curved: bool) -> Outline:
    while True:
        middle = np.arange(len(contour), dtype=float) + 0.5
        sagitta = np.linalg.norm(contour.at(middle) - contour.on_polygon(middle), axis=1)
        mine = (sagitta > 1e-6 * contour.lengths) == curved
        split = contour.on(edges) & (contour.lengths > longest) & mine
        if not split.any():
            return contour
        contour = contour.inserted(middle[split])


def mesh_nodes(contour: Outline, field: SizeField) -> NDArray[np.intp]:
    """Choose the contour points that become mesh nodes, about h apart.

    Between two nodes the outline turns by no more than the field allows. Corners and changes of name are always nodes.
    """
    n = len(contour)
    h = field(contour.points)
    turn, length = np.abs(contour.turning), contour.lengths
    fixed = contour.corners | np.array([contour.names[i] != contour.names[i - 1] for i in range(n)])
    start = int(np.argmax(fixed))
    finest = field.sizes.min(initial=0.0 if len(field.sizes) == 0 else np.inf) if field.finest is None else field.finest
    in_patch = h <= 1.01 * finest
    max_turn = np.where(in_patch, field.turn, field.elsewhere)
    chosen = [start]
    run_length = run_turn = 0.0
    for step in range(1, n):
        i = (start + step) % n
        run_length += length[i - 1]
        ahead = run_length + length[i]
        size = min(h[i], h[chosen[-1]])
        if fixed[i] or ahead > 1.3 * size or run_turn + turn[i] > max_turn[i]:
            chosen.append(i)
            run_length = run_turn = 0.0
        else:
            run_turn += turn[i]
    return np.array(chosen)
