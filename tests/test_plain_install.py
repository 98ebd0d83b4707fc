"""A plain installation does what README shows."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from support.blocks import ROOT
from support.plain_install import hide_others, list_hidden, list_plain

_TRY = """
import numpy
try:
    import meshio
except ImportError:
    print("hidden")
"""
README = (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.fixture
def plain(tmp_path):
    """Return what runs a program that sees the libraries of a plain installation alone."""
    site = tmp_path / "site"
    site.mkdir()
    hide_others(site)
    (tmp_path / "sample_data").symlink_to(ROOT / "sample_data")
    scripts = Path(sys.executable).parent
    environment = {**os.environ, "PYTHONPATH": str(site)}
    environment["PATH"] = f"{scripts}{os.pathsep}{environment['PATH']}"

    def run(*words):
        done = subprocess.run(
            words, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, f"{words}: {done.stderr}"
        return done.stdout

    return run


def test_what_is_hidden_is_what_extras_and_tests_bring(plain):
    assert {"numpy", "pyogrio", "ezdxf", "pandas", "laspy", "lazrs"} <= list_plain()
    hidden = set(list_hidden())
    assert {"pytest", "geopandas", "meshio", "xarray"} <= hidden
    assert not hidden & {"numpy", "tinsmith", "pyvista", "matplotlib", "click", "rich"}
    said = plain(sys.executable, "-c", _TRY)
    assert said.strip() == "hidden"


@pytest.mark.slow
def test_a_plain_installation_does_what_readme_shows(plain, can_draw):
    shells = [one for one in re.findall(r"```sh\n(.*?)```", README, re.DOTALL) if "make" not in one]
    assert len(shells) >= 2
    for line in "".join(shells).splitlines():
        plain(*line.split())
    blocks = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    assert len(blocks) >= 3
    assert "cut" in plain(sys.executable, "-c", "\n".join(blocks))
