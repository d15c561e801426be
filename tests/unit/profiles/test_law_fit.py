"""Fit of a law of wear to one profile, from the pressures of a run by Archard's law."""

from dataclasses import replace

import numpy as np
import pytest

from ngwear.errors import SceneError
from ngwear.laws import PowerWear, SaturatingWear, ThresholdWear
from ngwear.loop.run import run
from ngwear.profiles.comparison import compare_profile
from ngwear.profiles.law_fit import fit_wear_law
from ngwear.profiles.worn_edge import read_worn_edge
from ngwear.scene.read_scene import read_scene

RATE, SLID = 1e-4, 200.0
TRUE = {
    "power": PowerWear(exponent=2.0, reference_pressure=0.3),
    "threshold": ThresholdWear(pressure=0.1),
    "saturating": SaturatingWear(pressure=0.3),
}


@pytest.fixture(scope="module")
def fine(tmp_path_factory, write_sheet):
    """The small scene on a finer mesh, of little wear, and its run by Archard's law with another rate."""
    folder = tmp_path_factory.mktemp("fit")
    scene = read_scene(write_sheet(folder))
    scene = replace(
        scene,
        accuracy=replace(scene.accuracy, patch=0.05, mounting=0.1),
        program=replace(scene.program, strokes=20),
        wear=replace(scene.wear, step="fixed", max_jump=5),
    )
    return scene, worn(scene, folder / "archard", None, 1.6 * RATE)


def worn(scene, folder, law, rate):
    contact = replace(scene.contacts[0], wear_law=law, specific_wear_rate=rate)
    run(replace(scene, contacts=(contact,)), out=folder, figures=False)
    return folder


@pytest.fixture(scope="module")
def power(fine, tmp_path_factory):
    return compared(fine, tmp_path_factory.mktemp("power"), TRUE["power"])


def compared(fine, folder, law):
    """The Archard run compared with a noisy profile of a part that wears by ``law``."""
    scene, archard = fine
    edge, path = read_worn_edge(worn(scene, folder / "part", law, RATE)), folder / "profile.csv"
    height = np.random.default_rng(0).normal(edge.heights[-1], 2e-5)
    table = np.column_stack([edge.place, height])[::4]
    np.savetxt(path, table, delimiter=",", header="x [mm],z [mm]", comments="")
    return compare_profile(archard, path, distance=SLID)


@pytest.mark.parametrize("family", ["power", *(pytest.param(f, marks=pytest.mark.slow) for f in TRUE if f != "power")])
def test_law_and_rate_of_a_slightly_worn_part(fine, power, tmp_path, family):
    comparison = power if family == "power" else compared(fine, tmp_path, TRUE[family])
    true = TRUE[family]
    found = fit_wear_law(fine[1], comparison, family)
    assert type(found.law) is type(true)
    rate = found.specific_wear_rate
    if family == "power":
        assert found.law.exponent == pytest.approx(true.exponent, rel=0.2)
        rate *= found.law.factor(true.reference_pressure)
    else:
        assert found.law.pressure == pytest.approx(true.pressure, rel=0.3)
    assert rate == pytest.approx(RATE, rel=0.2)
    assert found.residual <= found.residuals.min() * (1 + 1e-9)
    assert found.residual < 0.3 * found.archard


def test_what_cannot_be_fitted_is_said(fine, power):
    with pytest.raises(SceneError, match=r"family = 'cubic': must be one of \['power'"):
        fit_wear_law(fine[1], power, "cubic")
    inclined = replace(power, edge=replace(power.edge, axis="along the edge"))
    with pytest.raises(SceneError, match="along x or y only"):
        fit_wear_law(fine[1], inclined)
