"""Compile the harness: CGAL's own flags, and this machine's instructions.

tinsmith chooses vector instructions when it runs, so CGAL gets the same chance: ``-march=native``
makes it a fifth faster.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

__all__ = ["CgalMissingError", "harness"]

SOURCE = Path(__file__).parent / "delaunay.cpp"
MADE_OF = (SOURCE, Path(__file__))
BUILT = Path(__file__).parents[2] / "build" / "benchmarks" / "cgal_delaunay"
FLAGS = ("-std=c++17", "-O3", "-DNDEBUG", "-march=native", "-frounding-math")


class CgalMissingError(Exception):
    """There is no compiler, or it does not find CGAL."""


def harness() -> Path:
    """Return the executable, compiled anew if its source or flags have changed.

    Raises
    ------
    CgalMissingError
        If there is no g++, or it cannot compile the harness.
    """
    if BUILT.exists() and BUILT.stat().st_mtime > max(x.stat().st_mtime for x in MADE_OF):
        return BUILT
    compiler = shutil.which("g++")
    if compiler is None:
        raise CgalMissingError("g++ is not installed")
    if not _finds_cgal(compiler):
        raise CgalMissingError("its headers are not installed (Debian: libcgal-dev)")
    BUILT.parent.mkdir(parents=True, exist_ok=True)
    fresh = BUILT.with_suffix(".new")
    command = [compiler, *FLAGS, str(SOURCE), "-lmpfr", "-lgmp", "-o", str(fresh)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise CgalMissingError(f"g++ fails: {(done.stderr.splitlines() or ['?'])[0]}")
    fresh.replace(BUILT)
    return BUILT


def _finds_cgal(compiler: str) -> bool:
    include = "#include <CGAL/version.h>\n"
    command = [compiler, "-E", "-x", "c++", "-"]
    return subprocess.run(command, input=include, capture_output=True, text=True).returncode == 0
