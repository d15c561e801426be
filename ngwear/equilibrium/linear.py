"""Sparse direct solvers, chosen by the matrix and the installation; the residual of each solve is checked."""

from __future__ import annotations

import importlib.util
from functools import lru_cache

import ngsolve as ng
import numpy as np
from netgen.libngpy._meshing import NgException
from numpy.typing import NDArray
from pyngcore import Array_D_S, Array_I_S

RESIDUAL_TOLERANCE = 1e-6  # of a solve; worse is a singular matrix: sound ones are refined below 1e-8
REFINE_ABOVE = 1e-8  # relative residual from which a solve is refined: the factorisation does not pivot freely
REFINEMENTS = 8  # at most: each gains digits, or the factorisation is of no use


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
    outline : ng.la.SparseMatrixd
    unknowns : array of int, shape (elements, n)
        Numbers of the unknowns of each element.
    """

    def __init__(self, outline: ng.la.SparseMatrixd, unknowns: NDArray[np.int64]) -> None:
        size = outline.height
        _, columns, rows = (np.array(part).astype(np.int64) for part in outline.CSR())
        edge = np.repeat(np.arange(size), np.diff(rows)) * size + columns
        inside = (unknowns[:, :, None] * size + unknowns[:, None, :]).ravel()
        diagonal = np.arange(size) * (size + 1)
        places = np.sort(np.concatenate([edge, inside, diagonal]))
        places = places[np.concatenate([[True], places[1:] > places[:-1]])]
        self._edge, self._inside = np.searchsorted(places, edge), np.searchsorted(places, inside)
        count = len(places)
        entries = Array_I_S(count), Array_I_S(count), Array_D_S(count)  # Python lists are very slow
        for array, numbers in zip(entries, (places // size, places % size, 0.0), strict=True):
            array.NumPy()[:] = numbers  # pyright: ignore[reportAttributeAccessIssue] NGSolve's stubs lack it
        self.matrix = ng.la.SparseMatrixd.CreateFromCOO(*entries, size, size)

    def fill(self, outline: ng.BaseMatrix, elements: NDArray[np.float64]) -> None:
        """Set the entries; ``elements`` of shape (elements, n, n)."""
        values = self.matrix.AsVector().FV().NumPy()
        values[:] = np.bincount(self._inside, elements.ravel(), minlength=len(values))
        values[self._edge] += outline.AsVector().FV().NumPy()


class DirectSolver:
    """Factorise a tangent matrix again and again, reusing the symbolic part.

    Symmetric matrices take LDL^T, unsymmetric ones LU: by ``pardiso`` if the ``fast`` extra is installed, else by
    ``sparsecholesky`` and ``umfpack``. NGSolve's ``sparsecholesky`` returns a wrong solution for an unsymmetric matrix
    without an error; here the residual of every solve is checked.

    With PARDISO (in its reproducible mode) the same matrix and right side give the same solution, bit for bit, so that
    a resumed run gives the same numbers; ``sparsecholesky`` differs from one factorisation to the next by rounding.
    PARDISO keeps the ordering and scaling of the first matrix; with another contact a matrix can then lose all but one
    digit. So the first matrix depends on the pattern only (diagonal 1, small pseudo-random numbers elsewhere, which
    make it pivot), and each matrix is scaled here.

    Parameters
    ----------
    matrix : ng.la.SparseMatrixd
    free : ng.BitArray
        Unknowns that are not prescribed.
    symmetric : bool
    stiff : slice
        Unknowns with a stiffness on the diagonal (displacements); the others are scaled by their coupling to these.
    """

    def __init__(self, matrix: ng.la.SparseMatrixd, free: ng.BitArray, *, symmetric: bool, stiff: slice) -> None:
        self.matrix, self.free = matrix, free
        self._mask = np.fromiter(free, dtype=bool, count=len(free))
        if has_pardiso():
            # iparm33: reproducible on that many threads. Refinement is done, and its need seen, below.
            self.name = "pardiso"
            self.flags = {"ordering": "metis", "symmetric": symmetric, "refinement": 0, "iparm33": ng.GetNumThreads()}
        else:
            self.name, self.flags = "sparsecholesky" if symmetric else "umfpack", {}
        _, columns, rows = (np.array(part).astype(np.int64) for part in matrix.CSR())
        self._columns = columns
        self._rows = np.repeat(np.arange(matrix.height), np.diff(rows))
        self._diagonal = np.flatnonzero(self._rows == columns)
        is_stiff = np.zeros(matrix.height, dtype=bool)
        is_stiff[stiff] = True
        # Entries that couple another unknown to a stiff one.
        self._couplings = np.flatnonzero(~is_stiff[self._rows] & is_stiff[columns])
        self._unit: NDArray[np.float64] | float = 1.0  # what makes the matrix's entries near 1
        self._scale: NDArray[np.float64] | float = 1.0  # what it has been scaled by
        self._inverse: ng.BaseMatrix | None = None

    def factorise(self) -> bool:
        """Factorise the matrix as it is now, scaling it in its place; False if it is singular."""
        values = self.matrix.AsVector().FV().NumPy()
        self._unit = self._scaling(values)
        if self.name == "pardiso":
            self._scale = self._unit
            values *= self._scale[self._rows] * self._scale[self._columns]
        try:
            if self._inverse is None:
                now = values.copy()
                if self.name == "pardiso":
                    values[:] = np.random.default_rng(0).uniform(-0.01, 0.01, len(values))
                    values[self._diagonal] = 1.0
                self._inverse = self.matrix.Inverse(self.free, inverse=self.name, flags=self.flags)
                values[:] = now
                if self.name != "pardiso":
                    return True
            self._inverse.Update()
        except (NgException, RuntimeError):  # NGSolve's and PARDISO's
            self._inverse = None
            return False
        return True

    def _scaling(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Factors of rows and columns that bring stiffnesses, and the couplings to them, near 1."""
        size = np.zeros(len(self._mask))
        size[self._rows[self._diagonal]] = np.sqrt(np.abs(values[self._diagonal]))
        at, to = self._rows[self._couplings], size[self._columns[self._couplings]]
        coupling = np.abs(values[self._couplings]) / np.where(to > 0, to, np.inf)
        np.maximum.at(size, at, coupling)
        return 1 / np.where(size > 0, size, 1.0)

    def scaled_norm(self, residual: ng.BaseVector) -> float:
        """Norm of a residual, scaled so that displacements and other unknowns have equal weight."""
        return float(np.linalg.norm((self._unit * residual.FV().NumPy())[self._mask]))

    def scaled_length(self, correction: ng.BaseVector) -> float:
        """Norm of a correction, scaled so that displacements and other unknowns have equal weight."""
        return float(np.linalg.norm((correction.FV().NumPy() / self._scale)[self._mask]))

    def solve(self, right_side: ng.BaseVector, solution: ng.BaseVector) -> float:
        """Solve into ``solution``; return the relative residual (inf if not finite)."""
        scaled, rest = right_side.CreateVector(), right_side.CreateVector()
        scaled.FV().NumPy()[:] = self._scale * right_side.FV().NumPy()
        scale = norm(scaled, self._mask)
        if scale == 0.0:
            solution[:] = 0.0
            return 0.0
        solution.data = self._inverse * scaled
        rest.data = scaled - self.matrix * solution
        residual = norm(rest, self._mask) / scale
        for _ in range(REFINEMENTS):
            if not residual > REFINE_ABOVE:
                break
            solution.data += self._inverse * rest
            rest.data = scaled - self.matrix * solution
            residual = norm(rest, self._mask) / scale
        values = solution.FV().NumPy()
        values *= self._scale
        return residual if residual == residual else float("inf")
