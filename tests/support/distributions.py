"""What is handed out: source distribution and wheel, and machines with only what they bring."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import sysconfig
import venv
import zipfile
from importlib import metadata
from pathlib import Path

from support.processes import run

ROOT = Path(__file__).parents[2]


def build(folder):
    """Return sdist and wheel: those in the folder that TINSMITH_DIST names, else freshly built.

    The core is compiled quickly, from what is in the sdist alone.
    """
    given = os.environ.get("TINSMITH_DIST")
    if given is not None:
        return find_in(Path(given))
    source = build_source(folder)
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation"]
    fast = {"SKBUILD_CMAKE_DEFINE": "TINSMITH_FAST_BUILD=ON", "PIP_NO_INDEX": "1"}
    require_success(run(*command, "--wheel-dir", folder, source, **fast))
    return find_in(folder)


def build_source(folder, **environment):
    """Return a source distribution of the working tree."""
    code = f"from scikit_build_core.build import build_sdist; build_sdist({str(folder)!r})"
    require_success(run(sys.executable, "-c", code, cwd=ROOT, **environment))
    return next(folder.glob("*.tar.gz"))


def find_in(folder):
    """Return the one source distribution and the one wheel in a folder."""
    (source,), (wheel,) = folder.glob("*.tar.gz"), folder.glob("*.whl")
    return source, wheel


def require_success(result):
    """Return a result of a command that must have ended well."""
    assert result.returncode == 0, result.stdout + result.stderr
    return result


def install(wheel, folder, *libraries):
    """Install a wheel with libraries, and what they need, into a new environment; return its bin.

    The libraries are links to the installed ones: nothing is fetched, and nothing else is there.
    """
    venv.create(folder, with_pip=False)
    python = folder / "bin" / "python"
    command = [sys.executable, "-m", "pip", "--python", python, "install", "--quiet", "--no-deps"]
    require_success(subprocess.run([*command, "--no-index", wheel], capture_output=True, text=True))
    place = sysconfig.get_path("purelib", vars={"base": folder, "platbase": folder})
    for name in sorted(find_needed(libraries)):
        link_distribution(name, Path(place))
    return python.parent


def find_needs(wheel):
    """Return the libraries that a plain installation of a wheel brings."""
    with zipfile.ZipFile(wheel) as archive:
        name = next(one for one in archive.namelist() if one.endswith(".dist-info/METADATA"))
        text = archive.read(name).decode()
    return name_libraries(re.findall(r"^Requires-Dist: (.*)$", text, re.M))


def find_needed(libraries):
    """Return libraries and those that they need, without extras."""
    found, open_names = set(), set(libraries)
    while open_names:
        name = open_names.pop()
        found.add(name)
        open_names |= name_libraries(metadata.requires(name) or ()) - found
    return found


def name_libraries(requirements):
    """Return the names in requirements that hold on this machine without extras."""
    names = set()
    for one in requirements:
        text, _, marker = one.partition(";")
        if not marker or is_met(marker):
            names.add(re.match(r"[\w.-]+", text)[0])
    return names


def is_met(marker):
    """Whether a marker is true here, with no extra asked for."""
    from packaging.markers import Marker

    return Marker(marker).evaluate({"extra": ""})


def link_distribution(name, place):
    """Link the folders and modules of an installed distribution into a folder."""
    for file in metadata.files(name) or ():
        top = Path(file).parts[0]
        if top not in ("..", "__pycache__") and not (place / top).exists():
            (place / top).symlink_to(metadata.distribution(name).locate_file(top))
