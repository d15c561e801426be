import doctest
import importlib
import math

import pytest

from ngwear.errors import SceneError
from ngwear.materials import MooneyRivlin, NeoHooke


@pytest.mark.parametrize("name", ["neo_hooke", "mooney_rivlin"])
def test_examples_in_the_docstrings(name):
    failed, tried = doctest.testmod(importlib.import_module(f"ngwear.materials.{name}"))
    assert tried > 0
    assert failed == 0


def test_moduli_of_linear_elasticity():
    rubber = NeoHooke.from_young(3.0, 0.49)
    assert rubber.young_modulus == pytest.approx(3.0)
    assert rubber.poisson_ratio == pytest.approx(0.49)
    assert rubber.plane_strain_modulus == pytest.approx(3.0 / (1 - 0.49**2))
    assert rubber.bulk_modulus == pytest.approx(3.0 / (3 * 0.02))
    assert MooneyRivlin(c10=1.6, c01=0.4, bulk_modulus=3000.0).shear_modulus == pytest.approx(4.0)


@pytest.mark.parametrize("stretch", [0.7, 1.0, 1.3, 2.0])
def test_uniaxial_stress_is_the_textbook_one(stretch):
    rubber = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1000.0)
    by_hand = 2 * (0.6 + 0.15 / stretch) * (stretch - stretch**-2)
    assert rubber.uniaxial_stress(stretch) == pytest.approx(by_hand, abs=1e-8)


def test_small_strain_slope_is_young_modulus():
    rubber = MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1e9)
    assert rubber.uniaxial_stress(1.0001) / 1e-4 == pytest.approx(rubber.young_modulus, rel=2e-4)


def test_energy_vanishes_undeformed():
    assert MooneyRivlin(c10=0.6, c01=0.15, bulk_modulus=1.0).isochoric_energy(3.0, 3.0) == 0.0


@pytest.mark.parametrize(
    ("build", "values", "key"),
    [
        (NeoHooke, {"shear": 0.0, "bulk_modulus": 1.0}, "shear"),
        (NeoHooke, {"shear": math.nan, "bulk_modulus": 1.0}, "shear"),
        (NeoHooke, {"shear": 1.0, "bulk_modulus": -2.0}, "bulk_modulus"),
        (MooneyRivlin, {"c10": -0.1, "c01": 0.1, "bulk_modulus": 1.0}, "c10"),
        (MooneyRivlin, {"c10": 0.1, "c01": -0.1, "bulk_modulus": 1.0}, "c01"),
        (MooneyRivlin, {"c10": 0.1, "c01": math.nan, "bulk_modulus": 1.0}, "c01"),
        (NeoHooke, {"shear": math.inf, "bulk_modulus": 1.0}, "shear"),
    ],
)
def test_modulus_out_of_range_is_refused_with_place_and_unit(build, values, key):
    with pytest.raises(SceneError, match=rf"material\.{key} = .*(MPa|finite)") as found:
        build(**values)
    assert repr(found.value.value) == repr(values[key])


@pytest.mark.parametrize("ratio", [0.5, 0.6])
def test_incompressible_poisson_ratio_is_refused(ratio):
    with pytest.raises(SceneError, match=r"material\."):
        NeoHooke.from_young(1.0, ratio)
