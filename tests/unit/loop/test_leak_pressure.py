import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ngwear.effects.blow_by import leak_pressure
from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.effects.fluid_pressure import FluidPressure
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.equilibrium.stepping import advance
from ngwear.error_estimates.coarser_runs import combined_errors
from ngwear.error_estimates.cost import cost
from ngwear.error_estimates.cost_runs import wear_values
from ngwear.error_estimates.run_to_error import at_level
from ngwear.errors import SceneError
from ngwear.fields.kinematics import PlaneStrain
from ngwear.geometry.outline import Outline
from ngwear.loop.run import run
from ngwear.loop.stepper import Stepper
from ngwear.plots.wear import history_figure
from ngwear.results.quantities_of_interest import LEAKS, quantities
from ngwear.results.recorder import LEAK
from ngwear.results.result_file import read_result
from ngwear.scene.boundary import Fluid
from ngwear.scene.program import Program, Stroke
from ngwear.scene.toml_values import record
from ngwear.surfaces import Plane
from ngwear.verify.builders import meshed
from ngwear.verify.leak_pressure import PRESSURES, RUBBER, scene
from ngwear.verify.rod_seal import shipped_scene

FIRST = "leaks first at [-]"


@pytest.fixture(scope="module")
def block(tmp_path_factory):
    folder = tmp_path_factory.mktemp("block")
    return folder, run(scene(), out=folder)


def test_the_way_that_is_closed_by_less_leaks_first():
    """A block on a plate, and a tilted plate on its top: that presses harder on the fluid's way than the lower one."""
    lower = OutlineContact("lower", ("bottom",), Plane(point=(0.0, 0.0), normal_vector=(0.0, 1.0)), modulus=1.0)
    tilted = Plane(point=(2.0, 0.9), normal_vector=(0.05, -1.0))
    upper = OutlineContact("upper", ("top",), tilted, modulus=1.0)
    fluid = FluidPressure(("bottom", "right", "top"), ("right",), (lower, upper))
    body = meshed(Outline.rectangle((0.0, 2.0), (0.0, 1.0)), 0.25)
    held = [FixedEdges(("left",), y=False)]
    problem = Problem(body, PlaneStrain(), [Elasticity(RUBBER), lower, upper, fluid], supports=held)
    upper.load.Set(-0.2)
    advance(problem, {"upper approach [mm]": 0.0})
    below, above = (contact.profile().pressure.max() for contact in (lower, upper))
    assert above > 1.05 * below
    assert leak_pressure(fluid) == (pytest.approx(below, rel=1e-12), "bottom")


def test_a_way_without_contact_holds_nothing():
    lower = OutlineContact("lower", ("bottom",), Plane(point=(0.0, 0.1), normal_vector=(0.0, 1.0)), modulus=1.0)
    fluid = FluidPressure(("bottom", "right", "top"), ("right",), (lower,))
    body = meshed(Outline.rectangle((0.0, 2.0), (0.0, 1.0)), 0.25)
    held = [FixedEdges(("left",), y=False), FixedEdges(("top",), x=False)]
    problem = Problem(body, PlaneStrain(), [Elasticity(RUBBER), lower, fluid], supports=held)
    lower.load.Set(-0.1)
    advance(problem, {"lower approach [mm]": 0.0})
    assert lower.profile().pressure.max() > 0.1
    assert leak_pressure(fluid)[0] == 0.0
    assert fluid.leaks


def test_series_summary_and_study_tell_what_the_seal_holds(block):
    rows, summary = block[1].recorder.rows, block[1].summary
    last = rows[-len(PRESSURES) :]
    for pressure, row in zip(PRESSURES, last, strict=True):
        assert summary[f"last {pressure:g} MPa {LEAK}"] == row[LEAK] > pressure
        assert row[FIRST] in ("bottom", "top")
    assert summary[LEAK] == last[-1][LEAK], "of the stroke under the highest pressure"
    assert summary["leaks first at"] == last[-1][FIRST]
    assert summary["warnings"] == []
    assert wear_values(scene(), summary, rows)[LEAK] == summary[LEAK]


def test_its_error_is_stated_and_drawn(block):
    folder, result = block
    read = quantities(result.recorder.rows)
    assert set(read[LEAKS]) == {f"{p:g} MPa: {LEAK}" for p in PRESSURES}
    other = {**read, LEAKS: {kind: (1.02 * np.array(values)).tolist() for kind, values in read[LEAKS].items()}}
    errors = combined_errors(scene(), result.summary["error estimates"], read, other)
    assert errors[LEAKS] == pytest.approx(0.02)
    file = read_result(folder)
    pressures = history_figure(replace(file, errors=errors)).axes[-1]
    assert pressures.get_ylabel() == LEAK
    top = [band.get_paths()[0].vertices[:, 1].max() for band in pressures.collections]
    leaks = [file.series[LEAK][file.series["kind [-]"] == kind].max() for kind in file.kinds]
    assert top == pytest.approx([1.02 * leak for leak in leaks])


@pytest.mark.parametrize("fluid", [None, replace(scene().fluid, leak_pressure=False)])
def test_where_it_is_not_asked_for_there_is_none(fluid):
    dry = Program(cycle=(Stroke(name="still", travel=1.0),), strokes=1)
    result = run(replace(scene(), fluid=fluid, program=dry), figures=False)
    assert not [name for name in (*result.recorder.rows[-1], *result.summary) if "leak pressure" in name]
    assert LEAKS not in quantities(result.recorder.rows)


@pytest.mark.slow
def test_meshes_are_fine_where_the_fluid_meets_a_contact_that_is_not_followed():
    seal, longest = at_level(shipped_scene(), 2.5), []
    for asked in (False, True):
        stage = Stepper(replace(seal, fluid=replace(seal.fluid, leak_pressure=asked))).start().stage
        bore = stage.contacts["housing bore"]
        ends = bore.end_places()[bore.touching()]
        edges = np.linalg.norm(np.diff(ends, axis=1), axis=2).ravel()
        longest.append(edges[ends[:, :, 0].max(axis=1).argmax()] / stage.scene.accuracy.patch)
    assert longest[1] < 1.5 < 2 < longest[0]


def test_a_scene_file_asks_for_it():
    text = (Path(__file__).parents[3] / "geometries" / "rod_seal" / "scene.toml").read_text(encoding="utf-8")
    data = tomllib.loads(text)["fluid"]
    assert not record(Fluid, "fluid", data).leak_pressure
    assert record(Fluid, "fluid", data | {"leak_pressure": True}).leak_pressure
    with pytest.raises(SceneError, match=r"fluid\.leak_pressure = 1"):
        record(Fluid, "fluid", data | {"leak_pressure": 1})


def test_a_study_reads_it_whether_it_is_asked_for_or_not(monkeypatch):
    def seen(asked, *_):
        raise InterruptedError(asked.fluid.leak_pressure)

    monkeypatch.setattr("ngwear.error_estimates.cost._runner", seen)
    with pytest.raises(InterruptedError, match="True"):
        cost(replace(scene(), fluid=replace(scene().fluid, leak_pressure=False)), budget=1.0)
