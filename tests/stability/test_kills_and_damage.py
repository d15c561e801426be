"""Kills at many moments, files cut anywhere, wear of many random outlines."""

import math
import random
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest

from ngwear.equilibrium.linear import has_pardiso
from ngwear.errors import GeometryError, ResultError
from ngwear.files.result_folder import CHECKPOINT, FIELDS, SERIES
from ngwear.geometry.outline import Outline
from ngwear.geometry.recession import recede
from ngwear.loop.checkpoint import load
from ngwear.loop.run import run
from ngwear.plots.wear import plot
from ngwear.results.recorder import Folder
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.read_scene import read_scene

CLI = "import sys; from ngwear.cli import main; sys.exit(main(sys.argv[1:]))"


def test_killed_again_and_again_it_still_gets_there(tmp_path, write_sheet):
    """A run killed within half a second of every checkpoint goes on each time and ends where it would have."""
    file = write_sheet(tmp_path, ("strokes = 4", "strokes = 40"))
    scene = read_scene(file)
    whole = run(scene, figures=False)
    out, rng, kills = tmp_path / "out", random.Random(), 0
    for _ in range(30):
        before = (out / CHECKPOINT).stat().st_mtime_ns if (out / CHECKPOINT).exists() else 0
        process = subprocess.Popen(
            [sys.executable, "-c", CLI, "run", str(file), "--out", str(out), "--quiet", "--resume"]
        )
        while process.poll() is None:
            if (out / CHECKPOINT).exists() and (out / CHECKPOINT).stat().st_mtime_ns > before:
                time.sleep(rng.uniform(0, 0.3))
                process.send_signal(signal.SIGKILL)
                break
            time.sleep(0.002)
        code = process.wait()
        if code == 0:
            break
        assert code == -signal.SIGKILL
        kills += 1
        left = load(Folder(out, scene, resume=True), scene)
        assert left is not None
        if left[0].strokes == 40:
            break
    assert kills >= 2
    last = run(scene, out=out, resume=True, figures=False)
    assert last.summary["worn area [mm^2]"] == pytest.approx(whole.summary["worn area [mm^2]"], rel=1e-9)
    assert last.summary["solves"] == whole.summary["solves"]
    assert len(last.recorder.rows) == len(whole.recorder.rows)
    assert (out / SERIES).read_text().count("\n") == 42


@pytest.mark.skipif(not has_pardiso(), reason="only PARDISO (the extra 'fast') repeats itself bit for bit")
def test_the_shipped_seal_killed_and_resumed_ends_bit_for_bit_the_same(tmp_path, seal):
    """Meshes, jumps and all: one digit lost in a checkpoint and a mesh-size decision goes the other way."""
    few = replace(seal.program, strokes=60)
    scene = replace(seal, accuracy=Accuracy(), program=few, save=replace(seal.save, strokes=()))
    whole = run(scene, figures=False)
    out = tmp_path / "out"

    def stop(state):
        if state.strokes >= 20:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(scene, out=out, figures=False, on_step=stop)
    last = run(scene, out=out, resume=True, figures=False)
    spent = {"wall time [s]", "CPU time [s]", "peak memory [MB]"}
    assert {k: v for k, v in last.summary.items() if k not in spent} == {
        k: v for k, v in whole.summary.items() if k not in spent
    }
    np.testing.assert_array_equal(last.state.contour.points, whole.state.contour.points)


def test_result_and_checkpoint_cut_anywhere_are_refused(finished, sheet, tmp_path):
    rng = random.Random(7)
    for name, reader in ((FIELDS, plot), (CHECKPOINT, lambda p: load(Folder(p, sheet, resume=True), sheet))):
        whole = (finished / name).read_bytes()
        for _ in range(40):
            folder = tmp_path / "cut"
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
            (folder / name).write_bytes(whole[: rng.randrange(len(whole))])
            with pytest.raises(ResultError, match=f"{name} cannot be read"):
                reader(folder)


def wavy(rng, n):
    """A star-shaped outline with random waves."""
    angle = 2 * np.pi * np.arange(n) / n
    radius = 1 + sum(rng.uniform(-0.15, 0.15) * np.cos(k * angle + rng.uniform(0, 6)) for k in range(2, 6))
    return Outline(radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1), ("rim",) * n, np.zeros(n, bool))


@pytest.mark.parametrize("seed", range(200))
def test_random_outline_loses_its_shares_or_is_refused(seed):
    rng = np.random.default_rng(seed)
    outline = wavy(rng, int(rng.integers(20, 300)))
    share = np.maximum(rng.normal(size=len(outline)).cumsum(), 0)
    share *= 10 ** rng.uniform(-9, -1.5) / max(share.sum(), 1e-9)
    try:
        worn = recede(outline, share, ("rim",))
    except GeometryError as error:
        refused = str(error)
    else:
        refused = None
    if refused is not None:
        assert "near" in refused or "worn away" in refused
        return
    if len(worn) == len(outline):
        lost = area(outline.points) - area(worn.points)
        assert lost == pytest.approx(share.sum(), rel=1e-10, abs=1e-15)
    assert set(worn.names) == {"rim"}


def area(points):
    x, y = points.T
    x2, y2 = np.roll(x, -1), np.roll(y, -1)
    return 0.5 * math.fsum(np.concatenate([x * y2, -x2 * y]))
