"""Nothing that only one platform has: every module can be imported where POSIX's own are missing."""

import subprocess
import sys
from pathlib import Path

import pytest

import ngwear

CODE = """
import importlib, pkgutil, signal, sys

class Missing:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in {blocked!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)

for name in {blocked!r}:
    sys.modules.pop(name, None)
sys.meta_path.insert(0, Missing())
for name in {signals!r}:
    if hasattr(signal, name):
        delattr(signal, name)

import ngwear
names = [found.name for found in pkgutil.walk_packages(ngwear.__path__, "ngwear.")]
assert len(names) > 200, names
for name in names:
    if not name.endswith("__main__"):
        importlib.import_module(name)
for name in {blocked!r}:
    assert name not in sys.modules, name
"""
BLOCKED = ("resource", "fcntl", "pwd", "grp", "termios", "tty", "pty", "syslog", "readline", "curses", "posix_ipc")
SIGNALS = ("SIGALRM", "SIGKILL", "SIGUSR1", "SIGUSR2", "SIGHUP", "setitimer", "alarm", "ITIMER_REAL", "pause")


def test_every_module_is_imported_without_what_only_posix_has(tmp_path):
    code = CODE.format(blocked=BLOCKED, signals=SIGNALS)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    "word", ["import resource", "import fcntl", "SIGALRM", "setitimer", "os.fork", "os.killpg", "os.getuid"]
)
def test_what_only_posix_has_is_not_even_written(word):
    allowed = {"import resource": {"peak_memory.py"}}  # beyond Windows and Linux
    found = {
        path.name for path in Path(ngwear.__file__).parent.rglob("*.py") if word in path.read_text(encoding="utf-8")
    }
    assert found <= allowed.get(word, set())
