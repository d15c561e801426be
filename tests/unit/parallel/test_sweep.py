"""Sweeps: any executor, failures kept apart, resumption, and a kill."""

import functools
import os
import pickle
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import sweep_points as at

from ngwear.errors import ResultError, SceneError
from ngwear.parallel.sweep import sweep


def results(outcomes):
    return [o.result for o in outcomes]


@pytest.fixture
def log(tmp_path):
    return tmp_path / "log.txt"


def test_processes_keep_the_order_and_take_one_thread_each():
    outcomes = sweep(at.square, [5, 1, 3], workers=2)
    assert [(o.point, o.result, o.ok, o.restored) for o in outcomes] == [
        (5, 25, True, False),
        (1, 1, True, False),
        (3, 9, True, False),
    ]
    (told, worker), *_ = results(sweep(at.threads, [0], workers=1))
    assert told == "1"
    assert worker != os.getpid()


def test_failures_and_a_crashed_worker_leave_the_rest_alone():
    outcomes = sweep(at.picky, range(1, 8), workers=2)
    assert results(outcomes) == [1, 4, None, None, 25, 36, 49]
    raised, crashed = outcomes[2].failure, outcomes[3].failure
    assert (raised.kind, raised.message) == ("SceneError", "x = 3: three is refused")
    assert "sweep_points.py" in raised.traceback
    assert crashed.kind == "BrokenProcessPool"


def test_dask_client_is_an_executor_like_any_other():
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
        client.get_executor() as executor,
    ):
        outcomes = sweep(at.picky, [1, 2, 3], executor=executor)
    assert results(outcomes) == [1, 4, None]
    assert outcomes[2].failure.message == "x = 3: three is refused"


def test_resuming_computes_only_what_is_missing(tmp_path, log):
    function = functools.partial(at.counted, log=str(log))
    with ThreadPoolExecutor(2) as pool:
        options = {"executor": pool, "folder": tmp_path / "sweep"}
        sweep(function, [1.0, 2.0], **options)
        outcomes = sweep(function, [2.0, 3.0, 1.0], resume=True, **options)
        assert results(outcomes) == [4.0, 9.0, 1.0]
        assert [o.restored for o in outcomes] == [True, False, True]
        assert sorted(log.read_text().split()) == ["1.0", "2.0", "3.0"]
        changed = functools.partial(at.counted, log=str(log), wait=1e-3)
        assert not any(o.restored for o in sweep(changed, [1.0, 2.0], resume=True, **options))
        assert not any(o.restored for o in sweep(function, [1.0, 2.0], **options))
    assert len(list((tmp_path / "sweep").iterdir())) == 5


def test_equal_points_have_one_key_whatever_objects_they_are_made_of(tmp_path, log):
    function = functools.partial(at.counted, log=str(log))
    name = "".join(["a", "b"])
    with ThreadPoolExecutor(1) as pool:
        sweep(len, [(name, name, np.arange(3.0).tobytes())], executor=pool, folder=tmp_path)
        point = ("".join(["a", "b"]), "ab", np.arange(3.0).tobytes())
        assert sweep(len, [point], executor=pool, folder=tmp_path, resume=True)[0].restored
        assert not sweep(function, [2], executor=pool, folder=tmp_path, resume=True)[0].restored


KILLED = """
import functools, sys
sys.path.insert(0, {tests!r})
import sweep_points as at
from ngwear.parallel.sweep import sweep
if __name__ == "__main__":
    sweep(functools.partial(at.counted, log={log!r}, wait=0.25), range(40), workers=2, folder={folder!r})
"""


def test_killed_sweep_goes_on(tmp_path, log):
    folder, script = tmp_path / "sweep", tmp_path / "script.py"
    script.write_text(KILLED.format(tests=str(Path(__file__).parent), log=str(log), folder=str(folder)))
    process = subprocess.Popen([sys.executable, script])
    while not (folder.is_dir() and len(list(folder.glob("*.npz"))) >= 3):
        assert process.poll() is None
        time.sleep(0.02)
    process.kill()
    process.wait()
    time.sleep(1.0)
    before = len(list(folder.glob("*.npz")))
    calls = len(log.read_text().split())
    assert before <= calls <= before + 2  # the workers have ended with their parent
    function = functools.partial(at.counted, log=str(log), wait=0.25)
    outcomes = sweep(function, range(before + 3), workers=2, folder=folder, resume=True)
    assert results(outcomes) == [x * x for x in range(before + 3)]
    assert sum(o.restored for o in outcomes) == before


def test_what_cannot_be_written_is_a_failure(tmp_path):
    with ThreadPoolExecutor(1) as pool:
        (outcome,) = sweep(at.unpicklable, [1], executor=pool, folder=tmp_path)
    assert "the class builtins.function cannot be written" in outcome.failure.message
    assert "dataclasses that are listed as 'classes'" in outcome.failure.message
    assert not list(tmp_path.glob("*.npz"))


def test_damaged_file_is_named(tmp_path):
    with ThreadPoolExecutor(1) as pool:
        sweep(at.square, [1], executor=pool, folder=tmp_path)
        (file,) = tmp_path.glob("*.npz")
        file.write_bytes(b"cut off")
        with pytest.raises(ResultError, match=rf"the result of the point 1 is lost: .*{file.name} cannot.*delete it"):
            sweep(at.square, [1], executor=pool, folder=tmp_path, resume=True)


def test_results_made_of_dataclasses_come_back_as_they_were(tmp_path):
    with ThreadPoolExecutor(2) as pool:
        how = {"executor": pool, "folder": tmp_path, "classes": (at.Found, at.Ending)}
        first = sweep(at.described, [1.0, 2.0], **how)
        again = sweep(at.described, [2.0, 1.0], resume=True, **how)
        assert all(o.restored for o in again)
        for mine, its in zip(first, reversed(again), strict=True):
            np.testing.assert_array_equal(mine.result.values, its.result.values)
            assert (mine.result.notes, mine.result.ending) == (its.result.notes, its.result.ending)
        unlisted = sweep(at.described, [3.0], executor=pool, folder=tmp_path)
        assert "sweep_points.Found cannot be written" in unlisted[0].failure.message
        with pytest.raises(ResultError, match="an object of the class 'Found', which has no place here"):
            sweep(at.described, [1.0], executor=pool, folder=tmp_path, resume=True)


@pytest.mark.parametrize("classes", [(int,), ("Found",), (lambda: 1,)])
def test_classes_that_cannot_be_stored_are_refused(tmp_path, classes):
    with pytest.raises(SceneError, match=r"sweep\.classes.*must be a dataclass or an enumeration"):
        sweep(at.square, [1], folder=tmp_path, classes=classes)


class Bomb:
    """A pickle that runs a program when it is read."""

    def __reduce__(self):
        return os.mkdir, ("exploded",)


def test_a_crafted_file_is_refused_and_never_executed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "sweep"
    with ThreadPoolExecutor(1) as pool:
        sweep(at.square, [1], executor=pool, folder=folder)
        (file,) = folder.glob("*.npz")
        file.write_bytes(pickle.dumps(Bomb()))
        with pytest.raises(ResultError, match="cannot be read as a result of a sweep"):
            sweep(at.square, [1], executor=pool, folder=folder, resume=True)
    assert not (tmp_path / "exploded").exists()


def test_results_of_the_first_version_are_told_and_not_read(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    old = tmp_path / "0123.pickle"
    old.write_bytes(pickle.dumps(Bomb()))
    with ThreadPoolExecutor(1) as pool:
        with pytest.raises(
            ResultError, match=r"0123\.pickle holds a result of ngwear 0\.1; this is ngwear .*delete such"
        ):
            sweep(at.square, [1], executor=pool, folder=tmp_path, resume=True)
        assert results(sweep(at.square, [3], executor=pool, folder=tmp_path)) == [9]
    assert old.exists()
    assert not (tmp_path / "exploded").exists()


def test_function_typed_into_a_session_is_refused():
    code = (
        "from ngwear.parallel.sweep import sweep\n"
        "from ngwear.errors import SceneError\n"
        "def mine(x): return x\n"
        "try: sweep(mine, [1])\n"
        "except SceneError as error: assert 'top of a module' in str(error)\n"
        "else: raise SystemExit(1)"
    )
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


@pytest.mark.parametrize(
    ("function", "points", "options", "told"),
    [
        (at.square, [], {}, "at least one point"),
        (lambda x: x, [1], {}, "sweep.function.*top of a module"),
        (at.square, [lambda: 1], {}, "sweep.point .*cannot be pickled"),
        (at.square, [1], {"workers": 0}, "sweep.workers = 0"),
        (at.square, [1], {"workers": 2, "executor": object()}, "one or the other"),
        (at.square, [1], {"resume": True}, "needs the folder"),
    ],
)
def test_bad_input(function, points, options, told):
    with pytest.raises(SceneError, match=told):
        sweep(function, points, **options)


def test_folder_that_is_a_file(log):
    log.write_text("")
    with pytest.raises(ResultError, match=r"log\.txt is a file"):
        sweep(at.square, [1], folder=log)
