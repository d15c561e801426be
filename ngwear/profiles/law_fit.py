"""Fit a law of wear to one measured profile, with the depth integrated from a run's pressures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from ngwear.errors import SceneError
from ngwear.laws import PowerWear, SaturatingWear, ThresholdWear, WearLaw
from ngwear.profiles.comparison import Comparison
from ngwear.results.result_file import ResultFile, read_result

Array = NDArray[np.float64]
AXES = {"x": 0, "y": 1}
# Each family: the law by one parameter and a scale of the pressure [MPa], and the parameter's values tried.
FAMILIES: dict[str, tuple[Callable[[float, float], WearLaw], Array]] = {
    "power": (lambda m, p: PowerWear(exponent=m, reference_pressure=p), np.linspace(0.2, 5.0, 25)),
    "threshold": (lambda q, p: ThresholdWear(pressure=q * p), np.linspace(0.0, 0.95, 20)),
    "saturating": (lambda q, p: SaturatingWear(pressure=q * p), np.geomspace(0.02, 50.0, 25)),
}
PRECISE = 1e-4  # of a number between two that were tried: far below what a profile's noise tells


@dataclass(frozen=True)
class LawFit:
    """The best of a family of laws.

    Attributes
    ----------
    law : WearLaw
    specific_wear_rate : float
        Specific wear rate k of the law [mm²/N].
    residual : float
        RMS of the deviation from the profile [mm].
    archard : float
        The same of Archard's law [mm].
    tried, residuals : array
        Parameter values tried and their residuals [mm]; they hardly differ if the profile does not determine the law.
    """

    law: WearLaw
    specific_wear_rate: float
    residual: float
    archard: float
    tried: Array
    residuals: Array


def fit_wear_law(folder: Path | str, comparison: Comparison, family: str = "power") -> LawFit:
    """Fit k and one parameter of a law to a profile, without another run.

    The depth is computed as ``W = k int P phi(p) ds`` over the pressures that the run has saved, by trapezoids, up to
    the distance at which the run's outline fits the profile best, or its end; k, a shift of height and a tilt by least
    squares for each value of the parameter. The scale of the pressure is the highest of the run for ``"threshold"`` and
    ``"saturating"``, the mean over the run's load for ``"power"``.

    An approximation: these pressures are those of the run's own law, whose wear has shaped its contact. It is good
    while the depth is small against the indentation; else run again with the law found, compare and fit until it stays
    (a roller on a sheet, worn 0.02 mm deep with the exponent 2: 1.67 from a run of Archard's law, 1.87 and 1.92 from
    the next two). Once a contact is worn in, its profile is the counter-surface's for any law, and ``residuals`` hardly
    differ. J is left out.

    Parameters
    ----------
    folder : Path or str
        Of the run.
    comparison : Comparison
        Of the profile with this run, from ``compare_profile``.
    family : str
        ``"power"``, ``"threshold"`` or ``"saturating"``.

    Raises
    ------
    SceneError
        For an unknown family or an edge that is inclined.
    ResultError
        If the run cannot be read.
    """
    if family not in FAMILIES:
        raise SceneError("family", family, f"must be one of {list(FAMILIES)}")
    if comparison.edge.axis not in AXES:
        raise SceneError("edges", comparison.edge.axis, "a law is fitted to edges along x or y only")
    place, depth = comparison.alignment.place, comparison.measured_depth
    slid = min(comparison.alignment.distance, comparison.edge.end)
    ways, nominal, pressure = _pressures(read_result(folder), AXES[comparison.edge.axis], place, slid)
    scale = float(pressure.max())
    if family == "power":
        scale = float((ways[:, None] * nominal * pressure).sum() / (ways[:, None] * nominal).sum())
    build, numbers = FAMILIES[family]

    def fitted(law: WearLaw | None) -> tuple[float, float]:
        above = np.maximum(pressure, 1e-9 * scale)
        worn = ways @ (nominal * (1.0 if law is None else law.factor(above)))
        basis = np.column_stack([worn, np.ones_like(place), place])
        basis /= (size := np.abs(basis).max(axis=0) + 1e-300)
        found = np.linalg.lstsq(basis, depth, rcond=None)[0]
        off = depth - basis @ found
        return float(np.sqrt(np.mean(off**2))), float(found[0] / size[0]) * slid / comparison.distance

    residuals = np.array([fitted(build(number, scale))[0] for number in numbers])
    best = int(residuals.argmin())
    around = numbers[max(best - 1, 0)], numbers[min(best + 1, len(numbers) - 1)]
    finest = {"xatol": PRECISE * (around[1] - around[0])}
    found = minimize_scalar(
        lambda number: fitted(build(number, scale))[0], bounds=around, method="bounded", options=finest
    )
    law = build(float(found.x), scale)
    residual, rate = fitted(law)
    return LawFit(law, rate, residual, fitted(None)[0], numbers, residuals)


def _pressures(result: ResultFile, axis: int, place: Array, slid: float) -> tuple[Array, Array, Array]:
    """Ways [mm], shape (n,), and pressures at the places over them, nominal and Cauchy, of shape (n, m) [MPa]."""
    last: dict[str, Array] = {}
    ways, pairs, before = [], [], 0.0
    for distance, snapshot in zip(result.series["sliding distance [mm]"], result.snapshots, strict=True):
        now = _at(snapshot.profiles, result.wear_rates, axis, place)
        way = min(float(distance), slid) - min(before, slid)
        if way > 0:
            earlier = last.get(snapshot.kind, now)
            ways += [way / 2, way / 2]
            pairs += [earlier, now]
        last[snapshot.kind], before = now, float(distance)
    both = np.array(pairs)
    return np.array(ways), both[:, 0], both[:, 1]


def _at(profiles: dict[str, dict[str, Array]], contacts: dict[str, float], axis: int, place: Array) -> Array:
    """Nominal and Cauchy pressure at places along the axis of all contacts that wear, shape (2, m) [MPa]."""
    found = np.zeros((2, len(place)))
    for name in contacts:
        profile = profiles[name]
        along = profile["reference [mm]"][:, axis]
        order = np.argsort(along)
        for row, key in enumerate(("nominal pressure [MPa]", "pressure [MPa]")):
            found[row] += np.interp(place, along[order], profile[key][order], left=0.0, right=0.0)
    return found
