import os
import shutil
import signal
import time

import pytest

from ngwear.workers import ONE_THREAD, Worker


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


def test_a_worker_does_what_it_is_told_and_ends(worker, tmp_path):
    (tmp_path / "a").write_text("worn")
    worker.do(shutil.copy, tmp_path / "a", tmp_path / "b")
    assert ended(worker)
    assert (tmp_path / "b").read_text() == "worn"


def test_a_worker_has_one_thread_and_leaves_this_process_its_own(worker, tmp_path):
    worker.do(os.system, f"env > {tmp_path / 'env'}")
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    assert ended(worker)
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
