"""Functions that a spawned process can import."""

import os
import time
from pathlib import Path


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
