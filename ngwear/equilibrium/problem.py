"""The effects' terms summed into one nonlinear problem on one body."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import ngsolve as ng
import numpy as np
from netgen.libngpy._meshing import NgException
from numpy.typing import NDArray

from ngwear import NUMPY_CAME_FIRST
from ngwear.effects.base import DISPLACEMENT, VOLUMETRIC_STRESS, Term, Unknowns, VolumeTerm
from ngwear.equilibrium.linear import DirectSolver, Tangent
from ngwear.errors import SceneError
from ngwear.fields.displacements import displacements
from ngwear.fields.kinematics import Kinematics
from ngwear.fields.material_points import MaterialPoints
from ngwear.geometry.meshed import Meshed

if TYPE_CHECKING:
    from threadpoolctl import ThreadpoolController

Array = NDArray[np.float64]
# As measured on two cores with PARDISO.
THREADED_FROM = 60_000  # unknowns; below, two threads take more time waking each other than they save

IMBALANCE = "imbalance"

Loads = Mapping[str, float]


@dataclass(frozen=True)
class FixedEdges:
    """Edges whose displacement is prevented in some directions.

    Parameters
    ----------
    edges : sequence of str
    x, y, z : bool
        Whether the component is held at zero.
    """

    edges: Sequence[str]
    x: bool = True
    y: bool = True
    z: bool = True


class Problem:
    """Find the stationary point of the terms' energies and forms.

    Parameters
    ----------
    body : Meshed
    kinematics : Kinematics
    terms : sequence of Term
        Effects that are not listed add no unknown, no memory and no zero term.
    supports : sequence of FixedEdges
    order : int
        Polynomial order of the displacement.
    """

    def __init__(
        self,
        body: Meshed,
        kinematics: Kinematics,
        terms: Sequence[Term],
        *,
        supports: Sequence[FixedEdges] = (),
        order: int = 2,
    ) -> None:
        self.body, self.kinematics, self.terms = body, kinematics, tuple(terms)
        held = {
            axis: "|".join(e for s in supports if getattr(s, axis) for e in s.edges) for axis in "xyz"[: body.mesh.dim]
        }
        for support in supports:
            body.boundary(support.edges)
        flags = {f"dirichlet{axis}": names for axis, names in held.items() if names}
        spaces: dict[str, ng.FESpace] = {DISPLACEMENT: displacements(body.mesh, order, **flags)}
        for term in self.terms:
            spaces |= term.spaces(body)
        self.names = tuple(spaces)
        self.space = ng.FESpace(list(spaces.values()))
        self.state = ng.GridFunction(self.space)
        self.fields = dict(zip(self.names, self.state.components, strict=True))
        self.form = ng.BilinearForm(self.space, check_unused=False)
        self._volume = [term for term in self.terms if isinstance(term, VolumeTerm)]
        self._points: MaterialPoints | None = None
        if self._volume:
            on = (spaces[DISPLACEMENT].components[0], spaces[VOLUMETRIC_STRESS])
            places = {"displacement": self.part(DISPLACEMENT), "pressure": self.part(VOLUMETRIC_STRESS)}
            self._points = MaterialPoints(body, kinematics, *on, **places)
        unknowns = Unknowns(
            body=body,
            kinematics=kinematics,
            trial=dict(zip(self.names, self.space.TrialFunction(), strict=True)),
            test=dict(zip(self.names, self.space.TestFunction(), strict=True)),
            state=self.fields,
            inside=self._points,
        )
        for term in self.terms:
            term.add_to(self.form, unknowns)
        self._held = ~np.fromiter(self.free, dtype=bool, count=self.space.ndof)
        self.symmetric = all(term.symmetric for term in self.terms)
        self.parameters: dict[str, ng.Parameter] = {}
        for term in self.terms:
            self.parameters |= term.loads
        self._imbalance: ng.BaseVector | None = None
        self._matrix: Tangent | None = None
        self.solver: DirectSolver | None = None

    @property
    def points(self) -> MaterialPoints:
        """The material points; SceneError if no term is of the part's inside."""
        if self._points is None:
            raise SceneError("terms", self.names, "no term acts inside the part: there are no material points")
        return self._points

    def freeze_imbalance(self) -> None:
        """Take the present residual as a fictitious load, so that the present state is an equilibrium.

        The load ``"imbalance"`` is set to 1; its decrease to 0 leads from any admissible state to the solution
        (Newton homotopy).
        """
        self._imbalance = None
        vector = self.state.vec.CreateVector()
        self.residual(vector)
        self._imbalance = vector
        self.parameters[IMBALANCE] = ng.Parameter(1.0)

    def drop_imbalance(self) -> None:
        """Remove the fictitious load."""
        self._imbalance = None
        self.parameters.pop(IMBALANCE, None)

    @property
    def free(self) -> ng.BitArray:
        """Unknowns that are not prescribed."""
        return self.space.FreeDofs()

    def part(self, name: str) -> slice:
        """Return where the named unknown stands in the state vector."""
        where = self.space.Range(self.names.index(name))
        return slice(where.start, where.stop)

    def set_loads(self, loads: Loads) -> None:
        """Set the terms' loads; SceneError names a load that no term has."""
        for name, value in loads.items():
            if name not in self.parameters:
                raise SceneError(
                    "program", name, f"no effect of the scene takes this load; known: {sorted(self.parameters)}"
                )
            self.parameters[name].Set(value)

    def get_loads(self) -> dict[str, float]:
        """The loads as they are."""
        return {name: parameter.Get() for name, parameter in self.parameters.items()}

    def set_time_step(self, step: float) -> None:
        """Length of the step that is solved next [s], for the terms that know time."""
        for term in self.terms:
            term.set_time_step(step)

    def commit(self) -> None:
        """Accept the present state: memory moves to it."""
        strain = np.empty(0) if self._points is None else self._points.strain(self.state.vec.FV().NumPy())
        for term in self.terms:
            term.commit(strain)

    @contextmanager
    def threads(self) -> Iterator[None]:
        """Context of a solve: all cores if the problem is large enough to gain by them, else one; BLAS has one.

        The products here are too small for several threads, and waiting threads would take the core of a run beside
        this one.
        """
        large = self.space.ndof >= THREADED_FROM
        with _blas_on_one_thread(), ng.TaskManager() if large else nullcontext():
            yield

    def residual(self, out: ng.BaseVector) -> None:
        """Write the residual at the present state, zero on prescribed unknowns."""
        for term in self.terms:
            term.gather()
        self.form.Apply(self.state.vec, out)
        values = out.FV().NumPy()
        if self._points is not None:
            stress, _ = self._response(tangent=False)
            forces = self._points.forces(stress)
            values += np.bincount(self._points.unknowns.ravel(), forces.ravel(), minlength=len(values))
        values[self._held] = 0.0
        if self._imbalance is not None:
            out.data -= self.parameters[IMBALANCE].Get() * self._imbalance

    def limit(self, correction: ng.BaseVector) -> None:
        """Shorten a correction, to be subtracted from the state, where a term bounds its displacement; in place."""
        for term in self.terms:
            term.limit(correction.FV().NumPy()[self.part(DISPLACEMENT)])

    def assemble(self) -> ng.la.SparseMatrixd:
        """The tangent at the present state."""
        self.form.AssembleLinearization(self.state.vec)
        if self._points is None:
            return self.form.mat
        _, slope = self._response(tangent=True)
        if self._matrix is None:
            self._matrix = Tangent(self.form.mat, self._points.unknowns)
        self._matrix.fill(self.form.mat, self._points.stiffness(slope))
        return self._matrix.matrix

    def _response(self, *, tangent: bool) -> tuple[Array, Array]:
        """Stress of all terms inside the section, and its derivative, 0 if that is not asked for."""
        self.points.follow()
        strain = self.points.strain(self.state.vec.FV().NumPy())
        responses = [term.response(strain, tangent=tangent) for term in self._volume]
        slopes = (slope for _, slope in responses if slope is not None)
        return sum((stress for stress, _ in responses), np.zeros(())), sum(slopes, np.zeros(()))

    def jacobians(self) -> Array:
        """Least J of the present state at the material points of each element [-], shape (ne,)."""
        xx, xy, yx, yy, hoop = np.moveaxis(self.points.strain(self.state.vec.FV().NumPy())[..., :5], -1, 0)
        least: Array = (((1 + xx) * (1 + yy) - xy * yx) * (1 + hoop)).min(axis=1)
        return least

    def most_squeezed(self) -> tuple[float, ...]:
        """Centre of the element of least J in the present state [mm]; empty if no term acts inside the part."""
        if self._points is None:
            return ()
        return tuple(map(float, self.points.centres[self.jacobians().argmin()]))

    def turned(self) -> float:
        """Angle by which the section has turned in the present state, counter-clockwise [degrees].

        It is the rotation in the polar decomposition of the mean deformation gradient of the plane.
        """
        strain, volumes = self.points.strain(self.state.vec.FV().NumPy()), self.points.volumes
        xx, xy, yx, yy = np.tensordot(volumes, strain[..., :4], axes=2) / volumes.sum()
        return float(np.degrees(np.arctan2(yx - xy, 2 + xx + yy)))

    def stress(self) -> tuple[Array, Array]:
        """Strains of the present state at the material points, and the stress of all terms conjugate to them [MPa]."""
        stress, _ = self._response(tangent=False)
        return self.points.strain(self.state.vec.FV().NumPy()), stress

    def hoop_force(self) -> float:
        """Radial resultant of the hoop tension of an axisymmetric part, ``2 pi int P_hoop dA`` [N], of all terms."""
        stress, _ = self._response(tangent=False)
        # The volumes are 2 pi R dA.
        return float((self.points.volumes * stress[..., 4] / self.points.radius).sum())

    def tangent(self) -> DirectSolver | None:
        """Assemble and factorise the tangent at the present state, kept as ``solver``; None if it is singular."""
        try:
            matrix = self.assemble()
        except NgException:
            return None
        if self.solver is None:
            self.solver = DirectSolver(matrix, self.free, symmetric=self.symmetric, stiff=self.part(DISPLACEMENT))
        if not self.solver.factorise():
            self.solver = None
        return self.solver


def _blas_on_one_thread() -> AbstractContextManager[object]:
    if os.environ.get("OPENBLAS_NUM_THREADS") == "1" and not NUMPY_CAME_FIRST:  # it has no other
        return nullcontext()
    return _blas().limit(limits=1)


@lru_cache(maxsize=1)
def _blas() -> ThreadpoolController:
    """The BLAS of NumPy and SciPy; PARDISO's threads are NGSolve's matter."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController().select(internal_api="openblas")
