"""Smooth continuation of a field: its free unknowns follow from the held ones by a harmonic extension."""

from __future__ import annotations

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class HarmonicFill:
    """Solve ``div grad u = 0`` (or with a given stiffness) for the free unknowns of a field.

    Uses SciPy's LU, because the rounding of NGSolve's ``sparsecholesky`` differs from call to call, and a resumed run
    must give the same numbers.

    Parameters
    ----------
    matrix : ng.la.SparseMatrixd
        Symmetric, positive definite on the free unknowns.
    free : array of bool
    """

    def __init__(self, matrix: ng.la.SparseMatrixd, free: NDArray[np.bool_]) -> None:
        from scipy.sparse import csr_array
        from scipy.sparse.linalg import splu  # slow to load, and only bodies that move need it

        self._stiffness = csr_array(tuple(np.array(part) for part in matrix.CSR()))
        self._free = np.flatnonzero(free)
        inner = self._stiffness[self._free][:, self._free].tocsc()
        # Positive definite: no pivoting, which would fill the factors.
        self._lu = splu(inner, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})

    def __call__(self, values: Array) -> Array:
        """The held values with the free values computed."""
        filled = values.copy()
        filled[self._free] = 0.0
        filled[self._free] = -self._lu.solve((self._stiffness @ filled)[self._free])
        return filled
