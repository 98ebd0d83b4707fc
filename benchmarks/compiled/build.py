"""Compile the harnesses: the peers' own flags, and this machine's instructions.

tinsmith chooses vector instructions when it runs, so the peers get the same chance:
``-march=native`` makes CGAL a fifth faster.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

__all__ = ["PeerMissingError", "build_harness"]

HERE = Path(__file__).parent
SHARED = (*HERE.glob("*.hpp"), Path(__file__))
BUILT = HERE.parents[1] / "build" / "benchmarks"
FLAGS = ("-std=c++17", "-O3", "-DNDEBUG", "-march=native")
SOURCES = {
    "cdt": ("https://github.com/artem-ogre/CDT", "1.4.4"),
    "delaunay32": ("https://github.com/morishuz/delaunay32", "v0.6.2"),
    "detria": ("https://github.com/Kimbatt/detria", "8aa25f3"),
}
"""Where the source of a peer is that no package has, and its tag or commit."""


class PeerMissingError(Exception):
    """There is no compiler, or it does not find the peer."""


def build_harness(name: str) -> Path:
    """Return an executable, compiled anew if its source or flags have changed.

    Parameters
    ----------
    name : str
        Of a C++ file in this folder, as `name_harness` makes it.

    Raises
    ------
    PeerMissingError
        If there is no g++, or it cannot compile the harness.
    """
    source, built = HERE / f"{name}.cpp", BUILT / name
    changed = max(x.stat().st_mtime for x in (source, *SHARED))
    if built.exists() and built.stat().st_mtime > changed:
        return built
    compiler = shutil.which("g++")
    if compiler is None:
        raise PeerMissingError("g++ is not installed")
    flags = FLAGS_OF_PEERS[name.partition("_")[0]](compiler)
    _compile_harness(compiler, source, flags, built)
    return built


def _compile_harness(compiler: str, source: Path, flags: list[str], built: Path) -> None:
    built.parent.mkdir(parents=True, exist_ok=True)
    fresh = built.with_suffix(f".{os.getpid()}")
    command = [compiler, *FLAGS, str(source), *flags, "-o", str(fresh)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise PeerMissingError(f"g++ fails: {(done.stderr.splitlines() or ['?'])[0]}")
    fresh.replace(built)


def _list_cgal_flags(compiler: str) -> list[str]:
    include = "#include <CGAL/version.h>\n"
    command = [compiler, "-E", "-x", "c++", "-"]
    if subprocess.run(command, input=include, capture_output=True, text=True).returncode:
        raise PeerMissingError("its headers are not installed (Debian: libcgal-dev)")
    return ["-frounding-math", "-lmpfr", "-lgmp"]


def _find_source(name: str, header: str) -> Path:
    """Return the folder of a peer that has no package; ``header`` is a file in it."""
    address, version = SOURCES[name]
    usual = BUILT / f"{name}-{version}"
    variable = f"{name.upper()}_SOURCE"
    folder = Path(os.environ.get(variable, usual))
    if not (folder / header).exists():
        raise PeerMissingError(
            f"its source is not in {folder} (git clone {address} {usual} && "
            f"git -C {usual} checkout {version}, or name a copy in {variable})"
        )
    return folder


def _list_delaunay32_flags(_: str) -> list[str]:
    """Of its sources, which are compiled with the harness."""
    folder = _find_source("delaunay32", "include/delaunay32/delaunay.hpp")
    sources = sorted(map(str, (folder / "src").glob("*.cpp")))
    return [f"-I{folder / 'include'}", *sources, "-pthread"]


def _list_cdt_flags(_: str) -> list[str]:
    return [f"-I{_find_source('cdt', 'CDT/include/CDT.h') / 'CDT/include'}"]


def _list_detria_flags(_: str) -> list[str]:
    return [f"-I{_find_source('detria', 'include/detria.hpp') / 'include'}"]


FLAGS_OF_PEERS: dict[str, Callable[[str], list[str]]] = {
    "cdt": _list_cdt_flags,
    "cgal": _list_cgal_flags,
    "delaunay32": _list_delaunay32_flags,
    "detria": _list_detria_flags,
}
"""By the first word of a harness's name: what the compiler of that name must be told besides."""
