"""One measured run in a process of its own, on one thread, that prints what it found as JSON."""

import json
import os
import resource
import subprocess
import sys

from ngwear.parallel.workers import ONE_THREAD

SUBJECT = "--subject"


def measure(script, *arguments):
    """What a benchmark says when it is called as ``python script --subject ARGUMENTS``; None if it fails."""
    command = [sys.executable, script, SUBJECT, *map(str, arguments)]
    environment = os.environ | dict.fromkeys(ONE_THREAD, "1")
    done = subprocess.run(command, env=environment, check=False, capture_output=True, text=True)
    return json.loads(done.stdout.splitlines()[-1]) if done.returncode == 0 else None


def say(**found):
    """Print numbers, and what the process has taken until now."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    sys.stdout.write(json.dumps(found | {"cpu": usage.ru_utime + usage.ru_stime}) + "\n")
