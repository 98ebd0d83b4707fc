"""The QGIS plugin, driven in a process of the system's own Python; plug-ins as zips."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from . import processes
from .qgis_meshes import has_qgis

__all__ = ["PLUGIN", "ROOT", "drive", "make_environment", "pack_plug_in", "require_qgis"]

ROOT = Path(__file__).parents[2]
PLUGIN = ROOT / "qgis"
_DRIVER = Path(__file__).with_name("qgis_driver.py")
_NOISE = ("Warning ", "ERROR ", "HDF5-DIAG")
"""How lines begin that libraries print to the terminal from which QGIS was started."""

_PATIENCE = 800
"""Seconds: the machine may be busy."""


def pack_plug_in(name, target):
    """Pack a plug-in as users do, and return the path of the zip."""
    done = processes.run(sys.executable, "packaging/pack_plug_in.py", name, str(target), cwd=ROOT)
    assert done.stdout.strip() == str(target), done.stderr
    return target


def require_qgis():
    """Skip the test where QGIS is missing."""
    if not has_qgis():
        pytest.skip("needs QGIS (python3-qgis)")


def make_environment(folder):
    """Return the environment of QGIS without a screen, with the command under test on PATH."""
    runtime = folder / "runtime"
    runtime.mkdir(mode=0o700, exist_ok=True)
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "XDG_RUNTIME_DIR": str(runtime)}
    environment |= {"HOME": str(runtime), "PYTHONDONTWRITEBYTECODE": "1"}
    environment["PATH"] = f"{link_command(folder)}{os.pathsep}{os.defpath}"
    environment.pop("PYTHONPATH", None)
    return environment


def link_command(folder):
    """Return a folder with the command alone: QGIS takes its Python from PATH, too."""
    programs = folder / "programs"
    programs.mkdir(exist_ok=True)
    link = programs / "tinsmith"
    if not link.exists():
        link.symlink_to(Path(sys.executable).with_name("tinsmith"))
    return programs


def drive(folder, layers, jobs, **environment):
    """Run jobs in one QGIS; return the answer to each, and what is told of the provider."""
    require_qgis()
    (folder / "jobs.json").write_text(json.dumps({"layers": layers, "jobs": jobs}))
    answers = folder / "answers.json"
    done = subprocess.run(
        ["/usr/bin/python3", str(_DRIVER), str(PLUGIN), str(folder / "jobs.json"), str(answers)],
        capture_output=True,
        text=True,
        timeout=_PATIENCE,
        check=False,
        cwd=folder,
        env=make_environment(folder) | environment,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    noise = [line for line in done.stderr.splitlines() if line.startswith(_NOISE)]
    assert noise == [], noise[:5]
    return json.loads(answers.read_text())
