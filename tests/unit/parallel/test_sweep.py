"""Sweeps: any executor, failures kept apart, resumption, and a kill."""

import functools
import os
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
    while not (folder.is_dir() and len(list(folder.glob("*.pickle"))) >= 3):
        assert process.poll() is None
        time.sleep(0.02)
    process.kill()
    process.wait()
    time.sleep(1.0)
    before = len(list(folder.glob("*.pickle")))
    calls = len(log.read_text().split())
    assert before <= calls <= before + 2  # the workers have ended with their parent
    function = functools.partial(at.counted, log=str(log), wait=0.25)
    outcomes = sweep(function, range(before + 3), workers=2, folder=folder, resume=True)
    assert results(outcomes) == [x * x for x in range(before + 3)]
    assert sum(o.restored for o in outcomes) == before


def test_what_cannot_be_written_is_a_failure(tmp_path):
    with ThreadPoolExecutor(1) as pool:
        (outcome,) = sweep(at.unpicklable, [1], executor=pool, folder=tmp_path)
    assert not outcome.ok
    assert not list(tmp_path.glob("*.pickle"))


def test_damaged_file_is_named(tmp_path):
    with ThreadPoolExecutor(1) as pool:
        sweep(at.square, [1], executor=pool, folder=tmp_path)
        (file,) = tmp_path.glob("*.pickle")
        file.write_bytes(b"cut off")
        with pytest.raises(ResultError, match=f"{file.name} of the point 1 .*delete it"):
            sweep(at.square, [1], executor=pool, folder=tmp_path, resume=True)


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
