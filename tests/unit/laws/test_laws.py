"""Laws of friction and wear: values, limits, what they refuse, and the fit of four phases."""

import math

import numpy as np
import pytest

from ngwear.errors import SceneError
from ngwear.laws import ByPressure, Constant, FrictionLaw, Lubrication, Product, Stribeck, WearRate, law_of
from ngwear.laws.fit import fit_lubrication
from ngwear.plots.laws import draw_lubrication

PHASES = Lubrication.four_phases(film=0.06, boundary=0.35, dry=1.1, ends=(3000.0, 6000.0, 10000.0))
STRIBECK = Stribeck(boundary=0.8, full=0.05, speed=100.0, exponent=2.0, viscous=1e-5)
THIRION = ByPressure(light=2.0, pressure=0.5)
RATES = WearRate(distance=(100.0, 300.0), rate=(0.0, 4e-7))


def test_a_number_is_a_law_and_zero_is_none():
    assert law_of(0.3) == Constant(value=0.3)
    assert law_of(0.0) is None
    assert law_of(PHASES) is PHASES
    assert Constant(value=0.3).mu(5.0) == 0.3


@pytest.mark.parametrize(
    ("distance", "mu"), [(0, 0.06), (3000, 0.06), (4500, 0.205), (6000, 0.35), (8000, 0.725), (10000, 1.1), (1e9, 1.1)]
)
def test_four_phases(distance, mu):
    assert PHASES.mu(distance) == pytest.approx(mu)


def test_table_is_constant_before_its_first_row_too():
    assert Lubrication(distance=(50.0, 100.0), coefficient=(0.2, 0.4)).mu(0.0) == 0.2


def test_stribeck_falls_from_the_boundary_value_and_rises_with_the_film():
    assert STRIBECK.mu(0.0, 0.0) == 0.8
    assert STRIBECK.mu(0.0, 100.0) == pytest.approx(0.05 + 0.75 / math.e + 1e-3)
    assert STRIBECK.mu(0.0, 1e4) == pytest.approx(0.15)
    mu = [STRIBECK.mu(0.0, v) for v in np.geomspace(1, 200, 20)]
    assert mu == sorted(mu, reverse=True)


def test_thirion_and_schallamach_are_limits_of_the_law_by_pressure():
    p = np.array([0.0, 0.5, 2.0])
    assert 1 / THIRION.mu(0.0, None, p) == pytest.approx(0.5 + p)  # 1/mu linear in p
    third = ByPressure(light=2.0, pressure=1e-3, exponent=1 / 3)
    assert third.mu(0.0, None, 8.0) / third.mu(0.0, None, 1.0) == pytest.approx(0.5, rel=1e-3)
    assert ByPressure(light=2.0, limit=0.3, pressure=0.5).mu(0.0, None, 1e9) == pytest.approx(0.3)


def test_product_splits_what_it_holds_among_its_factors():
    law = Product(factors=(PHASES, ByPressure(light=1.0, pressure=0.5), STRIBECK))
    assert law.depends_on_speed
    assert law.depends_on_pressure
    assert law.breaks == PHASES.distance
    assert law.mu(4500.0, 100.0, 0.5) == pytest.approx(0.205 * 0.5 * STRIBECK.mu(0.0, 100.0))
    assert "times" in law.words


@pytest.mark.parametrize("law", [Constant(value=0.1), PHASES, STRIBECK, THIRION])
def test_laws_tell_what_they_depend_on(law):
    assert isinstance(law, FrictionLaw)
    assert law.words
    assert (law.mu(0.0, 10.0, 1.0) != law.mu(0.0, 10.0, 2.0)) == law.depends_on_pressure
    assert (law.mu(0.0, 10.0, 1.0) != law.mu(0.0, 20.0, 1.0)) == law.depends_on_speed
    assert (law.mu(0.0, 10.0, 1.0) != law.mu(9000.0, 10.0, 1.0)) == bool(law.breaks)


def test_mean_and_extremes_of_a_table_are_exact():
    curve = PHASES.curve()
    fine = np.linspace(2000, 9000, 700001)
    assert curve.mean(2000, 9000) == pytest.approx(np.mean([PHASES.mu(s) for s in fine[::100]]), rel=1e-4)
    assert curve.extremes(2000, 4500) == pytest.approx((0.06, 0.205))


def test_worn_distance_is_the_tables_integral():
    starts = np.array([0.0, 90.0, 250.0, 1000.0])
    fine = np.linspace(0.0, 1.0, 200001)
    exact = sum(np.trapezoid([RATES.at(x) for x in s + 80 * fine[::50]], s + 80 * fine[::50]) for s in starts)
    assert RATES.worn_distance(starts, 80.0) * RATES.highest == pytest.approx(exact, rel=1e-6)
    assert RATES.worn_distance(np.array([0.0]), 100.0) == 0.0


@pytest.mark.parametrize(
    ("make", "place", "value", "remedy"),
    [
        (lambda: Constant(value=-0.1), "friction", -0.1, "at least 0"),
        (lambda: Constant(value=math.nan), "friction", math.nan, "at least 0"),
        (
            lambda: Lubrication(distance=(0.0, 5.0, 3.0), coefficient=(0.1,) * 3),
            "distance[2]",
            3.0,
            "the row before has 5 mm",
        ),
        (lambda: Lubrication(distance=(0.0, 0.0), coefficient=(0.1, 0.2)), "distance[1]", 0.0, "must rise"),
        (lambda: Lubrication(distance=(-1.0, 2.0), coefficient=(0.1, 0.2)), "distance[0]", -1.0, "at least 0 mm"),
        (lambda: Lubrication(distance=(0.0, 2.0), coefficient=(0.1, -0.2)), "coefficient[1]", -0.2, "at least 0"),
        (lambda: Lubrication(distance=(0.0, 2.0), coefficient=(0.1,)), "coefficient", 1, "one value for each of its 2"),
        (lambda: Lubrication(distance=(), coefficient=()), "distance", [], "at least one row"),
        (lambda: Lubrication.four_phases(film=0.1, boundary=0.2, dry=0.3, ends=(5, 4, 6)), "distance[2]", 4, "rise"),
        (lambda: WearRate(distance=(0.0, 2.0), rate=(1e-6, -1e-6)), "rate[1]", -1e-6, "at least 0 mm²/N"),
        (lambda: WearRate(distance=(2.0, 1.0), rate=(1e-6, 1e-6)), "specific_wear_rate.distance[1]", 1.0, "must rise"),
        (lambda: Stribeck(boundary=-1.0, full=0.1, speed=1.0), "friction.boundary", -1.0, "at least 0"),
        (lambda: Stribeck(boundary=1.0, full=0.1, speed=0.0), "friction.speed", 0.0, "greater than 0"),
        (lambda: ByPressure(light=1.0, pressure=0.0), "friction.pressure", 0.0, "greater than 0"),
        (lambda: ByPressure(light=1.0, pressure=1.0, limit=-0.1), "friction.limit", -0.1, "at least 0"),
        (lambda: Product(factors=(PHASES,)), "friction.factors", 1, "at least two"),
    ],
)
def test_bad_values_are_refused(make, place, value, remedy):
    with pytest.raises(SceneError) as found:
        make()
    assert place in found.value.place
    assert found.value.value == value or math.isnan(value)
    assert remedy in found.value.remedy


def measured(noise, rows=60):
    s = np.linspace(50.0, 15000.0, rows)
    mu = np.array([PHASES.mu(x) for x in s]) + noise * np.random.default_rng(5).normal(size=rows)
    return Lubrication(distance=tuple(s), coefficient=tuple(np.maximum(mu, 0.0)))


@pytest.mark.parametrize(("noise", "off"), [(0.0, 1e-3), (0.02, 0.1)])
def test_fit_finds_the_four_phases(noise, off):
    fit = fit_lubrication(measured(noise))
    assert fit.law.distance[1:] == pytest.approx(PHASES.distance[1:], rel=off)
    assert fit.law.coefficient == pytest.approx(PHASES.coefficient, rel=off)
    assert fit.misfit == pytest.approx(noise, rel=0.2, abs=1e-6)
    assert fit.misfit <= fit.largest < 4 * noise + 1e-6
    assert len(draw_lubrication(fit).axes) == 2


def test_fit_of_a_file_and_what_cannot_be_fitted(tmp_path):
    data = measured(0.0)
    lines = [f"{s},{mu}" for s, mu in zip(data.distance, data.coefficient, strict=True)]
    file = tmp_path / "mu.csv"
    file.write_text("\n".join(["# rig 3", "sliding distance [mm],friction coefficient [-]", *lines]))
    assert fit_lubrication(file).law.mu(8000.0) == pytest.approx(0.725, rel=1e-4)
    file.write_text("\n".join(["sliding distance [mm],friction coefficient [-]", *lines[:5]]))
    with pytest.raises(SceneError, match=r"distance = 5: four phases need at least eight rows"):
        fit_lubrication(file)
    falling = Lubrication(distance=data.distance, coefficient=data.coefficient[::-1])
    with pytest.raises(SceneError, match="does not rise"):
        fit_lubrication(falling)
    file.write_text("s,mu\n1,2\n")
    with pytest.raises(SceneError, match=r"columns missing: .*friction coefficient \[-\]"):
        Lubrication.read(file)
