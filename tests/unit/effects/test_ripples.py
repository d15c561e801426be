"""The stability of steady sliding, and what keeps its pressure smooth."""

import itertools

import numpy as np
import pytest

from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.friction import FullSliding
from ngwear.equilibrium.diagnosis import diagnosis
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import StepOptions, advance
from ngwear.errors import ConvergenceError
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.materials import NeoHooke
from ngwear.surfaces import Plane
from ngwear.verify import sliding_roller
from ngwear.verify.builders import meshed


def wave(stretch, mu, p):
    """(dt - mu dp) / (k u) of the incremental equations, solved mode by mode; G = k = 1."""
    shear = mu * p
    f = np.array([[stretch, shear * stretch], [0.0, 1 / stretch]])  # sigma_xy = B_xy = mu p
    b = f @ f.T
    assert np.isclose(b[0, 1], shear)
    spread = p + b[1, 1]  # sigma = B - spread I, sigma_yy = -p
    # u = a exp(i x + s y): B : grad grad u - grad pi = 0, div u = 0; q (s^2 - 1) = 0.
    modes = np.concatenate([[1.0], np.roots([b[1, 1], 2j * b[0, 1], -b[0, 0]])])
    modes = modes[modes.real > 0]
    assert len(modes) == 2
    shapes, tractions = [], []
    for s in modes:
        q = b[1, 1] * s**2 + 2j * b[0, 1] * s - b[0, 0]
        matrix = np.array([[q, 0, -1j], [0, q, -s], [1j, s, 0]])
        ux, uy, pi = np.linalg.svd(matrix)[2][-1].conj()
        assert np.allclose(matrix @ [ux, uy, pi], 0, atol=1e-9)
        along = b[0, 1] * 1j + b[1, 1] * s
        tractions.append([along * ux + spread * 1j * uy, along * uy + spread * s * uy - pi])
        shapes.append([ux, uy])
    shapes, tractions = np.array(shapes), np.array(tractions)
    share = np.array([shapes[1, 1], -shapes[0, 1]])  # no displacement across the rigid plane
    (ux, uy), (t, n) = share @ shapes, share @ tractions
    assert np.isclose(uy, 0)
    return (t + mu * n) / ux


@pytest.mark.parametrize(("stretch", "mu", "p"), list(itertools.product((0.8, 1.5), (0.3, 1.0), (0.5, 2.0))))
def test_wave_on_a_sliding_surface(stretch, mu, p):
    closed = 1 + stretch**-2 - mu**2 * p - 1j * mu * (p + stretch**-2 - 1)
    assert np.isclose(wave(stretch, mu, p), closed, rtol=1e-8)


def test_margin_of_a_block_in_shear():
    """A block held at the bottom, pressed and rubbed by a plane: 2 - mu^2 p/G where it is not stretched."""
    block = meshed(Outline.rectangle((0.0, 8.0), (0.0, 0.2)), 0.1)
    plane = Plane(point=(0.0, 0.2), normal_vector=(0.0, -1.0))
    contact = OutlineContact("plane", ("top",), plane, force_controlled=True, modulus=1.0)
    friction = FullSliding(contact, 0.5)
    rubber = NeoHooke(shear=1.0, bulk_modulus=1e3)
    problem = Problem(block, PlaneStrain(), [Elasticity(rubber), contact, friction], supports=[FixedEdges(("bottom",))])
    assert np.isnan(friction.margin())
    problem.fields[contact.travel_name].vec[0] = 1e-3
    advance(problem, {"plane force [N]": 4.0}, StepOptions(first=0.25))
    profile = contact.profile()
    middle = len(profile.pressure) // 2
    assert friction.margin() <= 2 - 0.25 * profile.pressure[middle] + 1e-3
    assert friction.margin() > 0


@pytest.mark.slow
def test_ripples_leave_the_resultant_and_the_smooth_pressure_alone(monkeypatch):
    found = []
    for shift in (0.25, 0.0):
        monkeypatch.setattr("ngwear.effects.ripples.SHIFT", shift)
        slider = sliding_roller.Slider(0.1)
        found.append(slider.at(0.5))
        forces = slider.contact.force() + slider.friction.force()
        assert forces[1] == pytest.approx(-sliding_roller.FORCE, rel=1e-7)
    assert found[0] == pytest.approx(found[1], rel=5e-5)


def test_sliding_that_would_not_stay_steady_is_said():
    slider = sliding_roller.Slider(0.1)
    slider.at(0.7)
    assert "steady" not in diagnosis(slider.problem)
    slider.at(1.0)
    told = diagnosis(slider.problem)
    assert "friction of 1 under p/G = 1.6 at contact 'roller' is more than steady sliding bears" in told
    assert f"(margin {slider.friction.margin():.2g})" in told


@pytest.mark.slow
def test_without_the_shift_the_roller_ends_below_mu_1(monkeypatch):
    monkeypatch.setattr("ngwear.effects.ripples.SHIFT", 0.0)
    slider = sliding_roller.Slider(0.1)
    slider.at(0.7)
    with pytest.raises(ConvergenceError):
        slider.at(1.0)
