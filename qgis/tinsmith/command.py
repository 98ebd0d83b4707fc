"""Which command ``tinsmith`` is used: that of the settings, of PATH, or one installed here."""

from __future__ import annotations

import os
import shutil
import subprocess
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from qgis.core import QgsApplication, QgsProcessingException

SETTING = "TINSMITH_COMMAND"
"""Name of the setting in the options of Processing."""

_FOREIGN = ("PYTHON", "PROJ_", "GDAL_", "OGR_", "CPL_", "QT_", "QGIS_", "VIRTUAL_ENV")
"""Beginnings of variables that QGIS sets for its own libraries, which are not the command's."""
_PATIENCE = 120
"""Seconds in which a command must tell its version; the first start after an install is slow."""


@dataclass(frozen=True)
class Command:
    """A command ``tinsmith`` that is there, and how it was found, in words."""

    path: str
    origin: str

    def find_version(self) -> str:
        """Return its name and version, such as ``tinsmith 0.1.0``."""
        return _ask_version(self.path, Path(self.path).stat().st_mtime)


def find_command() -> Command:
    """Return the command to use.

    Raises
    ------
    QgsProcessingException
        If there is none; the sentence names the ways to have one.
    """
    chosen = _read_setting()
    if chosen:
        if shutil.which(chosen) is None:
            raise QgsProcessingException(
                f"The command '{chosen}' of Settings > Options > Processing > Providers > Tinsmith "
                "is not there or cannot be run: correct the path, or leave it empty."
            )
        return Command(chosen, "of the settings of Processing")
    on_path = shutil.which("tinsmith")
    if on_path is not None:
        return Command(on_path, "found on PATH")
    installed = find_installed()
    if installed is not None:
        return Command(str(installed), "installed for this profile")
    raise QgsProcessingException(
        "There is no command tinsmith: install it where PATH leads, set its path in Settings > "
        "Options > Processing > Providers > Tinsmith, or run the algorithm 'Install tinsmith'."
    )


def make_environment() -> dict[str, str]:
    """Return the variables for the command: ours without what QGIS sets for its own libraries."""
    return {key: value for key, value in os.environ.items() if not key.startswith(_FOREIGN)}


def list_process_options() -> dict[str, Any]:
    """Return how a process is started: apart from that of QGIS, and without a window."""
    if os.name == "nt":
        flag: int = getattr(subprocess, "CREATE_NO_WINDOW", 0)
        return {"creationflags": flag}
    return {"start_new_session": True}


# ---------------------------------------------------------------- environments of the profile


def locate_environments() -> Path:
    """Return the folder of the user's profile where environments are installed."""
    return Path(QgsApplication.qgisSettingsDirPath()) / "tinsmith"


def locate_script(environment: Path, name: str) -> Path:
    """Return the path of a program in an environment of Python."""
    if os.name == "nt":
        return environment / "Scripts" / f"{name}.exe"
    return environment / "bin" / name


def find_installed() -> Path | None:
    """Return the newest command that was installed completely."""
    numbered = [path for path in locate_environments().glob("*/complete") if _number(path) > 0]
    for marker in sorted(numbered, key=_number, reverse=True):
        path = locate_script(marker.parent, "tinsmith")
        if path.exists():
            return path
    return None


def _number(marker: Path) -> int:
    name = marker.parent.name
    return int(name) if name.isdigit() else 0


# ---------------------------------------------------------------- asking


def _read_setting() -> str:
    from processing.core.ProcessingConfig import ProcessingConfig

    return str(ProcessingConfig.getSetting(SETTING) or "").strip()


def ask_program(*words: str, patience: float) -> subprocess.CompletedProcess[str]:
    """Run a program that answers within some seconds, without a window, and return its answer."""
    return subprocess.run(
        words,
        capture_output=True,
        text=True,
        timeout=patience,
        check=False,
        env=make_environment(),
        stdin=subprocess.DEVNULL,
        **list_process_options(),
    )


@cache
def _ask_version(path: str, changed: float) -> str:  # noqa: ARG001 - a changed file is asked anew
    try:
        done = ask_program(path, "--version", patience=_PATIENCE)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise QgsProcessingException(f"The command '{path}' does not run: {error}.") from error
    words = done.stdout.split()
    if done.returncode != 0 or len(words) < 2 or words[0] != "tinsmith":
        said = (done.stderr or done.stdout).strip().splitlines() or ["nothing"]
        raise QgsProcessingException(
            f"The command '{path}' is no tinsmith: asked for its version, it said: {said[-1]}"
        )
    return " ".join(words[:2])
