"""How soon a command is done whose work is small: fresh processes, in turn."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..datasets.points import make_points
from ..measure import OURS, Outcome, Result, alternate, find_median

__all__ = ["SECTION", "run"]

SECTION = "startup"
POINTS = 100
PYTHON, NUMPY = "Python alone", "Python and numpy alone"


def run(n: int, *, repeats: int = 5) -> Outcome:
    """Measure the help and small jobs on 100 points, whatever ``n`` is; each must succeed."""
    del n
    outcome = Outcome()
    with tempfile.TemporaryDirectory() as name:
        for task, arguments in _prepare_tasks(Path(name)).items():
            command = [sys.executable, "-m", "tinsmith", *arguments]
            calls: dict[str, Callable[[], Any]] = {
                OURS: partial(_run, command),
                PYTHON: partial(_run, [sys.executable, "-c", "pass"]),
                NUMPY: partial(_run, [sys.executable, "-c", "import numpy"]),
            }
            _run(command)  # the file cache
            _, runs = alternate(calls, repeats)
            for tool, seconds in runs.items():
                outcome.results.append(
                    Result(SECTION, task, tool, POINTS, find_median(seconds), tuple(seconds))
                )
    return outcome


def _prepare_tasks(folder: Path) -> dict[str, list[str]]:
    """Return command lines by what they do; the first job makes the file of those behind it."""
    points = np.round(make_points("uniform", 200)[:POINTS], 3)
    survey, tin = str(folder / "survey.csv"), str(folder / "site.ply")
    np.savetxt(survey, points, "%.3f", ",", header="easting,northing,elevation", comments="")
    return {
        "--help": ["--help"],
        "build to PLY and GeoJSON": [
            *("build", survey, "--crs", "EPSG:32616", "-o", tin),
            *("-o", str(folder / "site.geojson")),
        ],
        "info": ["info", tin],
        "check": ["check", tin],
        "contours": ["contours", tin, "-o", str(folder / "contours.geojson")],
    }


def _run(command: list[str]) -> None:
    subprocess.run(command, check=True, capture_output=True)
