"""Invariants of the right Cauchy-Green tensor at many points at once, and their slopes by the strain.

Components come first, each an array over the points: a point's small matrices would cost several times as much.
"""

from __future__ import annotations

import abc
import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Entries = dict[tuple[int, int], Any]


class Invariants(abc.ABC):
    """I1, I2 of C and J = det F, and their slopes by the n components q of the deformation.

    Attributes
    ----------
    i1, i2, j, p : array
        Invariants [-] and volumetric stress [MPa].
    g1, g2, gj : list of n arrays
        Slopes of I1, I2 and J by q.
    """

    i1: Array
    i2: Array
    j: Array
    p: Array
    g1: list[Array]
    g2: list[Array]
    gj: list[Array]

    @staticmethod
    def of(strain: Array) -> Invariants:
        """Invariants at strains of a section, shape (..., 6), or of a solid, shape (..., 10)."""
        parts = np.array(np.moveaxis(strain, -1, 0), order="C")  # a copy of its own
        return Section(parts) if len(parts) == 6 else Solid(parts)

    @abc.abstractmethod
    def curvature(self, f1: Any, f2: Any, fj: Any) -> Entries:
        """Entries of ``f1 I1'' + f2 I2'' + fj J''``, the second derivatives by q, in and above the diagonal."""

    @abc.abstractmethod
    def push(self, symmetric: Array) -> list[Array]:
        """``d(H : C / 2) / dq`` of a symmetric tensor H, whose components stand in the last axis; n arrays."""

    @staticmethod
    @abc.abstractmethod
    def metric(symmetric: Array) -> Entries:
        """Second derivatives of ``H : C / 2`` by q, in and above the diagonal."""

    @abc.abstractmethod
    def pull(self, stress: Array) -> Array:
        """Second Piola stress ``F^-1 P``, symmetric, of the stress conjugate to q; components in the last axis."""

    @property
    @abc.abstractmethod
    def stretching(self) -> Array:
        """Right Cauchy-Green tensor C, components in the last axis, those off the diagonal doubled."""


class Section(Invariants):
    """``q = (F_xx, F_xy, F_yx, F_yy, hoop)``; symmetric tensors are (xx, yy, xy, hoop)."""

    def __init__(self, parts: Array) -> None:
        parts[[0, 3, 4]] += 1.0
        self.gradient, self.hoop, self.p = parts[:4], parts[4], parts[5]
        xx, xy, yx, yy = self.gradient
        hoop = self.hoop
        self._trace, self._det = xx * xx + xy * xy + yx * yx + yy * yy, xx * yy - xy * yx
        self._square = hoop * hoop
        self._cofactor = (yy, -yx, -xy, xx)
        self.i1, self.i2 = self._trace + self._square, self._det * self._det + self._square * self._trace
        self.j = self._det * hoop
        self.g1 = [2 * f for f in self.gradient] + [2 * hoop]
        det2, square2 = 2 * self._det, 2 * self._square
        self.g2 = [det2 * c + square2 * f for c, f in zip(self._cofactor, self.gradient, strict=True)]
        self.g2.append(2 * hoop * self._trace)
        self.gj = [hoop * c for c in self._cofactor] + [self._det]

    def curvature(self, f1: Any, f2: Any, fj: Any) -> Entries:
        f, c, hoop = self.gradient, self._cofactor, self.hoop
        entries = {(m, n): 2 * f2 * c[m] * c[n] for m in range(4) for n in range(m, 4)}
        for k in range(4):
            entries[k, k] += 2 * f1 + 2 * f2 * self._square
            entries[k, 4] = 4 * f2 * hoop * f[k] + fj * c[k]
        across = 2 * f2 * self._det + fj * hoop
        entries[0, 3] += across
        entries[1, 2] -= across
        entries[4, 4] = 2 * f1 + 2 * f2 * self._trace
        return entries

    def push(self, symmetric: Array) -> list[Array]:
        xx, yy, xy, hoop = np.moveaxis(symmetric, -1, 0)
        f = self.gradient
        rows = [(xx * f[k] + xy * f[k + 1], xy * f[k] + yy * f[k + 1]) for k in (0, 2)]
        return [*rows[0], *rows[1], hoop * self.hoop]

    @staticmethod
    def metric(symmetric: Array) -> Entries:
        xx, yy, xy, hoop = np.moveaxis(symmetric, -1, 0)
        return {(0, 0): xx, (1, 1): yy, (0, 1): xy, (2, 2): xx, (3, 3): yy, (2, 3): xy, (4, 4): hoop}

    def pull(self, stress: Array) -> Array:
        p = np.moveaxis(stress, -1, 0)
        xx, xy, yx, yy = self.gradient
        parts = (yy * p[0] - xy * p[2], xx * p[3] - yx * p[1], yy * p[1] - xy * p[3])
        return np.stack([*(part / self._det for part in parts), p[4] / self.hoop], axis=-1)

    @property
    def stretching(self) -> Array:
        xx, xy, yx, yy = self.gradient
        return np.stack([xx**2 + yx**2, xy**2 + yy**2, 2 * (xx * xy + yx * yy), self.hoop**2], axis=-1)


PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))  # components of a symmetric tensor of a solid


class Solid(Invariants):
    """``q = (F_xx, F_xy, ..., F_zz)``; symmetric tensors are (xx, yy, zz, xy, xz, yz)."""

    def __init__(self, parts: Array) -> None:
        parts[[0, 4, 8]] += 1.0
        self.p = parts[9]
        self._f = f = parts[:9].reshape(3, 3, *parts.shape[1:])
        self._c = np.einsum("ki...,kj...->ij...", f, f)
        self._b = np.einsum("ik...,jk...->ij...", f, f)
        self.i1 = np.einsum("ii...->...", self._c)
        self.i2 = 0.5 * (self.i1**2 - (self._c * self._c).sum(axis=(0, 1)))
        self._cofactor = np.stack([np.cross(f[(i + 1) % 3], f[(i + 2) % 3], axis=0) for i in range(3)])
        self.j = (f[0] * self._cofactor[0]).sum(axis=0)
        g2 = 2 * (self.i1 * f - np.einsum("ik...,kj...->ij...", f, self._c))
        self.g1, self.g2, self.gj = list(2 * parts[:9]), list(g2.reshape(parts[:9].shape)), self._flat(self._cofactor)

    @staticmethod
    def _flat(tensor: Array) -> list[Array]:
        return list(tensor.reshape(9, *tensor.shape[2:]))

    def curvature(self, f1: Any, f2: Any, fj: Any) -> Entries:
        f, c, b = self._f, self._c, self._b
        twice, entries = 2 * f2, {}
        for m, n in itertools.combinations_with_replacement(range(9), 2):
            (i, j), (k, o) = divmod(m, 3), divmod(n, 3)
            entry = 2 * f[i, j] * f[k, o] - f[i, o] * f[k, j]
            if i == k:
                entry -= c[o, j]
            if j == o:
                entry -= b[i, k]
            entry *= twice
            if m == n:
                entry += 2 * f1 + twice * self.i1
            elif i != k and j != o:
                sign = 1.0 if (k - i) % 3 == (o - j) % 3 else -1.0
                entry += sign * fj * f[3 - i - k, 3 - j - o]
            entries[m, n] = entry
        return entries

    def push(self, symmetric: Array) -> list[Array]:
        return self._flat(np.einsum("ik...,kj...->ij...", self._f, _full(symmetric)))

    @staticmethod
    def metric(symmetric: Array) -> Entries:
        full = _full(symmetric)
        return {(3 * i + j, 3 * i + k): full[j, k] for i in range(3) for j in range(3) for k in range(j, 3)}

    def pull(self, stress: Array) -> Array:
        p = np.moveaxis(stress, -1, 0)[:9].reshape(self._f.shape)
        return np.stack([(self._cofactor[:, i] * p[:, j]).sum(axis=0) / self.j for i, j in PAIRS], axis=-1)

    @property
    def stretching(self) -> Array:
        return np.stack([(1.0 if i == j else 2.0) * self._c[i, j] for i, j in PAIRS], axis=-1)


def _full(symmetric: Array) -> Array:
    """Matrices, components first, of symmetric tensors (xx, yy, zz, xy, xz, yz) in the last axis."""
    xx, yy, zz, xy, xz, yz = np.moveaxis(symmetric, -1, 0)
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
