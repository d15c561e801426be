"""Peak memory of this process."""

from __future__ import annotations

import sys
from pathlib import Path


def peak_memory() -> float:
    """Peak resident memory of this process [MB]; on Linux without that of its parent process."""
    if sys.platform == "win32":
        import psutil

        return psutil.Process().memory_info().peak_wset / 1024**2
    status = Path("/proc/self/status")
    if status.exists():
        lines = status.read_text(encoding="utf-8", errors="replace").splitlines()
        own = [line.split()[1] for line in lines if line.startswith("VmHWM:")]
        if own:
            return int(own[0]) / 1024
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1024**2 if sys.platform == "darwin" else 1024)
