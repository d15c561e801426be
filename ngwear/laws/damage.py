"""Criteria for tearing: limits of the stress in an element."""

from __future__ import annotations

import abc
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.spatial import cKDTree

from ngwear.errors import check_fields, require

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Stresses:
    """Stress and strain energy at any number of places.

    Parameters
    ----------
    cauchy : array, shape (..., 3)
        Cauchy stresses xx, yy, xy [MPa].
    energy : array, shape (...)
        Strain energy per reference volume [mJ/mm³].
    """

    cauchy: Array
    energy: Array

    @property
    def tensile(self) -> Array:
        """The larger normal stress along x or y [MPa], shape (...)."""
        return self.cauchy[..., :2].max(axis=-1)

    @property
    def principal(self) -> Array:
        """The larger principal stress in the plane [MPa], shape (...)."""
        xx, yy, xy = np.moveaxis(self.cauchy, -1, 0)
        return 0.5 * (xx + yy) + np.hypot(0.5 * (xx - yy), xy)

    def averaged(self, centres: Array, areas: Array, length: float) -> Stresses:
        """Area-weighted means over the elements whose centres, shape (n, 2), lie within ``length / 2`` of each one.

        The load at which rubber tears then does not depend on the mesh (Pijaudier-Cabot and Bažant, J. Eng. Mech. 113
        (1987) 1512, with a constant weight).
        """
        tree = cKDTree(centres)
        pairs = tree.query_pairs(length / 2, output_type="ndarray")
        own = np.arange(len(centres))
        i, j = np.concatenate([own, *pairs.T]), np.concatenate([own, *pairs.T[::-1]])
        weights = coo_array((areas[j], (i, j)), shape=(len(own), len(own))).tocsr()
        total = weights.sum(axis=1)
        return Stresses(weights @ self.cauchy / total[:, None], weights @ self.energy / total)


@dataclass(frozen=True, kw_only=True)
class Criterion(abc.ABC):
    """A limit at which an element tears; ``critical`` in the criterion's unit, > 0.

    ``length`` is a length of the material [mm], > 0: stresses are averaged over a circle of this diameter before they
    are compared. Without it the mean of each element counts; finer elements resolve a stress peak better and tear
    earlier.
    """

    critical: float
    length: float | None = None

    name = ""
    accumulates = False

    def __post_init__(self) -> None:
        check_fields(self, "deactivation.damage")
        place = "deactivation.damage"
        require(self.critical > 0, f"{place}.critical", self.critical, "must be greater than 0")
        positive = self.length is None or self.length > 0
        require(positive, f"{place}.length", self.length, "must be greater than 0 mm, or left out")

    @abc.abstractmethod
    def exhaustion(self, stresses: Stresses) -> Array:
        """Present load over critical load at each place, shape (...) [-]; torn from 1 on.

        For a criterion that ``accumulates``: the damage of one cycle.
        """


class TensileNormalStress(Criterion):
    """Larger of the normal stresses xx and yy over the critical one [MPa] (10.5772/50498, case C5)."""

    name = "tensile normal stress"

    def exhaustion(self, stresses: Stresses) -> Array:
        return stresses.tensile / self.critical


class MaximumPrincipalStress(Criterion):
    """Largest principal Cauchy stress in the plane over the critical one [MPa] (Rankine)."""

    name = "maximum principal stress"

    def exhaustion(self, stresses: Stresses) -> Array:
        return stresses.principal / self.critical


class StrainEnergyDensity(Criterion):
    """Strain energy per reference volume over the critical one [mJ/mm³]."""

    name = "strain energy density"

    def exhaustion(self, stresses: Stresses) -> Array:
        return stresses.energy / self.critical


@dataclass(frozen=True, kw_only=True)
class Fatigue(Criterion):
    """Damage that adds up over cycles, each ``(sigma_1 / critical)^exponent`` with the highest sigma_1 of the cycle.

    Basquin's line with Miner's rule (J. Appl. Mech. 12 (1945) A159); ``critical`` is the principal stress that tears in
    a single cycle [MPa].
    """

    exponent: float

    name = "fatigue"
    accumulates = True

    def __post_init__(self) -> None:
        super().__post_init__()
        require(self.exponent > 0, "deactivation.damage.exponent", self.exponent, "must be greater than 0")

    def exhaustion(self, stresses: Stresses) -> Array:
        return (np.maximum(stresses.principal, 0.0) / self.critical) ** self.exponent


CRITERIA = {kind.name: kind for kind in (TensileNormalStress, MaximumPrincipalStress, StrainEnergyDensity, Fatigue)}
