"""Processes beside this one, of one thread each. Light to load: a worker may begin before the libraries do."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from multiprocessing import Pipe, get_context, parent_process
from multiprocessing.connection import Connection
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from concurrent.futures import Executor

ONE_THREAD = ("NGS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")


class Worker:
    """A spawned process that loads a module and then waits for what it shall do, once.

    Begun before this process loads its own libraries, both load at the same time.
    """

    def __init__(self, module: str) -> None:
        self._pipe, its = Pipe()
        with one_thread():
            self._process = get_context("spawn").Process(target=_work, args=(its, module), daemon=True)
            self._process.start()
        its.close()

    def do(self, function: Callable[..., None], *arguments: Any) -> None:
        """Let it call a module's function, and end."""
        with suppress(BrokenPipeError):  # it has ended: whoever waits for its work sees that
            self._pipe.send((function, arguments))

    @property
    def alive(self) -> bool:
        """Whether it has not ended."""
        return self._process.is_alive()

    def end(self) -> None:
        """Stop it, wherever it is."""
        self._pipe.close()
        if self.alive:
            self._process.terminate()
        self._process.join()


def _work(pipe: Connection, module: str) -> None:
    end_with_parent()
    import_module(module)
    with suppress(EOFError):  # there is nothing to do
        function, arguments = pipe.recv()
        function(*arguments)


@contextmanager
def one_thread_pool(workers: int) -> Iterator[Executor]:
    """Spawned workers of one thread each."""
    from concurrent.futures import ProcessPoolExecutor

    with (
        one_thread(),
        ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=end_with_parent) as pool,
    ):
        yield pool


@contextmanager
def one_thread() -> Iterator[None]:
    """Let processes that begin within have one thread each: libraries read that from the environment as they load."""
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    os.environ.update(dict.fromkeys(ONE_THREAD, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def end_with_parent() -> None:
    """Let a worker end when the process that feeds it is killed; else it would wait for work for ever.

    Its progress bars, shown or not, lock by thread: tqdm's own lock is a semaphore, which an ended worker leaves.
    """
    from tqdm import tqdm

    tqdm.set_lock(threading.RLock())
    parent = parent_process()

    def watch() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
