"""Compile the harnesses: CGAL's own flags, and this machine's instructions.

tinsmith chooses vector instructions when it runs, so CGAL gets the same chance: ``-march=native``
makes it a fifth faster.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

__all__ = ["CgalMissingError", "build_harness"]

HERE = Path(__file__).parent
SHARED = (HERE / "serve.hpp", Path(__file__))
BUILT = HERE.parents[1] / "build" / "benchmarks"
FLAGS = ("-std=c++17", "-O3", "-DNDEBUG", "-march=native", "-frounding-math")


class CgalMissingError(Exception):
    """There is no compiler, or it does not find CGAL."""


def build_harness(name: str = "delaunay") -> Path:
    """Return an executable, compiled anew if its source or flags have changed.

    Parameters
    ----------
    name : str
        Of a C++ file in this folder: ``"delaunay"``, ``"constrained"`` or ``"edits"``.

    Raises
    ------
    CgalMissingError
        If there is no g++, or it cannot compile the harness.
    """
    source, built = HERE / f"{name}.cpp", BUILT / f"cgal_{name}"
    changed = max(x.stat().st_mtime for x in (source, *SHARED))
    if built.exists() and built.stat().st_mtime > changed:
        return built
    compiler = shutil.which("g++")
    if compiler is None:
        raise CgalMissingError("g++ is not installed")
    if not _finds_cgal(compiler):
        raise CgalMissingError("its headers are not installed (Debian: libcgal-dev)")
    _compile_harness(compiler, source, built)
    return built


def _compile_harness(compiler: str, source: Path, built: Path) -> None:
    built.parent.mkdir(parents=True, exist_ok=True)
    fresh = built.with_suffix(f".{os.getpid()}")
    command = [compiler, *FLAGS, str(source), "-lmpfr", "-lgmp", "-o", str(fresh)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise CgalMissingError(f"g++ fails: {(done.stderr.splitlines() or ['?'])[0]}")
    fresh.replace(built)


def _finds_cgal(compiler: str) -> bool:
    include = "#include <CGAL/version.h>\n"
    command = [compiler, "-E", "-x", "c++", "-"]
    return subprocess.run(command, input=include, capture_output=True, text=True).returncode == 0
