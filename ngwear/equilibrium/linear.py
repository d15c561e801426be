"""Sparse direct solvers: the cheapest one that is right for the matrix, its residual checked."""

from __future__ import annotations

import importlib.util
from functools import lru_cache

import ngsolve as ng

RESIDUAL_TOLERANCE = 1e-6


@lru_cache(maxsize=1)
def has_pardiso() -> bool:
    """Whether the ``fast`` extra (MKL's PARDISO) is installed and loads."""
    from importlib.metadata import PackageNotFoundError, distribution

    try:
        distribution("mkl")
    except PackageNotFoundError:
        return False
    return importlib.util.find_spec("ngsolve") is not None


class DirectSolver:
    """Factorise a tangent matrix again and again, reusing the symbolic part.

    Symmetric matrices take LDL^T (``sparsecholesky``), unsymmetric ones LU (``pardiso`` if the ``fast``
    extra is installed, else ``umfpack``). NGSolve's ``sparsecholesky`` returns nonsense for an unsymmetric
    matrix without an error; here the residual of every solve is checked.

    Parameters
    ----------
    matrix : ng.BaseMatrix
    free : ng.BitArray
        Unknowns that are not prescribed.
    symmetric : bool
    """

    def __init__(self, matrix: ng.BaseMatrix, free: ng.BitArray, *, symmetric: bool) -> None:
        self.matrix, self.free = matrix, free
        self.projector = ng.Projector(free, True)
        if symmetric:
            self.name, self.flags = "sparsecholesky", {}
        elif has_pardiso():
            self.name, self.flags = "pardiso", {"ordering": "metis"}
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
        solution.data = self._inverse * right_side
        rest = right_side.CreateVector()
        rest.data = right_side - self.matrix * solution
        rest.data = self.projector * rest
        scale = ng.Norm(self.projector * right_side)
        if scale == 0.0:
            return 0.0
        residual = ng.Norm(rest) / scale
        if residual > 1e-10:  # one step of refinement: the factorisation does not pivot freely
            correction = right_side.CreateVector()
            correction.data = self._inverse * rest
            solution.data += correction
            rest.data = right_side - self.matrix * solution
            rest.data = self.projector * rest
            residual = ng.Norm(rest) / scale
        return residual if residual == residual else float("inf")
