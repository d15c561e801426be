"""Processes beside this one, of one thread each. Light to load: a worker may begin before the libraries do."""

from __future__ import annotations

import os
import pickle
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from multiprocessing import Pipe, get_context, parent_process
from multiprocessing.connection import Connection
from typing import TYPE_CHECKING, Any

from ngwear.errors import NgwearError

if TYPE_CHECKING:
    from concurrent.futures import Executor

ONE_THREAD = ("NGS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")


class Worker:
    """A spawned process that loads modules and then does what it is told, one thing after the other.

    Begun before this process loads its own libraries, both load at the same time. A function that raises an error of
    ngwear's own has failed; with any other error the process ends.
    """

    def __init__(self, *modules: str) -> None:
        self._pipe, its = Pipe()
        self._owing, self._failed = 0, False
        with one_thread(), _without_script():
            self._process = get_context("spawn").Process(target=_work, args=(its, modules), daemon=True)
            self._process.start()
        its.close()

    def do(self, function: Callable[..., object], *arguments: Any) -> None:
        """Let it call a function of a module, or of its objects, once it has done what it was told before."""
        self._owing += 1
        with suppress(OSError):  # it has ended: whoever waits for its work sees that
            self._pipe.send((function, arguments))

    @property
    def idle(self) -> bool:
        """Whether it is there and has done all that it was told."""
        self._hear(0)
        return self.alive and not self._owing

    def did(self) -> bool:
        """Wait until it has done all that it was told; whether the last of it has not failed."""
        while self._owing and self._hear(None):
            pass
        return not (self._owing or self._failed)

    def _hear(self, timeout: float | None) -> bool:
        """Take in what it says; False if it has ended."""
        with suppress(EOFError, OSError):
            while self._owing and self._pipe.poll(timeout):
                self._failed = self._pipe.recv()
                self._owing -= 1
            return True
        return False

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


def _work(pipe: Connection, modules: tuple[str, ...]) -> None:
    end_with_parent()
    for module in modules:
        import_module(module)
    with suppress(EOFError):  # there is nothing more to do
        while True:
            function, arguments = pipe.recv()
            try:
                function(*arguments)
                failed = False
            except NgwearError:
                failed = True
            pipe.send(failed)


@contextmanager
def _without_script() -> Iterator[None]:
    """Let a process that begins within not run this one's script again: it is told functions of modules only."""
    script = sys.modules["__main__"]
    before = {name: getattr(script, name) for name in ("__file__", "__spec__") if hasattr(script, name)}
    script.__spec__ = None
    if "__file__" in before:
        del script.__file__
    try:
        yield
    finally:
        for name, value in before.items():
            setattr(script, name, value)


def of_modules(value: object) -> bool:
    """Whether another process can be sent a value: none of its classes stands in this process's script."""
    try:
        return b"__main__" not in pickle.dumps(value)
    except (pickle.PicklingError, AttributeError, TypeError):
        return False


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
    if parent is None:
        return

    def watch() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
