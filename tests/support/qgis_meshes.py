"""Files as QGIS opens them: meshes, in a process of the system's own Python."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from functools import cache

import pytest

_PYTHON = "/usr/bin/python3"
_OPEN = """
import json, sys
from qgis.core import QgsApplication, QgsMeshLayer
app = QgsApplication([], False)
app.initQgis()
answers = []
for path in sys.argv[1:]:
    layer = QgsMeshLayer(path, "mesh", "mdal")
    provider = layer.dataProvider()
    groups = [provider.datasetGroupMetadata(k) for k in range(provider.datasetGroupCount())]
    answers.append({
        "valid": layer.isValid(),
        "crs": layer.crs().authid(),
        "vertices": provider.vertexCount(),
        "faces": provider.faceCount(),
        "groups": {one.name(): [one.minimum(), one.maximum()] for one in groups},
    })
print("ANSWER" + json.dumps(answers), flush=True)
"""


@cache
def has_qgis() -> bool:
    """Whether the system's Python has QGIS."""
    if shutil.which(_PYTHON) is None:
        return False
    done = subprocess.run([_PYTHON, "-c", "import qgis.core"], capture_output=True, check=False)
    return done.returncode == 0


def open_in_qgis(path, folder):
    """Open a mesh; return counts, CRS and ranges; skip the test where QGIS is missing."""
    (seen,) = open_all_in_qgis([path], folder)
    return seen


def open_all_in_qgis(paths, folder):
    """Open meshes in one process; return of each counts, CRS and ranges."""
    return run_in_qgis(_OPEN, [str(path) for path in paths], folder)


def run_in_qgis(script, arguments, folder):
    """Run a script that prints its answer; skip the test where QGIS is missing."""
    if not has_qgis():
        pytest.skip("needs QGIS (python3-qgis)")
    runtime = folder / "runtime"
    runtime.mkdir(mode=0o700, exist_ok=True)
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "XDG_RUNTIME_DIR": str(runtime)}
    environment |= {"HOME": str(runtime)}
    environment.pop("PYTHONPATH", None)
    done = subprocess.run(
        [_PYTHON, "-c", script, *arguments],
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
        env=environment,
    )
    found = [line for line in done.stdout.splitlines() if line.startswith("ANSWER")]
    assert found, done.stderr
    return json.loads(found[0].removeprefix("ANSWER"))
