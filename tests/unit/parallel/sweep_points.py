"""Functions that a spawned process can import."""

import enum
import os
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np


class Ending(enum.Enum):
    """How it ended."""

    WELL = "well"


@dataclass(frozen=True)
class Found:
    """A result of many kinds of data."""

    values: np.ndarray
    notes: dict
    ending: Ending


def described(x):
    """A dataclass of what files hold."""
    return Found(np.array([x, 1 / 3, np.nan]), {"n": [1, (2.0, None)], "force [N/mm]": x}, Ending.WELL)


def square(x):
    return x * x


def counted(x, *, log, wait=0.0):
    """Square, leaving a mark for each call."""
    time.sleep(wait)
    with Path(log).open("a", encoding="utf-8") as file:
        file.write(f"{x}\n")
    return x * x


def picky(x):
    """Square of what is not 3; 4 kills its process."""
    if x == 3:
        from ngwear.errors import SceneError

        raise SceneError("x", x, "three is refused")
    if x == 4:
        os._exit(7)
    return x * x


def threads(_):
    """What libraries are told about threads, and who runs this."""
    return os.environ["OMP_NUM_THREADS"], os.getpid()


def unpicklable(x):
    return lambda: x
