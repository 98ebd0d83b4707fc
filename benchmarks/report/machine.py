"""The machine and the versions, in words that name no host and no path."""

from __future__ import annotations

import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from ..compiled.build import SOURCES

__all__ = ["describe"]

PACKAGES = (
    "tinsmith",
    "numpy",
    "triangle",
    "scipy",
    "startinpy",
    "shapely",
    "matplotlib",
    "pandas",
    "rasterio",
    "pyogrio",
    "pyvista",
    "meshio",
    "trimesh",
)
CGAL_VERSION = Path("/usr/include/CGAL/version.h")


def describe() -> dict[str, str]:
    """Return cores, system and versions by name."""
    versions = {
        "machine": f"{os.cpu_count()}-core {platform.machine()}, {platform.system()}",
        "Python": platform.python_version(),
    }
    for package in PACKAGES:
        try:
            versions[package] = version(package)
        except PackageNotFoundError:
            continue
    return versions | _find_library_versions()


def _find_library_versions() -> dict[str, str]:
    found = {name: release.removeprefix("v") for name, (_, release) in SOURCES.items()}
    if CGAL_VERSION.exists():
        lines = CGAL_VERSION.read_text().splitlines()
        found["CGAL"] = next(x.split()[2] for x in lines if x.startswith("#define CGAL_VERSION "))
    try:
        import shapely

        found["GEOS"] = shapely.geos_version_string
    except ImportError:
        pass
    return found
