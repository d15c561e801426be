import os
import shutil
import signal
import time

import pytest

from ngwear.errors import ResultError
from ngwear.parallel.workers import ONE_THREAD, Worker


def ended(worker, *, within=20.0):
    end = time.monotonic() + within
    while worker.alive and time.monotonic() < end:
        time.sleep(0.02)
    return not worker.alive


@pytest.fixture
def worker():
    begun = Worker("shutil")
    yield begun
    begun.end()
    assert not begun.alive


def refuse(path):
    raise ResultError(str(path))


def test_a_worker_does_what_it_is_told_one_after_the_other(worker, tmp_path):
    (tmp_path / "a").write_text("worn")
    worker.do(shutil.copy, tmp_path / "a", tmp_path / "b")
    worker.do(shutil.copy, tmp_path / "b", tmp_path / "c")
    assert worker.did()
    assert (tmp_path / "c").read_text() == "worn"
    assert worker.idle


def test_a_worker_is_not_idle_before_it_has_done_all(worker, tmp_path):
    worker.do(time.sleep, 0.2)
    assert not worker.idle
    assert worker.did()
    assert worker.idle


def test_what_ngwear_refuses_has_failed_and_the_worker_goes_on(worker, tmp_path):
    worker.do(refuse, tmp_path)
    assert not worker.did()
    worker.do(time.sleep, 0.0)
    assert worker.did()


def test_a_worker_has_one_thread_and_leaves_this_process_its_own(tmp_path, monkeypatch):
    for name in ONE_THREAD:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv(ONE_THREAD[0], "3")
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    worker = Worker("shutil")
    worker.do(os.system, f"env > {tmp_path / 'env'}")
    assert worker.did()
    worker.end()
    lines = (tmp_path / "env").read_text().splitlines()
    assert {f"{name}=1" for name in ONE_THREAD} <= set(lines)
    assert {name: os.environ.get(name) for name in ONE_THREAD} == before


def test_a_worker_that_nobody_can_tell_anything_any_more_ends(worker):
    worker._pipe.close()
    assert ended(worker)


def test_telling_a_worker_that_has_died_is_no_error(worker):
    os.kill(worker._process.pid, signal.SIGKILL)
    assert ended(worker)
    worker.do(print)
    assert not worker.did()
    assert not worker.idle


def test_a_worker_that_dies_at_its_work_has_failed(worker):
    worker.do(os.abort)
    assert not worker.did()
    assert not worker.idle


def test_a_call_with_much_data_does_not_wait_for_earlier_calls(worker):
    worker.do(time.sleep, 0.0)
    assert worker.did()  # it has started
    worker.do(time.sleep, 3.0)
    begun = time.monotonic()
    worker.do(len, bytes(20_000_000))
    assert time.monotonic() - begun < 1.5
    assert worker.did()
