"""Prony series, shifts, calibration and the library."""

import numpy as np
import pytest

from ngwear.errors import SceneError
from ngwear.materials import WLF, Arrhenius, PronySeries
from ngwear.materials.calibrate import PoorFitWarning, fit_dma, fit_relaxation, fit_tension, fit_wlf
from ngwear.materials.library import GLASS, compound, filled_rubber, young_from_hardness
from ngwear.materials.measurements import Dma, Relaxation, Tension, read_dma, read_relaxation, read_tension
from ngwear.materials.smoothing import smooth
from ngwear.plots.fits import draw_prony, draw_shift, draw_tension

ARMS = PronySeries((2.0, 1.0, 0.5), (1e-3, 1e-2, 1e-1))
HERTZ = np.geomspace(0.1, 1e4, 41)


def table(series=ARMS, *, noise=0.0, scale=5.0, frequency=HERTZ, temperature=None):
    rng = np.random.default_rng(3)
    first, second = (1 + noise * rng.standard_normal((2, len(frequency)))).tolist()
    storage = scale * series.storage(frequency) * np.array(first)
    return Dma(frequency, storage, scale * series.loss(frequency) * np.array(second), temperature)


def test_absolute_and_instantaneous_moduli_give_the_same_arms():
    absolute = PronySeries.from_moduli([10.0, 5.0], [0.1, 1.0], long_term=5.0)
    shares = PronySeries.from_shares([0.5, 0.25], [0.1, 1.0])
    assert absolute.ratios == pytest.approx((2.0, 1.0))
    assert shares.ratios == pytest.approx((2.0, 1.0))
    assert absolute.instantaneous == pytest.approx(4.0)


def test_moduli_in_time_and_frequency():
    assert ARMS.relaxation(0.0) == pytest.approx(4.5)
    assert ARMS.relaxation([1e-3, 1e9]) == pytest.approx([1 + 2 / np.e + np.exp(-0.1) + 0.5 * np.exp(-0.01), 1.0])
    one = PronySeries((1.0,), (1.0,))
    assert one.tan_delta(1 / (2 * np.pi)) == pytest.approx(0.5 / 1.5)


def test_creep_is_the_inverse_of_relaxation():
    t = np.linspace(0, 0.5, 200001)
    creep, relaxation = ARMS.creep(t), ARMS.relaxation(t)
    assert creep[0] == pytest.approx(1 / 4.5)
    assert ARMS.creep(1e9) == pytest.approx(1.0)
    # int J(t - s) dG(s) + J(t) G(0) = 1 at every t (Ferry, Viscoelastic Properties of Polymers, ch. 3).
    strain = creep[-1] * relaxation[0] + np.sum(creep[::-1][1:] * np.diff(relaxation))
    assert strain == pytest.approx(1.0, abs=1e-4)


def test_folding_keeps_what_matters_and_bounds_what_it_drops():
    series = PronySeries((1.0, 1.0, 1.0), (1e-8, 1.0, 1e8))
    fold = series.folded(shortest=0.01, longest=100.0, tolerance=1e-3)
    assert (fold.fast, fold.slow) == ((1e-8,), (1e8,))
    assert fold.stiffening == 2.0
    assert fold.kept == PronySeries((0.5,), (1.0,))
    assert 0 < fold.bound < 1e-3
    t = np.geomspace(0.01, 100.0, 50)
    assert np.abs(fold.stiffening * fold.kept.relaxation(t) / series.relaxation(t) - 1).max() <= fold.bound
    f = np.geomspace(1 / 200 / np.pi, 1 / (2 * np.pi * 0.01), 50)
    assert np.abs(fold.stiffening * fold.kept.loss(f) - series.loss(f)).max() <= 2 * fold.bound * 2


def test_smoothed_spectrum_stays_as_near_as_asked_and_undulates_less():
    series = filled_rubber().prony
    smoothed = smooth(series, misfit=0.05)
    f = np.geomspace(1 / (2 * np.pi * series.times[-1]), 1 / (2 * np.pi * series.times[0]), 500)
    misses = [smoothed.storage(f) / series.storage(f) - 1, smoothed.loss(f) / series.loss(f) - 1]
    assert np.sqrt(np.mean(np.square(misses))) == pytest.approx(0.05, rel=0.01)

    def wiggles(s):
        return np.count_nonzero(np.diff(np.sign(np.diff(s.tan_delta(f)))))

    assert wiggles(smoothed) <= 4 < wiggles(series)


@pytest.mark.parametrize(
    ("series", "misfit", "says"),
    [
        (PronySeries((1.0, 1.0), (1.0, 10.0)), 0.05, "at least three arms"),
        (PronySeries((1.0,) * 3, (1e-9, 1.0, 1e9)), 0.05, "more than 40 arms"),
        (ARMS, 0.9, "must lie between"),
        (ARMS, -0.1, "must lie between"),
    ],
)
def test_smoothing_that_cannot_be_is_refused(series, misfit, says):
    with pytest.raises(SceneError, match=says):
        smooth(series, misfit=misfit)


@pytest.mark.parametrize(
    ("ratios", "times", "says"),
    [
        ((-1.0,), (1.0,), "moduli"),
        ((1.0,), (0.0,), "times"),
        ((1.0, 1.0), (1.0, 1.0), "twice"),
        ((1.0, 1.0), (2.0, 1.0), "sort"),
        ((1.0,), (1.0, 2.0), "one modulus for each time"),
        ((1.0,) * 41, tuple(range(1, 42)), "at most 40"),
    ],
)
def test_bad_arms_are_refused(ratios, times, says):
    with pytest.raises(SceneError, match=says):
        PronySeries(ratios, times)


def test_shares_must_leave_something():
    with pytest.raises(SceneError, match="below 1"):
        PronySeries.from_shares([0.6, 0.4], [1.0, 2.0])


def test_wlf_and_arrhenius():
    law = WLF(17.44, 51.6, 240.0)
    assert law.factor(240.0) == 1.0
    assert law.factor(291.6) == pytest.approx(10 ** (-17.44 / 2))
    moved = law.moved(300.0)
    assert moved.factor(270.0) == pytest.approx(law.factor(270.0) / law.factor(300.0))
    with pytest.raises(SceneError, match="glass"):
        law.factor(180.0)
    assert Arrhenius(50e3, 300.0).factor(310.0) == pytest.approx(np.exp(50e3 / 8.314462618 * (1 / 310 - 1 / 300)))
    assert ARMS.shifted(10.0).storage(1.0) == pytest.approx(ARMS.storage(10.0))


def test_three_arms_are_found_again_in_noise():
    fit = fit_dma(table(noise=0.02))
    inside = np.geomspace(0.1, 1e4, 200)
    for kind in ("storage", "loss"):
        found = fit.long_term * getattr(fit.series, kind)(inside)
        error = found / (5 * getattr(ARMS, kind)(inside)) - 1
        assert np.sqrt(np.mean(error**2)) < 0.02
    assert fit.misfit == pytest.approx(0.02, rel=0.5)
    figure = draw_prony(fit)
    assert len(figure.axes) == 2


def test_given_times_are_kept():
    fit = fit_dma(table(), arms=ARMS.times)
    assert fit.series.ratios == pytest.approx(ARMS.ratios, rel=1e-8)
    assert fit.long_term == pytest.approx(5.0)


def test_too_few_arms_warn_and_give_the_best():
    with pytest.warns(PoorFitWarning, match="more than the"):
        fit = fit_dma(table(filled_rubber().prony), arms=2)
    assert fit.misfit > 0.03


def test_relaxation_is_fitted():
    t = np.geomspace(1e-4, 10, 60)
    fit = fit_relaxation(Relaxation(t, 5 * ARMS.relaxation(t)), tolerance=5e-3)
    assert fit.misfit < 5e-3
    assert fit.long_term == pytest.approx(5.0, rel=5e-3)
    draw_prony(fit)


def test_no_plateau_and_no_relaxation_are_said():
    t = np.geomspace(1e-3, 1, 30)
    with pytest.raises(SceneError, match="no plateau"):
        fit_relaxation(Relaxation(t, np.exp(-t)), arms=[1.0])
    with pytest.raises(SceneError, match="no relaxation"):
        fit_relaxation(Relaxation(t, np.full(30, 3.0)))


def test_tension_is_fitted():
    stretch = np.linspace(1.0, 2.0, 30)
    stress = 2 * (stretch - stretch**-2.0) * (0.6 + 0.15 / stretch)
    fit = fit_tension(Tension(stretch, stress))
    assert (fit.material.c10, fit.material.c01) == pytest.approx((0.6, 0.15))
    draw_tension(fit)
    with pytest.warns(PoorFitWarning, match="upturn"):
        fit_tension(Tension(stretch, stress * np.exp(2 * (stretch - 1) ** 2)))


def test_wlf_is_found_from_curves():
    law = WLF(8.0, 120.0, 296.0)
    series = filled_rubber().prony
    frequency = np.geomspace(0.1, 100, 25)
    curves = [
        table(series.shifted(law.factor(t)), frequency=frequency, temperature=t) for t in (276.0, 286.0, 296.0, 316.0)
    ]
    fit = fit_wlf(curves, reference=296.0)
    found = [np.log10(fit.shift.factor(t)) for t in (276.0, 316.0)]
    assert found == pytest.approx([np.log10(law.factor(t)) for t in (276.0, 316.0)], abs=0.05)
    assert fit.misfit < 0.03
    draw_shift(fit)
    with pytest.raises(SceneError, match="three or more"):
        fit_wlf(curves[:2], reference=296.0)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Dma(np.array([1.0, 3.0, 2.0]), np.ones(3), np.ones(3) / 10), "sort the table"),
        (lambda: Dma(np.array([0.0, 1.0, 2.0]), np.ones(3), np.ones(3) / 10), "greater than 0"),
        (lambda: Dma(np.arange(1.0, 4.0), 5e6 * np.ones(3), np.ones(3)), "in Pa or kPa"),
        (lambda: Dma(np.arange(1.0, 4.0), 5e-3 * np.ones(3), np.ones(3)), "in GPa"),
        (lambda: Dma(np.arange(1.0, 4.0), np.ones(3), 50 * np.ones(3)), "loss factor"),
        (lambda: Tension(np.array([0.0, 0.5, 1.0]), np.ones(3)), "strain"),
        (lambda: Tension(np.array([10.0, 50.0, 100.0]), np.ones(3)), "per cent"),
        (lambda: Tension(np.array([1.0, 1.5, 2.0]), -np.ones(3)), "wrong sign"),
        (lambda: Relaxation(np.array([1.0, 2.0]), np.ones(2)), "three points"),
    ],
)
def test_tables_that_cannot_be_right(make, says):
    with pytest.raises(SceneError, match=says):
        make()


def test_tables_are_read(tmp_path):
    file = tmp_path / "dma.csv"
    file.write_text("# a comment\nfrequency [Hz],storage modulus [MPa],loss factor [-]\n1,5,0.1\n10,6,0.1\n100,7,0.2\n")
    dma = read_dma(file, temperature=296.0)
    assert dma.loss == pytest.approx([0.5, 0.6, 1.4])
    file.write_text("frequency [Hz],storage modulus [MPa]\n1,5\n")
    with pytest.raises(SceneError, match="loss modulus"):
        read_dma(file)
    file.write_text("time [s],modulus [MPa]\n1,5\n2,x\n3,3\n")
    with pytest.raises(SceneError, match="line 3"):
        read_relaxation(file)
    file.write_text("stretch [-],stress [MPa]\n1,0\n1.5,1\n2,1.5\n")
    assert read_tension(file).stress[-1] == 1.5
    with pytest.raises(SceneError, match="no such file"):
        read_dma(tmp_path / "none.csv")


def test_filled_rubber_has_the_loss_factors_that_are_stated():
    rubber = filled_rubber()
    assert rubber.prony.tan_delta([0.1, 1, 10, 100, 1000]) == pytest.approx(
        [0.112, 0.108, 0.130, 0.145, 0.175], abs=1e-3
    )
    assert 3 * rubber.elastic.shear_modulus == pytest.approx(5.352)


@pytest.mark.parametrize("polymer", GLASS)
def test_every_constant_has_a_source(polymer):
    rubber = compound(polymer, hardness=70.0)
    for name in ("elastic", "prony", "shift", *rubber.constants):
        assert rubber.sources[name]
    assert rubber.at(286.0).times[0] > rubber.prony.times[0]
    with pytest.raises(SceneError, match="known"):
        compound("XYZ", hardness=70.0)


def test_hardness():
    assert young_from_hardness(60.0) == pytest.approx(3.6, rel=0.02)
    with pytest.raises(SceneError, match="Shore A"):
        young_from_hardness(120.0)
