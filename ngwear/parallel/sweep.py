"""Evaluate a function at many points in parallel; resumable, and a failure does not stop the others."""

from __future__ import annotations

import functools
import hashlib
import io
import os
import pickle
import sys
import traceback
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ngwear.errors import ResultError, SceneError
from ngwear.files.archive import Format, packed, read, write
from ngwear.files.plain_data import by_name
from ngwear.files.result_folder import OutFolder
from ngwear.files.version import VERSION
from ngwear.parallel.workers import one_thread_pool

FORMAT = Format("result of a sweep", 2, "delete it to compute it anew")  # 1: a pickle
ENDING, OLD = ".npz", ".pickle"
IMPORTABLE = "define it at the top of a module; functools.partial(function, fixed) keeps arguments that do not vary"


@dataclass(frozen=True)
class Failure:
    """Error at a point: its class, message and traceback, as text."""

    kind: str
    message: str
    traceback: str

    @classmethod
    def of(cls, error: BaseException) -> Failure:
        """Build from an exception."""
        return cls(type(error).__name__, str(error), "".join(traceback.format_exception(error)))


@dataclass(frozen=True)
class Outcome:
    """One point of a sweep.

    Attributes
    ----------
    point : object
    result : object
        Return value of the function; None if it failed.
    failure : Failure or None
    restored : bool
        Whether the result was read from the folder.
    """

    point: Any
    result: Any = None
    failure: Failure | None = None
    restored: bool = False

    @property
    def ok(self) -> bool:
        """Whether there is a result."""
        return self.failure is None


def sweep(
    function: Callable[[Any], Any],
    points: Iterable[Any],
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    folder: Path | str | None = None,
    resume: bool = False,
    progress: bool = False,
    classes: Iterable[type] = (),
) -> list[Outcome]:
    """Evaluate ``function(point)`` at each point; outcomes in the order of the points.

    A point that raises an error, or ends its worker process, gives an outcome with a failure; the others continue.
    As always with spawned processes, a script must call this under ``if __name__ == "__main__"``.

    Parameters
    ----------
    function : callable
        Function of one point. For processes it must be importable, and its return value must pickle. For a folder it
        must return numbers, text, lists, tuples, dicts, NumPy arrays, or dataclasses of these that are among
        ``classes``.
    points : iterable
    executor : concurrent.futures.Executor or None
        Any executor, such as ``client.get_executor()`` of Dask; it is not closed. Default: spawned processes with one
        thread each.
    workers : int or None
        Number of processes; default: number of cores.
    folder : path or None
        Folder to which each result is written at once; the file name is a digest of function and point.
    resume : bool
        Use results of an earlier sweep with the same function in the folder (compared by name and fixed arguments, not
        by its code); failed points are tried again.
    progress : bool
        Show a progress bar.
    classes : iterable of type
        Dataclasses and enumerations in the results; files of the folder can create objects of no other class.

    Raises
    ------
    SceneError
        If there are no points, or the function or a point cannot be pickled.
    ResultError
        If the folder cannot be used, or a file in it cannot be read.
    """
    points, classes = list(points), tuple(classes)
    _check(points, executor, workers, folder, resume)
    _check_classes(classes)
    own = executor is None
    if own:
        _check_importable(function)
    keys = [_digest(function, point) for point in points] if own or folder is not None else []
    store = None if folder is None else _Store(Path(folder), classes, resume=resume)
    outcomes: list[Outcome | None] = [None] * len(points)
    if store is not None and resume:
        outcomes = [store.load(key, point) for key, point in zip(keys, points, strict=True)]
    waiting = [i for i, outcome in enumerate(outcomes) if outcome is None]
    with _bar(len(points), len(points) - len(waiting), progress) as step:

        def keep(i: int, result: Any) -> None:
            if store is not None and not isinstance(result, Failure):
                result = store.save(keys[i], result)
            failed = isinstance(result, Failure)
            outcomes[i] = Outcome(points[i], failure=result) if failed else Outcome(points[i], result)
            step()

        if executor is None:
            _in_processes(function, points, waiting, workers or os.cpu_count() or 1, keep)
        else:
            for i, error in _feed(executor, function, points, deque(waiting), len(points), keep):
                keep(i, Failure.of(error))
    return [outcome for outcome in outcomes if outcome is not None]


def _attempt(function: Callable[[Any], Any], point: Any) -> Any:
    """Called in the worker; errors are returned as text, because not every exception can be pickled."""
    try:
        return function(point)
    except Exception as error:
        return Failure.of(error)


Keep = Callable[[int, Any], None]


def _feed(
    executor: Executor, function: Any, points: list[Any], waiting: deque[int], most: int, keep: Keep
) -> list[tuple[int, BaseException]]:
    """Evaluate the points in ``waiting``, at most ``most`` at a time; return those lost by a broken executor.

    Only running points are lost; the others stay in ``waiting``.
    """
    running: dict[Future[Any], int] = {}
    lost: list[tuple[int, BaseException]] = []
    while running or (waiting and not lost):
        while waiting and not lost and len(running) < most:
            i = waiting.popleft()
            try:
                running[executor.submit(_attempt, function, points[i])] = i
            except BrokenExecutor as broken:
                lost.append((i, broken))
        done, _ = wait(running, return_when=FIRST_COMPLETED)
        for future in done:
            i, error = running.pop(future), future.exception()
            if isinstance(error, BrokenExecutor):
                lost.append((i, error))
            else:
                keep(i, future.result() if error is None else Failure.of(error))
    return lost


def _in_processes(function: Any, points: list[Any], waiting: Iterable[int], workers: int, keep: Keep) -> None:
    queue = deque(waiting)
    while queue:
        with one_thread_pool(min(workers, len(queue))) as pool:
            lost = _feed(pool, function, points, queue, workers, keep)
        for i, _ in lost:  # one of them ended its worker; each alone shows which one
            with one_thread_pool(1) as pool:
                again = _feed(pool, function, points, deque([i]), 1, keep)
            for _, error in again:
                keep(i, Failure.of(error))


class _Store:
    """Results in a folder, one file for each point, replaced as a whole."""

    def __init__(self, path: Path, classes: tuple[type, ...], *, resume: bool) -> None:
        self.folder, self.classes = OutFolder(path, "", resume=True), classes
        if resume and (old := next(path.glob(f"*{OLD}"), None)) is not None:
            raise ResultError(
                f"{old} holds a result of ngwear 0.1; this is ngwear {VERSION}, which cannot read it: delete such "
                "files to compute them anew, give another folder, or take ngwear 0.1"
            )

    def load(self, key: str, point: Any) -> Outcome | None:
        file = self.folder.path / f"{key}{ENDING}"
        if not file.exists():
            return None
        try:
            return Outcome(point, read(file, FORMAT, self.classes), restored=True)
        except ResultError as error:
            raise ResultError(f"the result of the point {point!r} is lost: {error}") from error

    def save(self, key: str, result: Any) -> Any:
        """Return the result, or a Failure if it cannot be written."""
        try:
            members = packed(result, FORMAT, self.classes)
        except ResultError as error:
            return Failure.of(error)
        self.folder.replace(f"{key}{ENDING}", lambda file: write(file, members))
        return result


def _digest(function: Any, point: Any) -> str:
    """Digest of the pickled function and point."""
    data = io.BytesIO()
    pickler = pickle.Pickler(data, protocol=5)
    pickler.fast = True  # no memo: equal strings are written equally, even if they are different objects
    for what, value in (("function", function), ("point", point)):
        try:
            pickler.dump(value)
        except Exception as error:  # what pickling raises depends on the object
            raise SceneError(f"sweep.{what}", value, f"cannot be pickled ({error}): {IMPORTABLE}") from error
    return hashlib.sha256(data.getvalue()).hexdigest()[:32]


def _check(points: list[Any], executor: Any, workers: Any, folder: Any, resume: bool) -> None:
    if not points:
        raise SceneError("sweep.points", points, "give at least one point")
    if workers is not None and not (isinstance(workers, int) and workers >= 1):
        raise SceneError("sweep.workers", workers, "must be a whole number of at least 1")
    if workers is not None and executor is not None:
        raise SceneError("sweep.workers", workers, "an executor has its own workers: give one or the other")
    if resume and folder is None:
        raise SceneError("sweep.resume", resume, "needs the folder of the earlier sweep: give folder")


def _check_classes(classes: tuple[type, ...]) -> None:
    try:
        by_name(classes)
    except TypeError as error:
        raise SceneError("sweep.classes", classes, str(error)) from None


def _check_importable(function: Any) -> None:
    """SceneError for a function of a session or notebook, which a spawned process cannot import."""
    inner = function
    while isinstance(inner, functools.partial):
        inner = inner.func
    where = getattr(inner, "__module__", type(inner).__module__)
    if where == "__main__" and not hasattr(sys.modules["__main__"], "__file__"):
        remedy = f"a worker process cannot import a function of a session or notebook: {IMPORTABLE}"
        raise SceneError("sweep.function", function, remedy)


@contextmanager
def _bar(total: int, done: int, shown: bool) -> Iterator[Callable[[], Any]]:
    from tqdm import tqdm

    with tqdm(total=total, initial=done, disable=not shown, unit="point", leave=True) as bar:
        yield bar.update
