"""The Blender add-on: its modules that need no Blender, and runs in Blender itself."""

from __future__ import annotations

import importlib
import importlib.util
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from .qgis_plugin import pack_plug_in

__all__ = ["ADDON", "drive_blender", "load_part"]

ADDON = Path(__file__).parents[2] / "blender"
_NAME = "tinsmith_in_blender"
_DRIVER = Path(__file__).with_name("blender_driver.py")


def load_part(name):
    """Return a module of the add-on."""
    if _NAME not in sys.modules:
        path = ADDON / "tinsmith/__init__.py"
        spec = importlib.util.spec_from_file_location(
            _NAME, path, submodule_search_locations=[str(path.parent)]
        )
        sys.modules[_NAME] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[_NAME])
    return importlib.import_module(f"{_NAME}.{name}")


def drive_blender(folder, jobs):
    """Install the zip in Blender, run jobs, return the answers; skip where Blender is missing."""
    program = shutil.which("blender")
    if program is None:
        pytest.skip("needs Blender")
    packed = pack_plug_in("blender", folder / "addon.zip")
    (folder / "jobs.json").write_text(json.dumps(jobs))
    (folder / "home").mkdir()
    answers = folder / "answers.json"
    files = [str(packed), str(folder / "jobs.json"), str(answers)]
    options = ["--background", "--factory-startup", "--python-exit-code", "3"]
    done = subprocess.run(
        [program, *options, "--python", str(_DRIVER), "--", *files],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
        env={**os.environ, "HOME": str(folder / "home")},
    )
    assert done.returncode == 0, (done.stdout + done.stderr)[-3000:]
    return json.loads(answers.read_text())
