"""Worker processes with one thread each. Imports little, so that a worker can start before libraries are loaded."""

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
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any

from ngwear.errors import NgwearError

if TYPE_CHECKING:
    from concurrent.futures import Executor

ONE_THREAD = ("NGS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")


class Worker:
    """A spawned process that imports modules and then calls functions, one after the other.

    If it is started first, both processes load their libraries at the same time. A function that raises NgwearError has
    failed; any other error ends the process.
    """

    def __init__(self, *modules: str) -> None:
        self._pipe, its = Pipe()
        self._owing, self._failed = 0, False
        with one_thread(), _without_script():
            self._process = get_context("spawn").Process(target=_work, args=(its, modules), daemon=True)
            self._process.start()
        its.close()

    def do(self, function: Callable[..., object], *arguments: Any) -> None:
        """Let it call a function of a module, or a method of an object there, after all earlier calls."""
        self._owing += 1
        with suppress(OSError):  # it has ended; ``alive`` and ``did`` show that
            self._pipe.send((function, arguments))

    @property
    def idle(self) -> bool:
        """Whether it is running and has completed all calls."""
        self._hear(0)
        return self.alive and not self._owing

    def did(self) -> bool:
        """Wait for all calls; return whether the last one succeeded."""
        while self._owing and self._hear(None):
            pass
        return not (self._owing or self._failed)

    def _hear(self, timeout: float | None) -> bool:
        """Receive its replies; False if it has ended."""
        with suppress(EOFError, OSError):
            while self._owing and self._pipe.poll(timeout):
                self._failed = self._pipe.recv()
                self._owing -= 1
            return True
        return False

    @property
    def alive(self) -> bool:
        """Whether the process is running."""
        return self._process.is_alive()

    def end(self) -> None:
        """Terminate the process."""
        self._pipe.close()
        if self.alive:
            self._process.terminate()
        self._process.join()


def _work(pipe: Connection, modules: tuple[str, ...]) -> None:
    end_with_parent()
    for module in modules:
        import_module(module)
    calls: SimpleQueue[tuple[Callable[..., object], tuple[Any, ...]] | None] = SimpleQueue()

    def receive() -> None:  # at once, since a call with much data would stop its sender until this process reads it
        try:
            with suppress(EOFError, OSError):  # the pipe is closed, perhaps with a reply that nobody has read
                while True:
                    calls.put(pipe.recv())
        finally:
            calls.put(None)

    threading.Thread(target=receive, daemon=True).start()
    while (call := calls.get()) is not None:
        function, arguments = call
        try:
            function(*arguments)
            failed = False
        except NgwearError:
            failed = True
        with suppress(OSError):  # nobody waits any more
            pipe.send(failed)


@contextmanager
def _without_script() -> Iterator[None]:
    """Context in which a started process does not run the main script again; it calls functions of modules only."""
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
    """Whether a value can be sent to another process: none of its classes is defined in the main script."""
    try:
        return b"__main__" not in pickle.dumps(value)
    except (pickle.PicklingError, AttributeError, TypeError):
        return False


@contextmanager
def one_thread_pool(workers: int) -> Iterator[Executor]:
    """Pool of spawned processes with one thread each."""
    from concurrent.futures import ProcessPoolExecutor

    with (
        one_thread(),
        ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=end_with_parent) as pool,
    ):
        yield pool


@contextmanager
def one_thread() -> Iterator[None]:
    """Context in which started processes use one thread; libraries read this from the environment when loaded."""
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
    """End a worker when its parent process ends; otherwise it would wait forever.

    Also give tqdm a thread lock: its default is a semaphore, which remains after a worker is ended.
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
