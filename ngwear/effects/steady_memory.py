"""Memory in steady sliding: what relaxes while the material flows past the slider."""

from __future__ import annotations

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT, Array, Unknowns
from ngwear.effects.memory import Memory, step_factors
from ngwear.errors import SceneError
from ngwear.fields.transfer import PointSearch
from ngwear.materials import Hyperelastic, PronySeries


class SteadyMemory(Memory):
    """Arms of a generalised Maxwell model in the frame of a slider that moves along x at constant speed.

    What the reference material carries flows through the frame at -V along rows of constant y, so that time along
    a row is ``t = -x / V`` and the arms are known at once:

        Q_i = gamma_i (S - R_i S),   (R_i S)(x) = int_0^inf exp(-s / tau_i) S(x + V s) ds / tau_i.

    R_i is integrated exactly for an S that is linear between the columns of a rectangular grid, one sweep an arm, and
    Q_i taken half-way between them, where the slope of such an S is right to second order. A solve takes ``share``
    of the arms' stiffness implicitly and the rest as a known tensor, ``h = sum Q_i - share S``;
    ``equilibrium.steady`` repeats until h agrees with S.

    Material enters relaxed and undeformed: the grid must reach upstream to where nothing happens yet.

    Parameters
    ----------
    material : Hyperelastic
    series : PronySeries
    columns, rows : array
        Coordinates x and y of the grid, rising [mm].
    """

    def __init__(self, material: Hyperelastic, series: PronySeries, *, columns: Array, rows: Array) -> None:
        super().__init__(material, series)
        self.columns, self.rows = np.asarray(columns, dtype=float), np.asarray(rows, dtype=float)
        self._speed = 0.0

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        self.lay(unknowns)
        self._unknowns = unknowns
        places = np.stack([c.ravel() for c in np.meshgrid(self.columns, self.rows)], axis=1)  # x runs fastest
        self._grid = PointSearch(unknowns.body.mesh, unknowns.body.deformation, places)
        points = unknowns.points.places
        self._column, self._across = _between(0.5 * (self.columns[1:] + self.columns[:-1]), points[..., 0])
        self._row, self._up = _between(self.rows, points[..., 1])

    def set_speed(self, speed: float, wavelength: float) -> None:
        """Sliding speed [mm/s], and the length 2 pi / k of a pressure wave that sets the implicit share.

        The share moves work between the solves and their repetition, not the solution; a quarter of the pressure's own
        wave keeps the short ones at the ends of a contact from growing in the repetition.
        """
        if not speed > 0:
            raise SceneError("speed", speed, "steady sliding needs a speed above 0 mm/s; at rest solve the equilibrium")
        self._speed = speed
        gap = np.diff(self.columns) / speed
        self._factors = [(*step_factors(gap, time), *step_factors(gap / 2, time)) for time in self.times]
        x = 2 * np.pi * speed / wavelength * self.times
        self.share = float((self.ratios * x * x / (1 + x * x)).sum())

    def _overstress(self, strain: Array) -> Array:
        """``sum Q_i`` half-way between the columns, shape (rows, columns - 1, 4) [MPa], of strains on the grid."""
        stress = self.second_piola(strain).reshape(len(self.rows), len(self.columns), 4)
        middle = 0.5 * (stress[:, 1:] + stress[:, :-1])
        total = np.zeros_like(middle)
        for ratio, (decay, mean, half_decay, half_mean) in zip(self.ratios, self._factors, strict=True):
            relaxed = stress[:, -1]  # R_i S in the first column upstream
            for i in range(len(self.columns) - 2, -1, -1):
                e, a = half_decay[i], half_mean[i]
                here = e * relaxed + (1 - a) * middle[:, i] + (a - e) * stress[:, i + 1]
                total[:, i] += ratio * (middle[:, i] - here)
                e, a = decay[i], mean[i]
                relaxed = e * relaxed + (1 - a) * stress[:, i] + (a - e) * stress[:, i + 1]
        return total

    def follow(self, strain: Array) -> Array:
        """The history h that belongs to the present state, whose strains at the points are given [MPa]."""
        grid, column, row = self._overstress(self._grid_strain()), self._column, self._row
        across, up = self._across[..., None], self._up[..., None]
        low = (1 - across) * grid[row, column] + across * grid[row, column + 1]
        high = (1 - across) * grid[row + 1, column] + across * grid[row + 1, column + 1]
        return (1 - up) * low + up * high - self.share * self.second_piola(strain)

    def drag(self) -> float:
        """Work that the overstress does on the material per length of track [N/mm]; the friction force has to give it.

        ``-int sum Q_i : dC/dx / 2``: elastic work adds up to nothing along a track that starts and ends at rest. Summed
        on the grid, apart from the equilibrium, with strains that are averaged at the mesh's vertices: the jumps of
        the gradient from element to element would count as dissipation.
        """
        strain = self._grid_strain(smooth=True)
        fxx, fxy, fyx, fyy, hoop, _ = strain.T + np.array([1.0, 0.0, 0.0, 1.0, 1.0, 0.0])[:, None]
        shape = (len(self.rows), len(self.columns), 4)
        c = np.stack([fxx**2 + fyx**2, fxy**2 + fyy**2, fxx * fxy + fyx * fyy, hoop**2], axis=-1).reshape(shape)
        double = np.array([1.0, 1.0, 2.0, 1.0])  # the shear stands twice in a symmetric tensor
        per_row = (self._overstress(strain) * np.diff(c, axis=1) * double).sum(axis=(1, 2))
        return float(-0.5 * np.trapezoid(per_row, self.rows))

    def _grid_strain(self, *, smooth: bool = False) -> Array:
        """Strains at the grid's points, shape (n, 6); the volumetric stress is left out."""
        u = self._unknowns.state[DISPLACEMENT]
        gradient = ng.Grad(u)
        if smooth:
            gradient = ng.GridFunction(ng.MatrixValued(ng.H1(self._unknowns.body.mesh, order=1), 2))
            gradient.Set(ng.Grad(u))
        hoop = self._grid(self._unknowns.kinematics.hoop_stretch(u))
        return np.column_stack([self._grid(gradient), hoop - 1, np.zeros(len(hoop))])


def _between(knots: Array, values: Array) -> tuple[np.ndarray, Array]:
    """Index of the knot at or below each value, and how far it is on the way to the next."""
    index = np.clip(np.searchsorted(knots, values, side="right") - 1, 0, len(knots) - 2)
    share = (values - knots[index]) / (knots[index + 1] - knots[index])
    return index, np.clip(share, 0.0, 1.0)
