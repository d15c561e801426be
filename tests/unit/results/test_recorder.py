import csv
import errno
import io
import json
import os
from dataclasses import replace

import numpy as np
import pytest

from ngwear.errors import ResultError
from ngwear.files.result_folder import FIELDS, SERIES, SUMMARY
from ngwear.loop.checkpoint import load
from ngwear.plots.schemes import draw_schemes
from ngwear.plots.wear import is_mirrored, plot, worn_edge
from ngwear.results.recorder import Folder, depths, fingerprint
from ngwear.results.result_file import read_result
from ngwear.scene.read_scene import read_scene

CHANGES = [
    ("shear = 1.0", "shear = 1.0000001"),
    ("force = 0.5", "force = 0.51"),
    ("friction = 0.1", "friction = 0.2"),
    ("1.0e-3", "1.1e-3"),
    ("strokes = 4", "strokes = 5"),
    ("travel = 10.0", "travel = 10.5"),
    ("patch = 0.2", "patch = 0.09"),
    ("radius = 2.0", "radius = 1.99"),
    ('[[support]]\nedges = ["bottom"]', '[[support]]\nedges = ["bottom"]\nx = false'),
]


def test_fingerprint_is_the_same_for_two_reads(sheet_file):
    assert fingerprint(read_scene(sheet_file)) == fingerprint(read_scene(sheet_file))


@pytest.mark.parametrize("change", CHANGES)
def test_fingerprint_changes_with_the_scene(tmp_path, sheet, write_sheet, change):
    assert fingerprint(read_scene(write_sheet(tmp_path / "other", change))) != fingerprint(sheet)


def test_fingerprint_changes_with_the_outline(sheet):
    moved = sheet.part.outline.moved(np.where(np.arange(len(sheet.part.outline))[:, None] == 9, 1e-9, 0.0))
    assert fingerprint(replace(sheet, part=replace(sheet.part, outline=moved))) != fingerprint(sheet)
    renamed = replace(sheet.part.outline, names=("floor",) * 2 + sheet.part.outline.names[2:])
    assert fingerprint(replace(sheet, part=replace(sheet.part, outline=renamed))) != fingerprint(sheet)


def test_depth_of_a_lowered_top(rectangle):
    before, after = rectangle(4.0, 2.0, 8, 4), rectangle(4.0, 1.9, 8, 4)
    depth = depths(before, after)
    assert depth[np.isclose(before.points[:, 1], 2.0)] == pytest.approx(0.1)
    assert depth[np.isclose(before.points[:, 1], 0.0)] == pytest.approx(0.0, abs=1e-15)


def test_file_is_replaced_as_a_whole(tmp_path, sheet):
    folder = Folder(tmp_path / "out", sheet, resume=False)
    folder.replace("a.txt", lambda file: file.write(b"old"))

    def fails(file):
        file.write(b"half of the ne")
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with pytest.raises(ResultError, match=r"a\.txt cannot be written: No space left.*last saved state is kept.*resume"):
        folder.replace("a.txt", fails)
    assert (folder.path / "a.txt").read_bytes() == b"old"
    assert [p.name for p in folder.path.iterdir()] == ["a.txt"], "no temporary file is left"


def test_interrupted_write_leaves_the_old_file(tmp_path, sheet):
    folder = Folder(tmp_path / "out", sheet, resume=False)
    folder.replace("a.txt", lambda file: file.write(b"old"))

    def interrupted(file):
        file.write(b"half")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        folder.replace("a.txt", interrupted)
    assert (folder.path / "a.txt").read_bytes() == b"old"
    assert [p.name for p in folder.path.iterdir()] == ["a.txt"]


def test_fields_that_do_not_fit_on_the_disk(finished, sheet):
    """The limit on the size of a file is a full disk that needs no root; HDF5 has to pass the error on."""
    folder = Folder(finished, sheet, resume=True)
    _, recorder = load(folder, sheet)
    before = (finished / FIELDS).read_bytes()
    resource = pytest.importorskip("resource", reason="Windows limits no process' files")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(before) // 3, hard))
    try:
        with pytest.raises(ResultError, match=r"result\.h5 cannot be written"):
            folder.finish(recorder, {"status": "completed"})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert (finished / FIELDS).read_bytes() == before
    assert not list(finished.glob(".*")), "no temporary file is left"


def test_result_file_holds_the_run(finished, sheet):
    result = read_result(finished)
    summary = json.loads((finished / SUMMARY).read_text())
    assert result.scene == "sheet"
    assert (result.outline == sheet.part.outline.points).all()
    assert [s.stroke for s in result.snapshots] == [0, 1, 2, 3, 4]
    assert result.kinds == ["stroke"]
    assert result.series["maximum depth [mm]"][-1] == summary["maximum depth [mm]"]
    assert result.snapshots[0].section["triangles"].shape[1] == 6
    assert [s.stroke for s in result.snapshots if s.section] == [0, 4]
    assert result.at(2.2, "stroke").stroke == 2


def test_series_in_the_result_file_is_the_csv(finished):
    rows = list(csv.DictReader(io.StringIO((finished / SERIES).read_text())))
    series = read_result(finished).series
    assert set(series) == set(rows[0])
    for column in set(rows[0]) - {"kind [-]"}:
        assert [float(row[column]) for row in rows] == pytest.approx(list(series[column]), rel=1e-12), column


def test_profiles_balance_the_force(finished):
    """Pressure times length over the deformed contact is the prescribed force (few nodes: a coarse check)."""
    for snapshot in read_result(finished).snapshots:
        profile = snapshot.profiles["roller"]
        order = np.argsort(profile["place [mm]"][:, 0])
        p, x = profile["pressure [MPa]"][order], profile["place [mm]"][order, 0]
        force = np.diff(x) @ (p[:-1] + p[1:]) / 2
        assert force == pytest.approx(0.5, rel=0.05)


DAMAGE = {
    "truncated": lambda data: data[: len(data) // 2],
    "cut short": lambda data: data[:-100],
    "empty": lambda data: b"",
    "garbage": lambda data: bytes(range(256)) * 40,
    "overwritten": lambda data: data[:512] + bytes(len(data) - 512),
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_damaged_result_file_is_refused(finished, damage):
    file = finished / FIELDS
    file.write_bytes(DAMAGE[damage](file.read_bytes()))
    with pytest.raises(ResultError, match=r"result\.h5 cannot be read as a result of ngwear"):
        plot(finished)


@pytest.mark.parametrize("missing", ["strokes", "series", "outline", "strokes/00000/outline [mm]"])
def test_result_file_without_a_part_is_refused(finished, missing):
    import h5py

    with h5py.File(finished / FIELDS, "r+") as h5:
        del h5[missing]
    with pytest.raises(ResultError, match=r"result\.h5 cannot be read as a result of ngwear"):
        plot(finished)


def test_hdf5_file_of_another_program_is_refused(tmp_path):
    import h5py

    with h5py.File(tmp_path / FIELDS, "w") as h5:
        h5["strokes"] = [1, 2, 3]
        h5["series"] = [1, 2, 3]
    with pytest.raises(ResultError, match=r"result\.h5 cannot be read as a result of ngwear"):
        plot(tmp_path)


def test_result_file_that_lost_a_column_or_a_profile_is_refused(finished):
    import h5py

    with h5py.File(finished / FIELDS, "r+") as h5:
        del h5["series/maximum depth [mm]"]
    with pytest.raises(ResultError, match="maximum depth"):
        plot(finished)


def test_missing_result_file_says_what_to_give(tmp_path):
    with pytest.raises(ResultError, match=r"result\.h5 does not exist: give the folder of a finished run"):
        plot(tmp_path)


def test_picture_that_cannot_be_written(finished):
    (finished / "section.png").unlink()
    (finished / "section.png").mkdir()
    with pytest.raises(ResultError, match=r"section\.png cannot be written"):
        plot(finished)


def test_outlines_that_are_their_own_mirror_image(rectangle, seal):
    points = rectangle(4.0, 2.0, 4, 2).points
    assert is_mirrored(points + np.array([7.0, -3.0]))
    points[3, 0] += 0.1
    assert is_mirrored(points), "a point more to the right on the same straight edge"
    points[3, 1] += 0.1
    assert not is_mirrored(points)
    assert not is_mirrored(seal.part.outline.points)


def test_worn_edge_is_the_whole_top_from_left_to_right(finished):
    result = read_result(finished)
    unworn, worn = (worn_edge(result.snapshots[i]) for i in (0, -1))
    assert (unworn[:, 1] == 2.0).all()
    for edge in (unworn, worn):
        assert edge[[0, -1]] == pytest.approx(np.array([[0.0, 2.0], [4.0, 2.0]]))
        assert (np.diff(edge[:, 0]) > 0).all()
    lost = 4.0 * 2.0 - np.trapezoid(worn[:, 1], worn[:, 0])
    assert lost == pytest.approx(result.series["area removed from the outline [mm^2]"][-1], rel=1e-9)


def test_schemes_side_by_side(finished, tmp_path):
    file = tmp_path / "schemes.png"
    draw_schemes({"explicit": {"0.1 mm": finished}, "implicit": {"0.1 mm": finished}}, 4, file)
    assert file.read_bytes().startswith(b"\x89PNG")
    with pytest.raises(ResultError, match=r"cannot be written"):
        draw_schemes({"implicit": {"0.1 mm": finished}}, 4, tmp_path / "nowhere" / "schemes.png")
