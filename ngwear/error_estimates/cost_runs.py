"""One run of a cost study in its own process: its results, time and memory."""

from __future__ import annotations

import _thread
import faulthandler
import functools
import math
import os
import signal
import threading
import time
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future
from dataclasses import dataclass, replace
from types import FrameType
from typing import Any

from ngwear.error_estimates.ladder import STOPPED, Measurement
from ngwear.errors import NgwearError
from ngwear.files.peak_memory import peak_memory
from ngwear.files.result_folder import COMPLETED, GAVE_UP
from ngwear.results.recorder import LEAK
from ngwear.scene.pin_scene import PinScene
from ngwear.scene.scene import Scene

DEPTH, PEAK = "maximum depth [mm]", "peak pressure [MPa]"
NO_TIME = "no time was left"
GRACE = 60.0  # s, for one call of a compiled library: more than a factorisation takes


class OutOfTimeError(Exception):
    """A run has used all of its time."""


@dataclass
class _Clock:
    """System time at which the run of this process was submitted, and whether its time is over."""

    sent: float = math.nan
    over: bool = False

    def check(self) -> None:
        if self.over:
            raise OutOfTimeError

    def ring(self) -> None:
        """Interrupt the main thread as the keyboard does; this works on every platform."""
        self.over = True
        _thread.interrupt_main()

    def stop(self, _: int, __: FrameType | None) -> None:
        """Signal handler of an interruption."""
        if math.isnan(self.sent):
            return  # the run has ended in the meantime
        self.check()
        raise KeyboardInterrupt  # it was the keyboard


_clock = _Clock()


class Limited(Executor):
    """Wrapper of an executor that stops calls after a wall time [s], including the start of the process.

    A call that does not stop within ``grace`` more seconds, in a compiled library, is ended with its process.
    """

    def __init__(self, executor: Executor, seconds: float, *, grace: float = GRACE) -> None:
        self._executor, self._seconds, self._grace = executor, seconds, grace

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        call, sent = functools.partial(function, *args, **kwargs), time.time()
        outcome: Future[Any] = Future()

        def on_done(done: Future[Any]) -> None:
            error, wall = done.exception(), time.time() - sent
            if isinstance(error, BrokenExecutor) and wall > self._seconds:
                outcome.set_result(Measurement(status=STOPPED, message=NO_TIME, wall=wall))
            elif error is not None:
                outcome.set_exception(error)
            else:
                outcome.set_result(done.result())

        self._executor.submit(_timed, sent, self._seconds, self._grace, call).add_done_callback(on_done)
        return outcome


def _timed(sent: float, seconds: float, grace: float, call: Callable[[], Any]) -> Any:
    _clock.sent, _clock.over = sent, False
    left = max(seconds - (time.time() - sent), 1e-3)
    alarm = threading.Timer(left, _clock.ring)
    alarm.daemon = True
    before = signal.signal(signal.SIGINT, _clock.stop)
    with open(os.devnull, "w", encoding="ascii") as nowhere:
        faulthandler.dump_traceback_later(left + grace, exit=True, file=nowhere)  # ends the process in any case
        try:
            try:
                alarm.start()
                return call()
            finally:
                alarm.cancel()
                alarm.join()
        except OutOfTimeError:  # outside of ``measure``, if there is no time at all
            cpu, wall = time.process_time(), time.time() - sent
            return Measurement(status=STOPPED, message=NO_TIME, cpu=cpu, wall=wall, memory=peak_memory())
        finally:
            _clock.sent = math.nan
            faulthandler.cancel_dump_traceback_later()
            signal.signal(signal.SIGINT, before)  # a pending interruption is handled before
            _clock.over = False


@dataclass(frozen=True)
class Point:
    """A scene to be run; ``attempt`` counts repetitions after it was stopped."""

    scene: Scene | PinScene
    attempt: int = 0


@dataclass
class _Progress:
    """Completed fraction of the run."""

    begun: float = 0.0
    done: float = 0.0
    last: float = 0.0

    def needed(self, total: float) -> float:
        """Estimated time of the whole run [s]; nan if it is not known."""
        return self.begun + (total - self.begun) / self.done if self.done > 0 else math.nan


def measure(point: Point) -> Measurement:
    """Run a scene and return its main results; also for a run that gives up or is stopped.

    A compiled library may turn the interruption into another error, or ignore it: so the clock decides whether a run
    was stopped, not the error with which it ended.
    """
    progress = _Progress()
    sent = time.time() if math.isnan(_clock.sent) else _clock.sent
    scene = point.scene
    try:
        found = _slide(scene, progress, sent) if isinstance(scene, PinScene) else _wear(scene, progress, sent)
    except NgwearError as error:
        found = Measurement(status=GAVE_UP, message=str(error))
    except Exception as error:  # errors of mesher or solver are recorded too; else each call would try again
        found = Measurement(status=GAVE_UP, message=f"{type(error).__name__}: {error}")
    if _clock.over and found.status == GAVE_UP:
        found = Measurement(status=STOPPED, message=NO_TIME, needed=progress.needed(time.time() - sent))
    memory = peak_memory()
    return replace(found, cpu=time.process_time(), wall=time.time() - sent, memory=memory)


def _wear(scene: Scene, progress: _Progress, sent: float) -> Measurement:
    from ngwear.loop.run import run

    def on_step(state: Any) -> None:
        _clock.check()
        if progress.begun == 0.0:
            progress.begun = time.time() - sent
        progress.done = state.strokes / max(scene.program.strokes, 1)

    result = run(scene, throw=False, figures=False, on_step=on_step)
    values = wear_values(scene, result.summary, result.records.rows) if result.error is None else {}
    solves = result.summary.get("solves", 0)
    return Measurement(status=result.status, message=result.message, values=values, solves=solves)


def wear_values(scene: Scene, summary: dict[str, Any], rows: list[dict[str, Any]]) -> dict[str, float]:
    """Main results of a run: maximum depth, worn amount, and the largest values of the last cycle.

    Parameters
    ----------
    scene : Scene
    summary : dict
        Contents of ``summary.json``.
    rows : list of dict
        Rows of ``series.csv``.
    """
    last = rows[-len(scene.program.cycle) :]
    amount = "worn volume [mm^3]" if scene.axisymmetric else "worn area [mm^2]"
    found = {name: float(summary[name]) for name in (DEPTH, amount) if scene.worn_edges}
    found |= {name: float(summary[name]) for name in (PEAK, LEAK) if name in summary}
    for spec in scene.contacts:
        width, force = f"{spec.name} contact width [mm]", f"{spec.name} friction force x ["
        if not (spec.wears or (spec.slides and spec.friction_law is not None)):
            continue
        if width in last[-1]:
            found[width] = max(row[width] for row in last)
        unit = next((name.removeprefix(force) for name in last[-1] if name.startswith(force)), None)
        if unit is not None:
            x, y = (f"{spec.name} friction force {axis} [{unit}" for axis in "xy")
            found[f"{spec.name} friction force [{unit}"] = max(math.hypot(row[x], row[y]) for row in last)
    return found


def _slide(scene: PinScene, progress: _Progress, sent: float) -> Measurement:
    from ngwear.sliding.pin import slide_pin
    from ngwear.sliding.run_pin import row

    progress.begun, rows = time.time() - sent, []
    for number, speed in enumerate(scene.speeds):
        _clock.check()
        rows.append(row(*slide_pin(scene.pin, speed, mesh=scene.mesh)))
        progress.done = (number + 1) / len(scene.speeds)
    values = {
        DEPTH: max(r["penetration [mm]"] for r in rows),
        PEAK: max(r["peak pressure [MPa]"] for r in rows),
        "contact area [mm²]": max(r["contact area [mm²]"] for r in rows),
        "friction force [N]": max(r["friction coefficient [-]"] for r in rows) * scene.pin.load,
    }
    return Measurement(status=COMPLETED, values=values, solves=int(sum(r["solves [-]"] for r in rows)))
