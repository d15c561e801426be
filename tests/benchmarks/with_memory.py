"""Run a script and say its peak memory in kB: ``python with_memory.py SCRIPT [ARGUMENT ...]``.

The peak that the parent is told of a child begins with the parent's own; the kernel's high-water mark does not.
"""

import resource
import runpy
import sys
from pathlib import Path

sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
status = Path("/proc/self/status")
if status.exists():
    kilobytes = next(line.split()[1] for line in status.read_text().splitlines() if line.startswith("VmHWM"))
else:
    kilobytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // (1024 if sys.platform == "darwin" else 1)
sys.stdout.write(f"memory {kilobytes}\n")
