"""How long a native reader may take, how much memory, and how much of it there is."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

LEAST_SECONDS = 5.0
"""Seconds of processor time that any file gets; small sound ones take some milliseconds."""

BYTES_PER_SECOND = 1_000_000
"""Bytes for which a file gets a further second; the slowest sound ones (Gmsh in text through
meshio, GML through GDAL) are read at 5 to 10 MB in a second, so this is a margin of 5 or more."""

WAITING_FACTOR = 6.0
"""Seconds on the clock for each of the processor: a busy machine shares its cores."""

LEAST_MEMORY = 1 << 30
"""Bytes of memory, beyond those that the libraries take at rest, that any file gets."""

MEMORY_PER_BYTE = 64
"""Bytes of memory that each byte of a file gets: VTK takes about 150 bytes for a vertex that is
30 bytes in a compressed file, GeoJSON through GDAL about 20 bytes for one."""

START_SECONDS = 120.0
"""Seconds on the clock for starting Python and loading a library in it; VTK from a cold disk
takes some ten."""


class Limits(NamedTuple):
    """What reading one file may take."""

    seconds: float
    """Of processor time, until the next part of the answer."""
    memory: int
    """Bytes beyond those that the libraries take at rest, and bytes of a part of the answer."""

    @property
    def waiting_seconds(self) -> float:
        """Seconds on the clock."""
        return self.seconds * WAITING_FACTOR


def choose_limits(n_bytes: int) -> Limits:
    """Return what a file of so many bytes gets.

    Examples
    --------
    >>> choose_limits(5_000_000).seconds
    10.0
    """
    return Limits(
        LEAST_SECONDS + n_bytes / BYTES_PER_SECOND, LEAST_MEMORY + MEMORY_PER_BYTE * n_bytes
    )


_NOT_TOLD = 48 * (2**31 - 1)
"""Bytes taken to be there where the system does not tell: those of the largest raster that is read.
"""


def measure_free_memory() -> int:
    """Return the bytes of memory that are available, where the system tells.

    Examples
    --------
    >>> measure_free_memory() > 0
    True
    """
    try:
        with Path("/proc/meminfo").open(encoding="ascii") as file:
            found = next(line for line in file if line.startswith("MemAvailable:"))
        return int(found.split()[1]) * 1024
    except (OSError, StopIteration, ValueError, IndexError):
        return _NOT_TOLD
