"""Install tinsmith into an environment of the user's profile, when the user asks for it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

from qgis.core import QgsProcessingException

from .command import (
    ask_program,
    locate_environments,
    locate_script,
)
from .process import Failed, Speaker, run_program

LEAST_PYTHON = (3, 11)
_EXTRAS = "raster,vector,mesh,plot,cad,lidar"
_PATIENCE = 30
"""Seconds in which a Python must tell its version."""


def find_python(chosen: str) -> str:
    """Return a Python that can run tinsmith: the one chosen, else the first one found.

    Raises
    ------
    QgsProcessingException
        If there is none of at least version 3.11.
    """
    least = ".".join(map(str, LEAST_PYTHON))
    if chosen:
        found = _ask_version(chosen)
        if found < LEAST_PYTHON:
            said = ".".join(map(str, found)) or "does not run"
            raise QgsProcessingException(
                f"'{chosen}' is no Python of version {least} or newer: it is {said}."
            )
        return chosen
    for candidate in _list_candidates():
        if _ask_version(candidate) >= LEAST_PYTHON:
            return candidate
    raise QgsProcessingException(
        f"There is no Python {least} or newer on PATH: install one, or name it."
    )


def _list_candidates() -> list[str]:
    """Return the interpreters that may be there, QGIS's own as the last."""
    names = ["python3", *(f"python3.{minor}" for minor in range(14, 10, -1)), "python"]
    found = [path for name in names if (path := shutil.which(name))]
    own = Path(sys.base_prefix) / ("python.exe" if os.name == "nt" else "bin/python3")
    return [*found, str(own)]


def _ask_version(python: str) -> tuple[int, ...]:
    """Return the version of an interpreter; nothing if it does not run."""
    code = "import sys; print(*sys.version_info[:2])"
    try:
        done = ask_program(python, "-c", code, patience=_PATIENCE)
        return tuple(map(int, done.stdout.split())) if done.returncode == 0 else ()
    except (OSError, subprocess.TimeoutExpired, ValueError):
        return ()


def install(python: str, source: str, feedback: Any) -> Path:
    """Make a new environment and install tinsmith into it; return its command.

    The one that was there is removed once the new one is complete; if anything fails, or the user
    cancels, the new one is removed.

    Parameters
    ----------
    python : str
    source : str
        What pip installs: a wheel, a folder of the sources, or what else it takes.
    feedback : QgsProcessingFeedback
    """
    root = locate_environments()
    root.mkdir(parents=True, exist_ok=True)
    before = [path for path in root.iterdir() if path.name.isdigit()]
    folder = root / str(max((int(path.name) for path in before), default=0) + 1)
    try:
        _fill(folder, python, source, feedback)
        (folder / "complete").touch()
    except Failed as failed:
        shutil.rmtree(folder, ignore_errors=True)
        raise QgsProcessingException(f"'{source}' is not installed: {failed}") from failed
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    for path in before:
        shutil.rmtree(path, ignore_errors=True)
    return locate_script(folder, "tinsmith")


def _fill(folder: Path, python: str, source: str, feedback: Any) -> None:
    speaker = Speaker(feedback, {})
    feedback.setProgressText(f"Making an environment with {python}")
    run_program([python, "-m", "venv", str(folder)], speaker, feedback)
    feedback.setProgressText(f"Installing {source}")
    pip = [str(locate_script(folder, "python")), "-m", "pip", "--disable-pip-version-check"]
    wanted = source if "[" in Path(source).name else f"{source}[{_EXTRAS}]"
    said = run_program([*pip, "install", wanted], speaker, feedback)
    for line in said.splitlines():
        feedback.pushConsoleInfo(line)
    if not locate_script(folder, "tinsmith").exists():
        raise QgsProcessingException(f"'{source}' has no command tinsmith: it is another package.")
