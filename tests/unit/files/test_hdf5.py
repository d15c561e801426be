"""Names in result.h5: no slash that is no path, whatever contacts are called; and a layout that is told."""

import csv
import math
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest

from ngwear.errors import ResultError
from ngwear.files.hdf5 import LAYOUT, get_series, name_of, put, put_series, stored_name, subgroup, write
from ngwear.files.result_folder import FIELDS, SERIES
from ngwear.loop.run import run
from ngwear.plots.wear import plot
from ngwear.results.kept_sections import KeptSections
from ngwear.results.result_file import read_result
from ngwear.results.section import Section

ODD = "rod/seal: 1/2"


def all_names(h5):
    """Of every group, dataset and attribute, and the datasets' values."""
    names, values = set(), []

    def take(name, item):
        parent, own = item.parent.name, item.name
        names.add(own[len(parent) :].removeprefix("/"))
        names.update(item.attrs)
        if isinstance(item, h5py.Dataset):
            values.append(item[()])

    names.update(h5.attrs)
    h5.visititems(take)
    return names, values


def test_a_name_with_a_slash_is_stored_without_and_read_as_it_was(tmp_path):
    rows = [
        {"force x [N/mm]": 1.5, "kind [-]": "out", "n [-]": 3},
        {"force x [N/mm]": -2.5, "kind [-]": "in", "n [-]": 4},
    ]
    with (tmp_path / "a.h5").open("w+b") as file:
        write(file, lambda h5: put_series(h5, rows))
    with h5py.File(tmp_path / "a.h5") as h5:
        assert set(h5["series"]) == {"force x [N per mm]", "kind [-]", "n [-]"}
        series = get_series(h5)
    assert {name: values.tolist() for name, values in series.items()} == {
        name: [row[name] for row in rows] for name in rows[0]
    }


@pytest.mark.parametrize("name", ["a/b", "/", ".", "..", "", "...", "a per b", "µ/mm²", "a'"])
def test_names_of_all_kinds_come_back(tmp_path, name):
    with h5py.File(tmp_path / "a.h5", "w") as h5:
        inner = subgroup(h5, name)
        put(inner, name, [1.0])
        put(inner, stored_name(name), [2.0])
        assert sorted(map(name_of, inner.values())) == sorted([name, stored_name(name)])
        assert [name_of(item) for item in h5.values()] == [name]
        assert not any("/" in part for item in inner.values() for part in item.name[len(inner.name) + 1 :])


@pytest.fixture
def oddly_named(sheet, tmp_path):
    """A run whose contacts are called as nobody should."""
    (contact,) = sheet.contacts
    program = replace(sheet.program, strokes=1)
    contacts = (replace(contact, name=ODD),)
    run(replace(sheet, contacts=contacts, program=program), out=tmp_path / "odd", figures=False)
    return tmp_path / "odd"


def test_a_contact_with_slashes_in_its_name(oddly_named):
    result = read_result(oddly_named)
    assert list(result.snapshots[0].profiles) == list(result.wear_rates) == list(result.surfaces) == [ODD]
    assert set(result.series) == set(next(csv.reader((oddly_named / SERIES).read_text().splitlines())))
    assert f"{ODD} force x [N/mm]" in result.series
    assert list(Section.of(KeptSections.of(result).at().section).contacts) == [ODD]
    assert plot(oddly_named)
    with h5py.File(oddly_named / FIELDS) as h5:
        pressure = h5[f"strokes/00000/{stored_name(ODD)}/pressure [MPa]"]
        assert pressure[()].max() > 0


@pytest.mark.parametrize("name", ["section", "elements", "outline [mm]"])
def test_a_contact_called_as_a_part_of_the_file(sheet, tmp_path, name):
    (contact,) = sheet.contacts
    program = replace(sheet.program, strokes=1)
    scene = replace(sheet, contacts=(replace(contact, name=name),), program=program)
    run(scene, out=tmp_path / "out", figures=False)
    result = read_result(tmp_path / "out")
    assert list(result.snapshots[0].profiles) == [name]
    assert "triangles" in result.snapshots[0].section


def test_no_name_in_a_result_has_a_slash_and_no_number_is_subnormal(finished):
    with h5py.File(finished / FIELDS) as h5:
        names, values = all_names(h5)
        assert h5.attrs["layout"] == LAYOUT
        assert "pressure [MPa]" in h5["strokes/00000/roller"]
    assert [name for name in names if "/" in name] == []
    numbers = np.concatenate([array.ravel() for array in values if array.dtype.kind == "f"])
    small = (numbers != 0) & (np.abs(numbers) < np.finfo(float).tiny)
    assert not small.any()


@pytest.mark.parametrize(
    ("layout", "told"),
    [
        (None, r"has layout 1, written by ngwear .*which reads layout 2: run the scene again into another folder"),
        (1, "has layout 1"),
        (LAYOUT + 1, "has layout 3, written by ngwear .*, or take ngwear"),
    ],
)
def test_a_result_of_another_layout_says_which_and_what_to_do(finished, layout, told):
    with h5py.File(finished / FIELDS, "a") as h5:
        del h5.attrs["layout"]
        if layout is not None:
            h5.attrs["layout"] = layout
    with pytest.raises(ResultError, match=told):
        read_result(finished)


def test_what_was_never_a_number_stays(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as h5:
        put(h5, "a", np.array([5e-324, math.nan, math.inf, 1.0]))
        assert str(h5["a"][()].tolist()) == "[0.0, nan, inf, 1.0]"
    assert Path(tmp_path / "a.h5").is_file()
