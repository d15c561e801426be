"""Viscoelasticity in steady sliding: relaxation while the material flows past the slider."""

from __future__ import annotations

import math

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT, Array, Unknowns
from ngwear.effects.invariants import Invariants
from ngwear.effects.memory import Memory, step_factors
from ngwear.errors import SceneError
from ngwear.fields.streamlines import StreamGrid
from ngwear.fields.transfer import PointSearch
from ngwear.materials import Hyperelastic, PronySeries


class SteadyMemory(Memory):
    """Arms of a generalised Maxwell model in the frame of a slider that moves along its track at constant speed.

    The material flows through the frame at -V along rows of the grid, so that time along a row is ``t = -x / V``, and
    the overstress of each arm is an integral along its row:

        Q_i = gamma_i (S - R_i S),   (R_i S)(x) = int_0^inf exp(-s / tau_i) S(x + V s) ds / tau_i.

    R_i is integrated exactly for an S that is linear between the columns of the grid, one sweep an arm, and
    Q_i taken half-way between them, where the slope of such an S is right to second order. A solve takes ``share``
    of the arms' stiffness implicitly and the rest as a known tensor, ``h = sum Q_i - share S``;
    ``equilibrium.steady_sliding`` repeats until h agrees with S.

    On a straight track the material enters relaxed and undeformed: the grid must reach far enough upstream. On a
    circular track it enters as it left, after relaxing undeformed on the rest of the circle: the stationary state after
    many rounds.

    Parameters
    ----------
    material : Hyperelastic
    series : PronySeries
    grid : StreamGrid
    """

    def __init__(self, material: Hyperelastic, series: PronySeries, grid: StreamGrid) -> None:
        super().__init__(material, series)
        self.grid = grid

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        self.lay(unknowns)
        self._unknowns = unknowns
        self._search = PointSearch(unknowns.body.mesh, self.grid.places, unknowns.body.deformation)
        self._points = unknowns.points.places
        self._to_points = self.grid.between(self._points.reshape(-1, self._points.shape[-1]))

    @property
    def nbytes(self) -> int:
        """Computer memory of the history and of its interpolation [bytes]; independent of the number of arms."""
        way = self._to_points
        return self.history.nbytes + self.grid.places.nbytes + way.data.nbytes + way.indices.nbytes + way.indptr.nbytes

    def set_speed(self, speed: float, wavelength: float) -> None:
        """Sliding speed [mm/s], and the length 2 pi / k of a pressure wave that sets the implicit share.

        The share changes the convergence, not the solution. A quarter of the pressure's own wave prevents short waves
        at the ends of a contact from growing in the iteration.
        """
        if not speed > 0:
            raise SceneError("speed", speed, "steady sliding needs a speed above 0 mm/s; at rest solve the equilibrium")
        gap = np.diff(self.grid.columns) / speed
        self._factors = [(*step_factors(gap, time), *step_factors(gap / 2, time)) for time in self.times]
        around = 2 * np.pi * self.grid.track_radius - np.ptp(self.grid.columns)
        self._around = np.exp(-around / speed / self.times)  # 0 on a straight track
        x = 2 * np.pi * speed / wavelength * self.times
        self.share = float((self.ratios * x * x / (1 + x * x)).sum())

    def _overstress(self, strain: Array) -> Array:
        """``sum Q_i`` half-way between the columns, shape (rows, columns - 1, k) [MPa], of strains on the grid."""
        stress = self.grid.turned(self.second_piola(strain), self.grid.places)
        stress = stress.reshape(*self.grid.shape, -1)
        middle = 0.5 * (stress[:, 1:] + stress[:, :-1])
        total = np.zeros_like(middle)
        for ratio, factors, around in zip(self.ratios, self._factors, self._around, strict=True):
            entering = stress[:, -1]
            if self.grid.circular:
                leaving, _ = self._relaxed(stress, middle, np.zeros_like(entering), factors)
                entering = around * leaving / (1 - around * math.prod(factors[0]))
            _, relaxed = self._relaxed(stress, middle, entering, factors)
            total += ratio * (middle - relaxed)
        return total

    @staticmethod
    def _relaxed(stress: Array, middle: Array, entering: Array, factors: tuple[Array, ...]) -> tuple[Array, Array]:
        """R_i S where the material leaves the grid, and half-way between the columns."""
        found, now = np.empty_like(middle), entering
        for i, (decay, mean, half_decay, half_mean) in reversed(list(enumerate(zip(*factors, strict=True)))):
            found[:, i] = (
                half_decay * now + (1 - half_mean) * middle[:, i] + (half_mean - half_decay) * stress[:, i + 1]
            )
            now = decay * now + (1 - mean) * stress[:, i] + (mean - decay) * stress[:, i + 1]
        return now, found

    def follow(self, strain: Array) -> Array:
        """The history h that belongs to the present state, whose strains at the points are given [MPa]."""
        grid = self._overstress(self._grid_strain())
        there = (self._to_points @ grid.reshape(-1, grid.shape[-1])).reshape(*self._points.shape[:-1], -1)
        return self.grid.turned(there, self._points, back=True) - self.share * self.second_piola(strain)

    def drag(self) -> float:
        """Work that the overstress does on the material per length of track [N/mm, or N]; the friction force's.

        ``-int sum Q_i : dC/dx / 2``: the elastic work sums to zero along a track that starts and ends undeformed. The
        integral is computed on the grid, with strains averaged at the mesh's vertices: jumps of the gradient between
        elements would count as dissipation.
        """
        strain = self._grid_strain(smooth=True)
        stretching = Invariants.of(strain).stretching
        double = np.where(np.arange(stretching.shape[-1]) < 3, 1.0, 2.0) if self.grid.circular else 1.0
        c = self.grid.turned(stretching / double, self.grid.places) * double
        change = np.diff(c.reshape(*self.grid.shape, -1), axis=1)
        return float(-0.5 * self.grid.areas @ (self._overstress(strain) * change).sum(axis=(1, 2)))

    def _grid_strain(self, *, smooth: bool = False) -> Array:
        """Strains at the grid's points; the volumetric stress is left out."""
        u, mesh = self._unknowns.state[DISPLACEMENT], self._unknowns.body.mesh
        gradient = ng.Grad(u)
        if smooth:
            gradient = ng.GridFunction(ng.MatrixValued(ng.H1(mesh, order=1), mesh.dim))
            gradient.Set(ng.Grad(u))
        parts = [self._search(gradient)]
        if mesh.dim == 2:
            parts.append(self._search(self._unknowns.kinematics.hoop_stretch(u)) - 1)
        return np.column_stack([*parts, np.zeros(len(parts[0]))])
