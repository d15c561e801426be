"""Contact along the outline: nodal pressures, gaps and contact zones."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ngwear.geometry.meshed_section import MeshedSection
from ngwear.geometry.outline import Outline

Array = NDArray[np.float64]


HALF = 0.5  # of a node's pressure: what the pressure around it is above as far as its bump goes
HERTZ = math.sqrt(1 - HALF**2)  # width at that pressure over the whole one of a Hertz pressure
LEAST_WIDTH = 0.5  # of a mesh edge: a contact within it has no width that its nodes could tell
NO_PRESSURE = 1e-12  # MPa: less is none
OFF = 1 / 8 + 1 / 12  # of h^2 p'': what a peak between two nodes is above them, and what lumping takes off it


@dataclass(frozen=True)
class Zone:
    """One connected piece of the contact.

    Attributes
    ----------
    start, end : array, shape (2,)
        Deformed coordinates of its ends [mm], between nodes: where the gap opens.
    peak : float
        Largest Cauchy pressure [MPa].
    width : float
        Deformed length along the outline [mm].
    nodes : array of int
        Nodes that carry pressure, along the outline.
    """

    start: Array
    end: Array
    peak: float
    width: float
    nodes: NDArray[np.intp]


@dataclass(frozen=True)
class EdgeNodes:
    """The nodes of mesh edges along an outline.

    Attributes
    ----------
    t : array, shape (k,)
        Outline parameter of each node, ascending.
    of_edges : array of int, shape (m, 2)
        The two nodes of each mesh edge.
    """

    t: Array
    of_edges: NDArray[np.intp]

    @classmethod
    def on(cls, body: MeshedSection, positions: NDArray[np.intp]) -> EdgeNodes:
        """Of the mesh edges at these positions of the body's outline."""
        ends = np.round(body.outline.t[positions] % len(body.base), 9)
        t, node = np.unique(ends, return_inverse=True)
        return cls(t, node.reshape(ends.shape))

    @cached_property
    def meeting(self) -> NDArray[np.intp]:
        """How many mesh edges meet at each node, shape (k,)."""
        return np.bincount(self.of_edges.ravel(), minlength=len(self.t))

    def total(self, samples: Array) -> Array:
        """Sum at each node of samples at the ends of the mesh edges, shape (m, 2)."""
        return _summed(self.of_edges.ravel(), samples.ravel(), len(self.t))

    def average(self, samples: Array) -> Array:
        """Mean at each node of samples at the ends of the mesh edges, shape (m, 2)."""
        return self.total(samples) / self.meeting


@dataclass(frozen=True)
class ContactProfile:
    """Nodal values along a contact's edges, in the order of the outline.

    The unknown pressure jumps between mesh edges. The nodal pressure is its lumped L2 projection, which damps the
    jumps, with a correction that makes a linear pressure exact on a graded mesh too. ``load`` is closer to the unknown:
    it is corrected for the error of lumping with a curved pressure.

    Attributes
    ----------
    t : array, shape (k,)
        Outline parameter of each node.
    reference, place : array, shape (k, 2)
        Coordinates on the undeformed and on the deformed outline [mm].
    nominal_pressure : array, shape (k,)
        P, force per reference area [MPa].
    pressure : array, shape (k,)
        Cauchy pressure P / (da/dA) [MPa].
    gap : array, shape (k,)
        Distance from the surface [mm].
    weight : array, shape (k,)
        Reference length that belongs to each node, int phi_i ds [mm].
    load : array, shape (k,)
        The node's share of int P ds [N/mm], see ``_gathered``; the wear is computed from it.
    edges : array of int, shape (m, 2)
        The two nodes of each mesh edge.
    mean : array, shape (m,)
        Mean nominal pressure of each mesh edge [MPa].
    standing_off : array, shape (m,)
        Gap in the middle of each mesh edge, less the mean of those at its ends [mm]; 0 for nodal pressures.
    """

    t: Array
    reference: Array
    place: Array
    nominal_pressure: Array
    pressure: Array
    gap: Array
    weight: Array
    load: Array
    edges: NDArray[np.intp]
    mean: Array
    standing_off: Array

    @classmethod
    def from_samples(
        cls,
        nodes: EdgeNodes,
        contour: Outline,
        lengths: Array,
        *,
        pressure: Array,
        stretch: Array,
        place: Array,
        gap: Array,
        middle_gap: Array,
        nodal: bool = False,
    ) -> ContactProfile:
        """Build from lengths of the mesh edges, shape (m,) [mm], and samples at both ends of each.

        The samples are of shape (m, 2), ``place`` of shape (m, 2, 2), ``middle_gap`` of shape (m,); ``nodal`` as of
        ``nodal_pressure``.
        """
        nominal, load, weight = nodal_pressure(nodes, lengths, pressure, nodal=nodal)
        return cls(
            t=nodes.t,
            reference=contour.at(nodes.t),
            place=np.stack([nodes.average(place[..., k]) for k in range(2)], axis=1),
            nominal_pressure=nominal,
            pressure=nominal / nodes.average(stretch),
            gap=nodes.average(gap),
            weight=weight,
            load=load,
            edges=nodes.of_edges,
            mean=pressure.mean(axis=1),
            standing_off=np.zeros(len(gap)) if nodal else middle_gap - gap.mean(axis=1),
        )

    @property
    def element_edge(self) -> float:
        """Mean length of the mesh edges in contact, by the load that they bear [mm]; 0 out of contact."""
        ends = self.reference[self.edges]
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        load = length * np.maximum(self.mean, 0.0)
        return float(load @ length / load.sum()) if load.any() else 0.0

    @property
    def shortest_edges(self) -> Array:
        """Length of the shortest mesh edge at each node, shape (k,) [mm]."""
        ends = self.reference[self.edges]
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        shortest = np.full(len(self.t), np.inf)
        np.minimum.at(shortest, self.edges, length[:, None])
        return shortest

    @property
    def missed_at_peak(self) -> float:
        """By how much the largest pressure may be read too low [MPa]; 0 out of contact.

        A peak of curvature p'' is off by ``h^2 p''/12`` by lumping (see ``_gathered``), and lies up to ``h^2 p''/8``
        above the nearest node: h^2 is the product of the two mesh edges at that node, p'' follows from its neighbours.
        """
        top = int(self.pressure.argmax()) if len(self.pressure) else 0
        if not self.pressure.any():
            return 0.0
        k = len(self.t)
        around = [top - 1, top, (top + 1) % k] if self._closes() else [max(top - 1, 0), top, min(top + 1, k - 1)]
        p, x = self.pressure[around], self.place[around]
        before, after = np.linalg.norm(np.diff(x, axis=0), axis=1)
        slopes = [drop / h if h > 0 else 0.0 for drop, h in ((p[1] - p[0], before), (p[1] - p[2], after))]
        return float(OFF * before * after * sum(slopes) / (0.5 * (before + after))) if before + after > 0 else 0.0

    def straight(self) -> ContactProfile:
        """The same profile with loads from the lumped pressures (same sum), and pressures linear between nodes."""
        load = self.nominal_pressure * self.weight
        load = load * (self.load.sum() / load.sum()) if load.any() else load
        return replace(self, load=load, mean=(load / self.weight)[self.edges].mean(axis=1))

    def between_nodes(self, values: Array) -> Array:
        """Values at the outline's points, shape (n,), linear between the values at the contact's nodes."""
        n = len(values)
        at_nodes = np.interp(self.t, np.arange(n), values, period=n)
        return np.where(values == 0.0, 0.0, np.interp(np.arange(n), self.t, at_nodes, period=n))

    def zones(self, *, threshold: float = 1e-3) -> list[Zone]:
        """Connected pieces where the pressure exceeds ``threshold`` times its maximum."""
        p = self.pressure
        on = p > max(threshold * p.max(initial=0.0), NO_PRESSURE)  # what the mesh makes of nothing at an end
        if not on.any() or on.all() or not self._closes():
            return self._pieces(on)
        # Around the whole outline: begin in the middle of the longest open piece, so that no zone lies across the end.
        loaded, n = np.flatnonzero(on), len(on)
        opens = np.diff(loaded, append=loaded[0] + n)
        off = int(loaded[opens.argmax()] + opens.max() // 2) % n
        zones = self._from(off)._pieces(np.roll(on, -off))
        zones = [replace(zone, nodes=(zone.nodes + off) % n) for zone in zones]
        return sorted(zones, key=lambda zone: int(zone.nodes[0]))

    def bump_widths(self) -> Array:
        """Width of the bump of pressure at each node, shape (k,) [mm]; 0 where none acts.

        It is that of the zone if the pressure is Hertz's: the way along which the pressure around the node is above
        half of the node's own, over ``sqrt(3)/2``, and at most the zone's width. A lobe, or a peak at the end of a
        contact, has a width of its own.
        """
        widths = np.zeros(len(self.t))
        for zone in self.zones():
            x, p = self.place[zone.nodes], self.pressure[zone.nodes]
            ways = np.cumsum(np.linalg.norm(np.diff(x, axis=0, prepend=x[:1]), axis=1))
            before = np.clip(np.linalg.norm(x[0] - zone.start), 0.0, zone.width)
            at = np.concatenate([[-before], ways, [max(zone.width - before, ways[-1])]])
            pressed = np.concatenate([[0.0], p, [0.0]])
            for i, own in enumerate(p, start=1):
                low = np.flatnonzero(pressed < HALF * own)
                left, right = low[low < i][-1], low[low > i][0]
                ends = [
                    np.interp(HALF * own, pressed[[out, out + step]], at[[out, out + step]])
                    for out, step in ((left, 1), (right, -1))
                ]
                widths[zone.nodes[i - 1]] = min((ends[1] - ends[0]) / HERTZ, zone.width)
        return widths

    def loads_and_widths(self) -> list[tuple[float, float]]:
        """Load [N/mm] and width [mm] of each zone."""
        return [(float(self.load[zone.nodes].sum()), zone.width) for zone in self.zones()]

    def _pieces(self, on: NDArray[np.bool_]) -> list[Zone]:
        """Connected pieces of these nodes."""
        joined = np.zeros(len(on) + 1, dtype=bool)  # whether a mesh edge joins node i - 1 to node i
        joined[self.edges.max(axis=1)[np.abs(np.diff(self.edges, axis=1).ravel()) == 1]] = True
        zones = []
        start: int | None = None
        for i in range(len(on) + 1):
            inside = i < len(on) and on[i]
            if start is not None and not (inside and joined[i]):
                zones.append(self._zone(start, i))
                start = None
            if start is None and inside:
                start = i
        return zones

    def _closes(self) -> bool:
        """Whether a mesh edge joins the last node to the first: the contact runs around the whole outline there."""
        return bool((np.sort(self.edges, axis=1) == (0, len(self.t) - 1)).all(axis=1).any())

    def _from(self, first: int) -> ContactProfile:
        """The same profile with another first node."""
        k = len(self.t)
        of_edges = ("edges", "mean", "standing_off")
        values = {
            f.name: np.roll(getattr(self, f.name), -first, axis=0) for f in fields(self) if f.name not in of_edges
        }
        return replace(self, edges=(self.edges - first) % k, **values)

    def _zone(self, a: int, b: int) -> Zone:
        (start, before), (end, beyond) = self._edge(a, -1), self._edge(b - 1, 1)
        between = np.linalg.norm(np.diff(self.place[a:b], axis=0), axis=1).sum()
        beside = np.linalg.norm(np.diff(self.place[max(a - 1, 0) : b + 1], axis=0), axis=1)
        least = LEAST_WIDTH * float(beside.min(initial=np.inf)) if len(beside) else 0.0
        width = max(float(between + before + beyond), least)
        return Zone(start, end, float(self.pressure[a:b].max()), width, np.arange(a, b))

    def _edge(self, node: int, step: int) -> tuple[Array, float]:
        """Where the gap closes beside the outermost loaded node, and how far beyond that node [mm].

        Outside a contact the gap grows with the power 3/2 of the distance, so that gap^(2/3) is linear in it; its
        zero lies between the loaded and the first open node, or before the loaded one (negative) if that is open and
        only shares the pressure of its neighbour.
        """
        first, second = node + step, node + 2 * step
        if not 0 <= first < len(self.t):
            return self.place[node], 0.0
        near = np.linalg.norm(self.place[first] - self.place[node])
        fraction = 0.5
        if 0 <= second < len(self.t) and self.gap[second] > self.gap[first] > 0:
            rise = self.gap[second] ** (2 / 3) - self.gap[first] ** (2 / 3)
            apart = np.linalg.norm(self.place[second] - self.place[first])
            fraction = float(np.clip(1 - self.gap[first] ** (2 / 3) / rise * apart / near, -1.0, 1.0))
        return self.place[node] + fraction * (self.place[first] - self.place[node]), fraction * float(near)


def nodal_pressure(
    nodes: EdgeNodes, lengths: Array, pressure: Array, *, nodal: bool = False
) -> tuple[Array, Array, Array]:
    """Nominal pressure, load and weight of each node (see ``ContactProfile``) from the pressures at the edges' ends.

    A pressure that is already ``nodal`` is not projected: that would widen the contact by one edge.
    """
    first, second = pressure.T
    share = np.stack([2 * first + second, first + 2 * second], axis=1) * lengths[:, None] / 6
    if nodal:
        share = pressure * lengths[:, None] / 2
    weight = nodes.total(np.repeat(lengths / 2, 2))
    load = nodes.total(share)
    load = np.where(load > 1e-9 * load.max(initial=0.0), load, 0.0)
    if nodal:
        return load / weight, load, weight
    lumped = load / weight - _grading_bias(nodes, lengths, weight, pressure.mean(axis=1))
    nominal = np.maximum(lumped, 0.0)
    nominal[load <= 0] = 0.0
    return nominal, np.maximum(load + _gathered(nodes, lengths, lumped, load), 0.0), weight


def _gathered(nodes: EdgeNodes, lengths: Array, lumped: Array, load: Array) -> Array:
    """Correction of the nodes' loads for the error of lumping: load moves from lower to higher pressures [N/mm].

    The lumped projection of a pressure of curvature p'' is off by ``h^2 p''/12``: in the middle of a contact of four
    edges' width 4 % of the pressure, and so of the wear, are missing. A load of ``h (p_i - p_j) / 12`` moved over each
    edge corrects this to ``O(h^4)`` and still damps waves of two edges. No node gives away more than its load:
    antidiffusive fluxes of Boris & Book (J. Comput. Phys. 11 (1973) 38).
    """
    first, second = nodes.of_edges.T
    flow = lengths * (lumped[first] - lumped[second]) / 12
    giver = np.where(flow > 0, second, first)
    most = load / np.maximum(np.bincount(giver, minlength=len(load)), 1)
    flow = np.clip(flow, -most[giver], most[giver])
    return _summed(first, flow, len(load)) - _summed(second, flow, len(load))


def _grading_bias(nodes: EdgeNodes, lengths: Array, apart: Array, mean: Array) -> Array:
    """Error of lumping for a pressure of slope s between edges of lengths a and b, ``s (b - a) / 3``."""
    after, before = nodes.of_edges.T  # the node that ends an edge has it before itself
    n = len(nodes.t)

    def jump(values: Array) -> Array:
        return _summed(after, values, n) - _summed(before, values, n)

    return np.where(nodes.meeting == 2, jump(mean) / apart * jump(lengths) / 3, 0.0)


def _summed(index: NDArray[np.intp], values: Array, n: int) -> Array:
    """Sum of the values at each of n places, of whose numbers they have one each."""
    return np.bincount(index, values, n)  # type: ignore[return-value] # NumPy's stub knows counts only, no weights
