"""What a contact looks like along the outline: nodal pressures, gaps and zones."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ngwear.geometry.body import Body

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Zone:
    """One connected piece of the contact.

    Attributes
    ----------
    start, end : array, shape (2,)
        Deformed coordinates of its ends [mm]; the ends lie between nodes, where P² falls to zero.
    peak : float
        Largest Cauchy pressure [MPa].
    width : float
        Deformed length along the outline [mm].
    nodes : slice
        Nodes that carry pressure.
    """

    start: Array
    end: Array
    peak: float
    width: float
    nodes: slice


@dataclass(frozen=True)
class ContactProfile:
    """Nodal values along a contact's edges, in the order of the outline.

    The unknown pressure jumps between mesh edges; the nodal one is its lumped L2 projection
    ``P_i = int P phi_i ds / int phi_i ds``, which keeps the load and damps the jumps.

    Attributes
    ----------
    t : array, shape (k,)
        Contour parameter of each node.
    reference, place : array, shape (k, 2)
        Coordinates on the undeformed and on the deformed outline [mm].
    nominal_pressure : array, shape (k,)
        P, force per reference area [MPa].
    pressure : array, shape (k,)
        Cauchy pressure P / (da/dA) [MPa].
    gap : array, shape (k,)
        Distance from the surface [mm].
    """

    t: Array
    reference: Array
    place: Array
    nominal_pressure: Array
    pressure: Array
    gap: Array

    @classmethod
    def from_samples(
        cls, body: Body, positions: NDArray[np.intp], *, pressure: Array, stretch: Array, place: Array, gap: Array
    ) -> ContactProfile:
        """Build from samples at both ends of each mesh edge; ``place`` of shape (m, 2, 2), the others (m, 2)."""
        ends = body.outline.t[positions]
        n = len(body.base)
        length = np.linalg.norm(body.contour.at(ends[:, 1]) - body.contour.at(ends[:, 0]), axis=1)
        first, second = pressure.T
        share = np.stack([2 * first + second, first + 2 * second], axis=1) * length[:, None] / 6
        t, node = np.unique(np.round(ends % n, 9), return_inverse=True)
        node = node.reshape(ends.shape)

        def lumped(values: Array) -> Array:
            return np.bincount(node.ravel(), values.ravel(), len(t))

        weight = lumped(np.repeat(length[:, None] / 2, 2, axis=1))
        count = lumped(np.ones_like(ends))
        nominal = np.maximum(lumped(share) / weight, 0.0)
        where = np.stack([lumped(place[..., k]) / count for k in range(2)], axis=1)
        return cls(
            t=t,
            reference=body.contour.at(t),
            place=where,
            nominal_pressure=nominal,
            pressure=nominal / (lumped(stretch) / count),
            gap=lumped(gap) / count,
        )

    def zones(self, *, threshold: float = 1e-3) -> list[Zone]:
        """Connected pieces where the pressure exceeds ``threshold`` times its maximum."""
        p = self.pressure
        on = p > max(threshold * p.max(initial=0.0), 1e-12)
        jump = np.flatnonzero(np.diff(np.concatenate([[False], on, [False]]).astype(int)))
        return [self._zone(a, b) for a, b in zip(jump[::2], jump[1::2], strict=True)]

    def _zone(self, a: int, b: int) -> Zone:
        start, end = self._edge(a, -1), self._edge(b - 1, 1)
        inner = self.place[a:b]
        path = np.vstack([start, inner, end]) if b - a > 1 else np.vstack([start, end])
        width = float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
        return Zone(start, end, float(self.pressure[a:b].max()), width, slice(a, b))

    def _edge(self, node: int, step: int) -> Array:
        """Where P² would fall to zero beyond the outermost loaded node, at most one mesh edge away."""
        ahead, behind = node + step, node - step
        if not 0 <= ahead < len(self.t):
            return self.place[node]
        fraction = 0.5
        if 0 <= behind < len(self.t) and self.pressure[behind] > self.pressure[node]:
            slope = self.pressure[behind] ** 2 - self.pressure[node] ** 2
            inner = np.linalg.norm(self.place[node] - self.place[behind])
            outer = np.linalg.norm(self.place[ahead] - self.place[node])
            fraction = float(np.clip(self.pressure[node] ** 2 / slope * inner / outer, 0.0, 1.0))
        return self.place[node] + fraction * (self.place[ahead] - self.place[node])
