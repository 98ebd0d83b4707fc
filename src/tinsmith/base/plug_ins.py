"""Plug-ins: what other distributions add through entry points, loaded so that none can do harm."""

from __future__ import annotations

import sys
from contextlib import suppress
from importlib.machinery import PathFinder
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from .errors import PlugInWarning
from .notes import warn
from .sentences import printable

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from importlib.metadata import EntryPoint


class PlugIn(NamedTuple):
    """An entry point of another distribution, not loaded yet."""

    name: str
    """Of the entry point."""
    distribution: str
    """Name and version of the distribution that has it."""
    load: Callable[[], Any]
    """Load what the entry point names."""


def find_plug_ins(group: str) -> list[PlugIn]:
    """Return the plug-ins of a group of entry points, by name and distribution."""
    found = [
        PlugIn(one.name, name_distribution(one), one.load) for one in entry_points(group=group)
    ]
    return sorted(found, key=lambda one: (one.name, one.distribution))


def entry_points(*, group: str) -> Iterable[EntryPoint]:
    """Return the entry points of a group; metadata is understood only where one may be."""
    if not any(_may_have(Path(place or "."), f"[{group}]".encode()) for place in sys.path):
        finders = [one for one in sys.meta_path if hasattr(one, "find_distributions")]
        if all(one is PathFinder for one in finders):
            return ()
    from importlib import metadata

    return metadata.entry_points(group=group)


def _may_have(place: Path, section: bytes) -> bool:
    """Whether a distribution among modules may have a section of entry points; an archive may."""
    try:
        inside = list(place.iterdir())
    except NotADirectoryError:
        return True
    except OSError:
        return False
    for folder in inside:
        if folder.suffix in (".dist-info", ".egg-info"):
            with suppress(OSError):
                if section in (folder / "entry_points.txt").read_bytes():
                    return True
    return False


def name_distribution(entry: EntryPoint) -> str:
    """Return name and version of the distribution that an entry point belongs to."""
    found = entry.dist
    return "an unknown distribution" if found is None else f"{found.name} {found.version}"


def describe_failure(error: BaseException) -> str:
    """Return what went wrong as a plug-in was loaded or ran, in one line."""
    text = " ".join(str(error).split()).rstrip(".")
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def warn_of_plug_in(what: str, distribution: str, reason: str) -> None:
    """Warn that a plug-in is left out, or a part of it, such as ``"format 'mine'"``, and why.

    ``distribution`` is the name and version of what is to be repaired or removed.
    """
    text = f"Plug-in {distribution}, {what}: {reason}."
    warn(printable(text), PlugInWarning)
