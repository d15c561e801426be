"""README: short enough, its links lead somewhere, and its code runs."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import ngwear as nw

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", README, flags=re.DOTALL)


def test_it_has_at_most_900_words():
    assert len(README.split()) <= 900


@pytest.mark.parametrize("file", sorted(path for path in ROOT.glob("**/*.md") if ".venv" not in path.parts), ids=str)
def test_links_lead_somewhere(file):
    for link in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", file.read_text(encoding="utf-8")):
        assert link.startswith("https://") or (file.parent / link).exists(), link


def test_its_names_are_those_of_the_package():
    (code,) = blocks("python")
    compile(code, "README.md", "exec")
    assert set(re.findall(r"\bnw\.(\w+)", code)) <= set(nw.__all__)
    (scene,) = blocks("toml")
    assert tomllib.loads(scene)["scene"]["kind"] == "axisymmetric"


@pytest.mark.slow
def test_its_code_runs(tmp_path):
    (code,) = blocks("python")
    code = code.replace('"geometries/', f'"{ROOT.as_posix()}/geometries/')
    (tmp_path / "out").mkdir()
    ran = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert "maximum depth [mm]" in ran.stdout
    assert (tmp_path / "out" / "stress.png").is_file()
    assert nw.read_scene(tmp_path / "out" / "my_seal.toml").name == "my seal"
