"""Sparse direct solvers: the cheapest one that is right for the matrix, its residual checked."""

from __future__ import annotations

import importlib.util
from functools import lru_cache

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

RESIDUAL_TOLERANCE = 1e-6
REFINE_ABOVE = 1e-8  # relative residual from which a solve is refined: the factorisation does not pivot freely
REFINEMENTS = 8


@lru_cache(maxsize=1)
def has_pardiso() -> bool:
    """Whether the ``fast`` extra (MKL's PARDISO) is installed and loads."""
    from importlib.metadata import PackageNotFoundError, distribution

    try:
        distribution("mkl")
    except PackageNotFoundError:
        return False
    return importlib.util.find_spec("ngsolve") is not None


def norm(vector: ng.BaseVector, mask: NDArray[np.bool_] | slice = slice(None)) -> float:
    """Euclidean norm of the masked entries, summed in one order whatever the threads (NGSolve's and BLAS's are not)."""
    values = vector.FV().NumPy()[mask]
    return float(np.sqrt(np.square(values).sum()))


class Tangent:
    """A sparse matrix summed from a form's matrix on the outline and element matrices inside the section.

    Parameters
    ----------
    outline : ng.BaseMatrix
    unknowns : array of int, shape (elements, n)
        Numbers of the unknowns of each element.
    """

    def __init__(self, outline: ng.BaseMatrix, unknowns: NDArray[np.int64]) -> None:
        size = outline.height
        _, columns, rows = (np.array(part).astype(np.int64) for part in outline.CSR())
        edge = np.repeat(np.arange(size), np.diff(rows)) * size + columns
        inside = (unknowns[:, :, None] * size + unknowns[:, None, :]).ravel()
        places = np.sort(np.concatenate([edge, inside]))
        places = places[np.concatenate([[True], places[1:] > places[:-1]])]
        self._edge, self._inside = np.searchsorted(places, edge), np.searchsorted(places, inside)
        self.matrix = ng.la.SparseMatrixd.CreateFromCOO(
            (places // size).tolist(), (places % size).tolist(), np.zeros(len(places)), size, size
        )

    def fill(self, outline: ng.BaseMatrix, elements: NDArray[np.float64]) -> None:
        """Set the entries; ``elements`` of shape (elements, n, n)."""
        values = self.matrix.AsVector().FV().NumPy()
        values[:] = np.bincount(self._inside, elements.ravel(), minlength=len(values))
        values[self._edge] += outline.AsVector().FV().NumPy()


class DirectSolver:
    """Factorise a tangent matrix again and again, reusing the symbolic part.

    Symmetric matrices take LDL^T, unsymmetric ones LU (``pardiso`` if the ``fast`` extra is installed, else
    ``umfpack``). NGSolve's ``sparsecholesky`` returns nonsense for an unsymmetric matrix without an error;
    here the residual of every solve is checked.

    The same matrix and right side give the same solution, bit for bit, also on several threads: a run that is
    killed and resumed repeats itself. PARDISO does so in its reproducible mode; ``sparsecholesky`` only on one
    thread, so on several PARDISO takes its place.

    Parameters
    ----------
    matrix : ng.BaseMatrix
    free : ng.BitArray
        Unknowns that are not prescribed.
    symmetric : bool
    """

    def __init__(self, matrix: ng.BaseMatrix, free: ng.BitArray, *, symmetric: bool) -> None:
        self.matrix, self.free = matrix, free
        self._mask = np.fromiter(free, dtype=bool, count=len(free))
        threads = ng.GetNumThreads()
        if symmetric and (threads == 1 or not has_pardiso()):
            self.name, self.flags = "sparsecholesky", {}
        elif has_pardiso():
            # iparm33: reproducible on that many threads. Refinement is done, and its need seen, below.
            self.name = "pardiso"
            self.flags = {"ordering": "metis", "symmetric": symmetric, "refinement": 0, "iparm33": threads}
        else:
            self.name, self.flags = "umfpack", {}
        self._inverse: ng.BaseMatrix | None = None

    def factorise(self) -> bool:
        """Factorise the matrix as it is now; False if it is singular."""
        try:
            if self._inverse is None:
                self._inverse = self.matrix.Inverse(self.free, inverse=self.name, flags=self.flags)
            else:
                self._inverse.Update()
        except ng.NgException:
            self._inverse = None
            return False
        return True

    def solve(self, right_side: ng.BaseVector, solution: ng.BaseVector) -> float:
        """Solve into ``solution``; return the relative residual (inf if not finite)."""
        scale = self._norm(right_side)
        if scale == 0.0:
            solution[:] = 0.0
            return 0.0
        solution.data = self._inverse * right_side
        rest = right_side.CreateVector()
        rest.data = right_side - self.matrix * solution
        residual = self._norm(rest) / scale
        for _ in range(REFINEMENTS):
            if not residual > REFINE_ABOVE:
                break
            solution.data += self._inverse * rest
            rest.data = right_side - self.matrix * solution
            residual = self._norm(rest) / scale
        return residual if residual == residual else float("inf")

    def _norm(self, vector: ng.BaseVector) -> float:
        return norm(vector, self._mask)
