"""Figures of calibrations: fit and data, and the relative error."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ngwear.materials.calibrate import PronyFit, ShiftFit, TensionFit
from ngwear.materials.measurements import Dma

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DATA, FIT, OTHER = "#1b6ca8", "#d1495b", "#2e933c"


def draw_prony(fit: PronyFit) -> Figure:
    """Moduli over frequency (or time), loss factor, arms, and relative errors."""
    figure, (top, bottom) = _panels()
    series, scale = fit.series, fit.long_term
    if isinstance(fit.data, Dma):
        f = fit.data.frequency
        fine = np.geomspace(f[0] / 3, f[-1] * 3, 300)
        for values, name, curve, colour in (
            (fit.data.storage, "storage modulus", series.storage, DATA),
            (fit.data.loss, "loss modulus", series.loss, OTHER),
        ):
            top.loglog(f, values, "o", ms=4, mfc="none", color=colour, label=f"{name}, measured")
            top.loglog(fine, scale * curve(fine), color=colour, label=f"{name}, {len(series.times)} arms")
            bottom.semilogx(f, 100 * (scale * curve(f) / values - 1), ".-", color=colour, label=name)
        bottom.set_xlabel("frequency [Hz]")
    else:
        t = fit.data.time
        fine = np.geomspace(t[0], t[-1], 300)
        top.loglog(t, fit.data.modulus, "o", ms=4, mfc="none", color=DATA, label="measured")
        top.loglog(fine, scale * series.relaxation(fine), color=FIT, label=f"{len(series.times)} arms")
        bottom.semilogx(t, 100 * (scale * series.relaxation(t) / fit.data.modulus - 1), ".-", color=DATA)
        bottom.set_xlabel("time [s]")
    top.set_ylabel("modulus [MPa]")
    top.set_title(f"root mean square error {fit.misfit:.1%}, largest {fit.largest:.1%}")
    bottom.set_ylabel("fit - data [%]")
    return _finished(figure, top, bottom)


def draw_tension(fit: TensionFit) -> Figure:
    """Nominal stress over stretch, and relative errors."""
    figure, (top, bottom) = _panels()
    stretch, stress = fit.data.stretch, fit.data.stress
    fine = np.linspace(stretch.min(), stretch.max(), 200)
    model = fit.material
    top.plot(stretch, stress, "o", ms=4, mfc="none", color=DATA, label="measured")
    top.plot(fine, model.uniaxial_stress(fine), color=FIT, label=f"C10 = {model.c10:.4g}, C01 = {model.c01:.4g} MPa")
    apart = np.abs(stretch - 1) > 1e-3
    error = model.uniaxial_stress(stretch[apart]) / stress[apart] - 1
    bottom.plot(stretch[apart], 100 * error, ".-", color=DATA)
    top.set_ylabel("nominal stress [MPa]")
    top.set_title(f"root mean square error {fit.misfit:.1%}, largest {fit.largest:.1%}")
    bottom.set_xlabel("stretch [-]")
    bottom.set_ylabel("fit - data [%]")
    return _finished(figure, top, bottom)


def draw_shift(fit: ShiftFit) -> Figure:
    """Master curve, and shift factors over temperature with the WLF law."""
    figure, (top, bottom) = _panels()
    master, law = fit.master, fit.shift
    top.loglog(master.frequency, master.storage, ".", ms=4, color=DATA, label="storage modulus")
    top.loglog(master.frequency, master.loss, ".", ms=4, color=OTHER, label="loss modulus")
    top.set_xlabel(f"frequency at {law.reference:.4g} K [Hz]")
    top.set_ylabel("modulus [MPa]")
    fine = np.linspace(fit.temperatures.min(), fit.temperatures.max(), 200)
    bottom.semilogy(fit.temperatures, fit.factors, "o", mfc="none", color=DATA, label="from shifting")
    label = f"WLF, C1 = {law.c1:.3g}, C2 = {law.c2:.3g} K"
    bottom.semilogy(fine, [law.factor(t) for t in fine], color=FIT, label=label)
    bottom.set_xlabel("temperature [K]")
    bottom.set_ylabel("a_T [-]")
    bottom.legend()
    return _finished(figure, top, bottom)


def _panels() -> tuple[Figure, tuple[Axes, ...]]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 7), layout="constrained")
    return figure, tuple(figure.subplots(2, 1, height_ratios=(2, 1)))


def _finished(figure: Figure, *axes: Axes) -> Figure:
    for axis in axes:
        axis.grid(alpha=0.3, which="both")
    axes[0].legend()
    return figure
