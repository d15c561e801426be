"""Laboratory tables, read from CSV files and checked: DMA, stress relaxation, uniaxial tension."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import SceneError
from ngwear.files.columns import read_columns

Array = NDArray[np.float64]
SOFTEST, STIFFEST = 0.05, 5e3  # MPa, from a gel to a glass: a table outside is in another unit


@dataclass(frozen=True)
class Dma:
    """Dynamic moduli over frequency, shear or uniaxial.

    Parameters
    ----------
    frequency : array, shape (n,)
        [Hz], rising. A table in rad/s has to be divided by 2 pi first.
    storage, loss : array, shape (n,)
        E' and E'' [MPa].
    temperature : float or None
        [K].

    Raises
    ------
    SceneError
        For impossible values, with the likely cause.
    """

    frequency: Array
    storage: Array
    loss: Array
    temperature: float | None = None

    def __post_init__(self) -> None:
        _rising("frequency [Hz]", self.frequency)
        _plausible("storage modulus [MPa]", self.storage)
        for f, e, loss in zip(self.frequency, self.storage, self.loss, strict=True):
            if not 0 <= loss < 5 * e:
                raise SceneError(
                    "loss modulus [MPa]",
                    float(loss),
                    f"at {f:.4g} Hz the loss factor would be {loss / e:.3g}; rubber's lies between 0 and 5: "
                    "is the column a loss factor, or in another unit than the storage modulus?",
                )

    @property
    def tan_delta(self) -> Array:
        """Loss factor [-]."""
        return self.loss / self.storage


@dataclass(frozen=True)
class Relaxation:
    """Modulus over time after a sudden constant strain.

    Parameters
    ----------
    time : array, shape (n,)
        Since the strain was reached [s], > 0, rising.
    modulus : array, shape (n,)
        Stress over strain [MPa], shear or uniaxial.
    """

    time: Array
    modulus: Array

    def __post_init__(self) -> None:
        _rising("time [s]", self.time)
        _plausible("modulus [MPa]", self.modulus)


@dataclass(frozen=True)
class Tension:
    """Uniaxial tension or compression.

    Parameters
    ----------
    stretch : array, shape (n,)
        Length over initial length [-], not a strain.
    stress : array, shape (n,)
        Force over **initial** section [MPa].
    """

    stretch: Array
    stress: Array

    def __post_init__(self) -> None:
        if len(self.stretch) < 3:
            raise SceneError("stretch [-]", len(self.stretch), "give at least three points")
        if not float(self.stretch.min()) > 0 or float(self.stretch.max()) > 15:
            worst = float(self.stretch.max()) if self.stretch.max() > 15 else float(self.stretch.min())
            raise SceneError(
                "stretch [-]", worst, "a stretch lies between 0 and 15: is this a strain, or in per cent? 1 + strain"
            )
        apart = np.abs(self.stretch - 1) > 0.02
        if not apart.any():
            raise SceneError("stretch [-]", float(self.stretch.max()), "go beyond 2 % of strain; or is this a strain?")
        wrong = apart & (self.stress * (self.stretch - 1) <= 0)
        if wrong.any():
            raise SceneError(
                "stress [MPa]",
                float(self.stress[wrong][0]),
                f"has the wrong sign at the stretch {self.stretch[wrong][0]:.4g}: tension is positive, above 1",
            )
        secant = self.stress[apart] / (self.stretch[apart] - 1)
        _plausible("stress over strain [MPa]", secant)


def read_dma(path: Path | str, *, temperature: float | None = None) -> Dma:
    """Read columns ``frequency [Hz]``, ``storage modulus [MPa]`` and ``loss modulus [MPa]`` or ``loss factor [-]``."""
    table = read_columns(path, ("frequency [Hz]", "storage modulus [MPa]"), ("loss modulus [MPa]", "loss factor [-]"))
    loss = table.get("loss modulus [MPa]")
    if loss is None:
        loss = table["loss factor [-]"] * table["storage modulus [MPa]"]
    return Dma(table["frequency [Hz]"], table["storage modulus [MPa]"], loss, temperature)


def read_relaxation(path: Path | str) -> Relaxation:
    """Read columns ``time [s]`` and ``modulus [MPa]``."""
    table = read_columns(path, ("time [s]", "modulus [MPa]"))
    return Relaxation(table["time [s]"], table["modulus [MPa]"])


def read_tension(path: Path | str) -> Tension:
    """Read columns ``stretch [-]`` and ``stress [MPa]`` (nominal)."""
    table = read_columns(path, ("stretch [-]", "stress [MPa]"))
    return Tension(table["stretch [-]"], table["stress [MPa]"])


def _rising(name: str, values: Array) -> None:
    if len(values) < 3:
        raise SceneError(name, len(values), "give at least three points")
    if not (np.isfinite(values).all() and values.min() > 0):
        raise SceneError(name, float(values.min()), "all must be finite and greater than 0")
    falls = np.flatnonzero(np.diff(values) <= 0)
    if len(falls):
        raise SceneError(
            name, float(values[falls[0] + 1]), f"does not rise after {values[falls[0]]:.6g}: sort the table"
        )


def _plausible(name: str, values: Array) -> None:
    if not (np.isfinite(values).all() and values.min() > 0):
        raise SceneError(name, float(values.min()), "all must be finite and greater than 0")
    if float(np.median(values)) > STIFFEST:
        raise SceneError(name, float(np.median(values)), "stiffer than any glassy polymer: is the table in Pa or kPa?")
    if float(np.median(values)) < SOFTEST:
        raise SceneError(name, float(np.median(values)), "softer than a gel: is the table in GPa?")
