"""A cylinder sliding on a half-plane with three arms, against a boundary solution by Fourier's series.

No closed form exists for more than one arm. The reference works on the surface alone: by the correspondence principle
a pressure of wave number k that moves at V over a half-plane lifts it by ``2 / (|k| E*(-k V))`` times itself, so that
the influence of a hat of pressure on every point follows from one Fourier transform over a period of 2,600 half
lengths. Which points touch is found by trial (neither pressure nor gap negative). With one arm it agrees with Hunter's
closed form to 1e-4, which is checked as well.

Arms of 10, 15 and 20 MPa at 0.1, 1 and 10 ms beside E_inf = 13.33 MPa; geometry and its scaling as in ``hunter``.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import toeplitz

from ngwear.errors import ConvergenceError
from ngwear.materials import PronySeries
from ngwear.sliding.asperity import Asperity, slide
from ngwear.verify.base import Check, Stopwatch
from ngwear.verify.hunter import ARM, LOAD, LONG_TERM, RADIUS, RUBBER, SCALE, TIME, closed_form

ARMS = PronySeries.from_moduli([10.0, 15.0, 20.0], [1e-4, 1e-3, 1e-2], long_term=LONG_TERM)
SPEEDS = (3.0, 30.0, 300.0)  # mm/s
POINTS, REACH = 200, 2.0  # points a half length, and half lengths to each side that may touch


def fourier(series: PronySeries, speed: float, half: float) -> tuple[float, float]:
    """Friction coefficient [-] and half length [mm]; ``half`` is a guess of the latter."""
    step = half / POINTS
    n = 2**19
    k = 2 * np.pi * np.fft.rfftfreq(n, step)
    rate = -1j * k * speed
    times = np.array(series.times)
    modulus = LONG_TERM * (
        1 + (np.array(series.ratios) * rate[:, None] * times / (1 + rate[:, None] * times)).sum(axis=1)
    )
    spectrum = np.zeros(len(k), dtype=complex)
    hat = np.sinc(k * step / (2 * np.pi)) ** 2 * step
    spectrum[1:] = 2 * hat[1:] / (k[1:] * modulus[1:])  # the mean is a rigid displacement
    influence = np.fft.irfft(spectrum, n) / step
    m = int(REACH * POINTS)
    x = step * np.arange(-m, m + 1)
    lags = np.arange(2 * m + 1)
    matrix = toeplitz(influence[lags], influence[-lags])
    shape = x * x / (2 * RADIUS)
    touching = np.abs(x) <= half
    for _ in range(200):
        count = int(touching.sum())
        system = np.zeros((count + 1, count + 1))
        system[:-1, :-1], system[:-1, -1], system[-1, :-1] = matrix[np.ix_(touching, touching)], -1.0, step
        solution = np.linalg.solve(system, np.append(-shape[touching], LOAD))
        pressure = np.zeros(len(x))
        pressure[touching] = solution[:-1]
        gap = matrix @ pressure + shape - solution[-1]
        changed = (touching & (pressure < 0)) | (~touching & (gap < 0))
        if not changed.any():
            break
        touching ^= changed
    else:
        raise ConvergenceError("the reference does not find its contact")
    friction = float((pressure * x).sum() / RADIUS * step / LOAD)
    return friction, step * count / 2


def run() -> list[Check]:
    """The reference against Hunter, and the steady solve against the reference."""
    checks: list[Check] = []
    one = PronySeries.from_moduli([ARM], [TIME], long_term=LONG_TERM)
    for speed in SPEEDS:
        clock = Stopwatch()
        exact = closed_form(speed)
        reference, _ = fourier(one, speed, exact["half_length"])
        quantity = f"Fourier reference for one arm at {speed:g} mm/s, friction [-]"
        checks.append(Check("three_arms", quantity, reference, exact["friction"], 1e-3, clock.seconds))
        clock.start()
        asperity = Asperity(material=RUBBER, series=ARMS, radius=SCALE * RADIUS, load=LOAD / SCALE)
        found = slide(asperity, speed)
        friction, half = fourier(ARMS, speed, asperity.half_length(speed))
        for quantity, value, wanted in (
            ("friction coefficient at {} mm/s [-]", found.friction * SCALE, friction),
            ("half length at {} mm/s [mm]", found.half_length, half),
        ):
            label = quantity.format(f"{speed:g}")
            checks.append(Check("three_arms", label, value, wanted, 0.02, clock.seconds))
    return checks
