"""Formulas for effects that are left out, against numbers worked out by hand and against brute force."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import k0

from ngwear.errors import SceneError
from ngwear.explanation import adhesion, film, heat, inertia, relaxation
from ngwear.explanation.assumptions import Assumed
from ngwear.explanation.verdict import onset
from ngwear.materials import WLF

STEEL = {"conductivity": 50.0, "heat_capacity": 4.0}  # diffusivity 12.5 mm²/s


def test_peclet():
    assert heat.peclet(100.0, 0.5, 12.5) == 2.0


def test_fast_band_is_a_half_space_heated_while_it_passes():
    found = heat.band_rise(100.0, 0.5, 1e6, **STEEL)
    assert found == pytest.approx(200 * math.sqrt(1 / (math.pi * 200 * 1e6)), rel=2e-3)


def test_slow_band_is_hottest_in_the_middle():
    """Peclet's number 1e-3: 2 q b / (pi k) (1 - ln(L/2) - 0.5772)."""
    found = heat.band_rise(100.0, 0.5, 0.05, **STEEL)
    assert found == pytest.approx(0.63662 * 8.0237, rel=1e-3)


@pytest.mark.parametrize("number", [0.05, 1.0, 8.0])
def test_band_adds_up_line_sources(number):
    flux, half, k = 3.0, 0.2, STEEL["conductivity"]
    speed = number * 2 * 12.5 / half

    def at(x):
        def source(s):
            return math.exp(speed * (x - s) / 25) * k0(speed * abs(x - s) / 25)

        return flux / (math.pi * k) * (quad(source, -half, x)[0] + quad(source, x, half)[0])

    highest = max(at(x) for x in half * np.linspace(-0.95, 0.95, 39))
    assert heat.band_rise(flux, half, speed, **STEEL) == pytest.approx(highest, rel=2e-3)


def test_disc_at_rest_and_fast():
    assert heat.disc_rise(100.0, 2.0, 0.0, **STEEL) == pytest.approx(100 * 2 / 50, rel=1e-3)
    fast = 2 * 100 * math.sqrt(2 * 2 / (math.pi * 200 * 1e6))  # while the diameter passes
    assert heat.disc_rise(100.0, 2.0, 1e6, **STEEL) == pytest.approx(fast, rel=1e-4)


def test_heat_is_shared_and_spreads():
    assert heat.shared_rise(10.0, 40.0) == 8.0
    assert heat.reach(100.0, 12.5) == pytest.approx(31.333, rel=1e-4)
    flux, time = 7.0, 100.0
    surface = 2 * flux * math.sqrt(time / (math.pi * 200))
    assert heat.uncooled_rise(flux * time, heat.reach(time, 12.5), 4.0) == pytest.approx(surface)
    assert heat.uncooled_rise(100.0, 5.0, 4.0) == 5.0


def test_ten_kelvin_above_tg_plus_50_relax_six_times_as_fast():
    wlf = WLF(c1=17.44, c2=51.6, reference=240.0)
    assert wlf.factor(290.0) / wlf.factor(300.0) == pytest.approx(6.2, abs=0.05)


def test_radius_of_a_hertzian_strip():
    assert adhesion.hertz_radius(2.0, 0.5, 4 / math.pi) == pytest.approx(0.125)


def test_pull_off_of_a_line_is_the_least_load():
    assert adhesion.line_pull_off(1.0, 2 / math.pi, 1.0) == pytest.approx(1.5)
    radius, modulus, work = 3.0, 6.0, 5e-5
    a = np.geomspace(1e-5, 1e-1, 20001)
    load = math.pi * modulus * a**2 / (4 * radius) - np.sqrt(2 * math.pi * modulus * a * work)
    assert adhesion.line_pull_off(radius, modulus, work) == pytest.approx(-load.min(), rel=1e-6)


def test_pull_off_of_a_ball_and_tabors_number():
    assert adhesion.point_pull_off(2.0, 0.1) == pytest.approx(0.94248, rel=1e-5)
    assert adhesion.tabor(8.0, 1.0, 1.0, 1.0) == pytest.approx(2.0)


def test_films():
    assert film.hersey(4e-8, 100.0, 2.0) == pytest.approx(2e-6)
    assert film.line_film(1e-3, 2.0, 1.0, 0.5, 1.0) == pytest.approx(1.55 * 0.0158489, rel=1e-5)
    assert film.point_film(1e-3, 2.0, 0.5, 0.5, 1.0) == pytest.approx(0.015697, rel=1e-4)
    assert [film.regime(x).split(" ")[0] for x in (0.5, 2.0, 4.0)] == ["boundary", "mixed", "a"]


def test_inertia():
    assert inertia.wave_speed(1.2, 1.2e-9) == pytest.approx(31622.8, rel=1e-5)
    assert inertia.mach_squared(1e3, 1.2, 1.2e-9) == pytest.approx(1e-3)
    assert inertia.reversal(10.0, 1.2, 1.2e-9, 0.1) == pytest.approx(3.16228e-3, rel=1e-5)


def test_relaxation():
    assert relaxation.stiffness([1.0], [2.0], 2.0) == pytest.approx(1.367879, rel=1e-6)
    assert relaxation.relaxed_after([1.0], [1.0], math.exp(-3)) == pytest.approx(3.0, rel=1e-6)


def test_onset():
    assert onset(lambda x: x * x, 9.0) == pytest.approx(3.0, rel=1e-8)
    assert onset(lambda x: 1.0, 2.0) == math.inf


def test_assumed_constants_can_be_replaced():
    assumed = Assumed().replaced(["oil_viscosity=1e-7", "roughness=0.001"])
    assert (assumed.oil_viscosity, assumed.roughness) == (1e-7, 1e-3)
    assert assumed.in_data_sheet_units()["oil: dynamic viscosity [Pa s]"] == pytest.approx(0.1)
    assert Assumed(counter_conductivity=15.0, counter_heat_capacity=4.0).counter_diffusivity == 3.75
    for change, place in (("oil=1", "unknown constant"), ("roughness=", "a number"), ("roughness=0", "than 0")):
        with pytest.raises(SceneError, match=place):
            Assumed().replaced([change])
