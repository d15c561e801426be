"""Sums over the integration points of all elements of a kind at once, as products with constant matrices.

On the reference element shape functions and their slopes are the same for all elements of a kind. What differs between
elements, the Jacobian, the volumes, and stress or tangent at the points, is put together first, entry by entry, each an
array over all points; small matrix products element by element take several times as long.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int64]


class ReferenceElements:
    """The linear map B from an element's unknowns to the strains at its points, its transpose, and ``B^T D B``.

    Strains, unknowns and their order are those of ``fields.material_points``. ``place`` is to be called first, and
    again whenever the elements have moved.

    Parameters
    ----------
    shapes : array, shape (elements, points, n)
        Shape functions of a component of the displacement at the points.
    slopes : array, shape (elements, points, n, dim)
        Their slopes on the reference element.
    stress_shapes : array, shape (elements, points, m)
        Shape functions of the volumetric stress.
    kinds : sequence of arrays of int
        Numbers of the elements that share these, kind by kind.
    strains : int
        Number of strains of a point.
    hoop : bool
        Whether the hoop strain depends on the displacement (axisymmetry).
    """

    def __init__(
        self, shapes: Array, slopes: Array, stress_shapes: Array, kinds: Sequence[Index], *, strains: int, hoop: bool
    ) -> None:
        self._dim, self._strains, self._hoop = slopes.shape[-1], strains, hoop
        self._shape = shapes.shape[:2]
        n, m = shapes.shape[-1], stress_shapes.shape[-1]
        starts = [*range(0, n * self._dim + 1, n), n * self._dim + m]
        self._places = [slice(a, b) for a, b in pairwise(starts)]
        alike: dict[bytes, list[Index]] = {}  # for a low order the order of the vertices does not matter
        for members in kinds:
            content = b"".join(a[members[0]].tobytes() for a in (shapes, slopes, stress_shapes))
            alike.setdefault(content, []).append(members)
        self._kinds = []
        for groups in alike.values():
            i = groups[0][0]
            along = list(np.moveaxis(slopes[i], -1, 0))
            fields = [np.stack(along + [shapes[i]] * (hoop and k == 1), axis=1) for k in range(self._dim)]
            fields.append(stress_shapes[i][:, None])  # rows of each field: shape (points, rows, functions)
            every = slice(None) if len(alike) == 1 else np.concatenate(groups)
            self._kinds.append((every, fields, _products(fields)))

    def place(self, inverse: Array, volumes: Array, radius: Array | None) -> None:
        """Give the inverse of the Jacobian, shape (elements, points, dim, dim), the points' volumes and radii [mm]."""
        self._inverse = np.ascontiguousarray(np.moveaxis(inverse, (2, 3), (0, 1)))
        self._volumes, self._weighted = volumes, volumes * self._inverse
        self._round = self._weighted_round = np.empty(0)  # of no use without a hoop strain
        if radius is not None:
            self._round = 1 / radius
            self._weighted_round = volumes / radius

    @property
    def nbytes(self) -> int:
        """Memory of the arrays stored at the points [bytes]."""
        return self._inverse.nbytes + self._weighted.nbytes + 2 * self._round.nbytes

    def strain(self, unknowns: Array) -> Array:
        """B times unknowns of shape (elements, unknowns); shape (elements, points, strains), components apart."""
        out, dim = np.zeros((self._strains, *self._shape)), self._dim
        for f, mine in enumerate(self._places):
            rows = np.empty((*self._shape, self._kinds[0][1][f].shape[1]))
            for every, fields, _ in self._kinds:
                known = fields[f].reshape(-1, fields[f].shape[-1])
                rows[every] = (unknowns[every, mine] @ known.T).reshape(-1, *rows.shape[1:])
            if f == dim:
                out[-1] = rows[..., 0]
                continue
            for j in range(dim):
                out[dim * f + j] = sum(rows[..., k] * self._inverse[k, j] for k in range(dim))
            if self._hoop and f == 1:
                out[dim * dim] = rows[..., dim] * self._round
        return np.moveaxis(out, 0, -1)

    def forces(self, stress: Array) -> Array:
        """B^T times a stress of shape (elements, points, strains) and the volumes; shape (elements, unknowns)."""
        out = np.empty((self._shape[0], self._places[-1].stop))
        for f, mine in enumerate(self._places):
            rows = np.stack(self._pulled(f, lambda a: stress[..., a], weighted=True), axis=-1)
            for every, fields, _ in self._kinds:
                mine_rows = rows[every]
                out[every, mine] = mine_rows.reshape(len(mine_rows), -1) @ fields[f].reshape(-1, fields[f].shape[-1])
        return out

    def stiffness(self, tangent: Array) -> Array:
        """``B^T D B`` times the volumes, of a symmetric D of shape (elements, points, strains, strains).

        Shape (elements, unknowns, unknowns).
        """
        out = np.empty((self._shape[0], self._places[-1].stop, self._places[-1].stop))
        for f, mine in enumerate(self._places):
            for g, other in enumerate(self._places[f:], f):
                right = {a: self._pulled(g, partial(_entry, tangent, a)) for a in self._components(f)}
                columns = [
                    np.stack(self._pulled(f, partial(_one, right, s), weighted=True), axis=-1)
                    for s in range(len(next(iter(right.values()))))
                ]
                entries = np.stack(columns, axis=-1)
                for every, _, products in self._kinds:
                    mine_entries, known = entries[every], products[f, g]
                    block = mine_entries.reshape(len(mine_entries), -1) @ known.reshape(-1, known[0, 0, 0].size)
                    block = block.reshape(-1, *known.shape[3:])
                    out[every, mine, other] = block
                    if f != g:
                        out[every, other, mine] = block.swapaxes(1, 2)
        return out

    def _components(self, field: int) -> list[int]:
        """Strains that a field's unknowns make."""
        dim = self._dim
        if field == dim:
            return [self._strains - 1]
        return [*range(dim * field, dim * (field + 1)), *([dim * dim] if self._hoop and field == 1 else [])]

    def _pulled(self, field: int, entry: Callable[[int], Array], *, weighted: bool = False) -> list[Array]:
        """Coefficients of each row of a field on the reference element, from entries by the strains."""
        dim = self._dim
        inverse = self._weighted if weighted else self._inverse
        if field == dim:
            return [self._volumes * entry(self._strains - 1) if weighted else entry(self._strains - 1)]
        rows = [sum(inverse[k, j] * entry(dim * field + j) for j in range(dim)) for k in range(dim)]
        if self._hoop and field == 1:
            rows.append((self._weighted_round if weighted else self._round) * entry(dim * dim))
        return rows


def _entry(tangent: Array, a: int, b: int) -> Array:
    return tangent[..., a, b]


def _one(rows: dict[int, list[Array]], row: int, a: int) -> Array:
    return rows[a][row]


def _products(fields: list[Array]) -> dict[tuple[int, int], Array]:
    """Products of the rows of two fields at each point, shape (points, rows, rows, functions, functions)."""
    return {
        (f, g): np.einsum("pra,psb->prsab", fields[f], fields[g])
        for f in range(len(fields))
        for g in range(f, len(fields))
    }
