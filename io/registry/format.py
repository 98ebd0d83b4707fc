"""What a format is: its name and suffixes, what it reads and writes, and by which functions."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

from ...errors import FormatError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

__all__ = ["SURFACES", "Format", "load_function", "require_options"]

_OWN_PARAMETERS = frozenset({"crs", "z_unit", "progress"})
SURFACES = ("TIN", "Survey")
"""What triangulations and their points can be written as."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Format:
    """A file format.

    Attributes
    ----------
    name : str
        What ``format=`` calls it.
    description : str
        A few words for a list.
    suffixes : tuple of str
        Lower case, with the dot; a writer is chosen by them, a reader where the content is silent.
    read, write : str, optional
        ``"module:function"``. A reader takes ``(path, *, crs=None, z_unit=None, <options>)``, a CRS
        and a Unit or None, and returns a Survey or a TIN; a writer ``(obj, path, *, <options>)``.
    reads, writes : tuple of str
        What the reader gives, what the writer takes: "TIN", "Survey", "Features", "Raster",
        "Table". Several formats may share a suffix, if they hold different things.
    precision : str
        To which digit coordinates come back from a file that was written; one sentence.
    losses : str
        What of a TIN, a Survey or a product the format does not hold; one sentence, empty if none.
    extra : str, optional
        The extra of this package that brings the library it needs.
    sniff : callable, optional
        Whether the first bytes of a file are certainly of this format.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ts.find_format("ply").suffixes
    ('.ply',)
    """

    name: str
    description: str
    suffixes: tuple[str, ...]
    read: str | None = None
    write: str | None = None
    reads: tuple[str, ...] = ("Survey",)
    writes: tuple[str, ...] = SURFACES
    precision: str = ""
    losses: str = ""
    extra: str | None = None
    sniff: Callable[[bytes], bool] | None = None

    def options(self, action: str) -> tuple[str, ...]:
        """Return the names of the options of its reader or writer (``"read"``, ``"write"``).

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.find_format("geojson").options("write")
        ('kind', 'projected')
        """
        target = getattr(self, action)
        return () if target is None else _find_options(load_function(target))


def load_function(target: str) -> Callable[..., Any]:
    """Load a reader or writer, ``"module:function"``."""
    module, _, function = target.partition(":")
    loaded: Callable[..., Any] = getattr(import_module(module), function)
    return loaded


def _find_options(function: Callable[..., Any]) -> tuple[str, ...]:
    parameters = inspect.signature(function).parameters.values()
    return tuple(
        one.name
        for one in parameters
        if one.kind is one.KEYWORD_ONLY and one.name not in _OWN_PARAMETERS
    )


def require_options(
    chosen: Format, action: str, function: Callable[..., Any], options: Mapping[str, object]
) -> None:
    """Refuse options that a reader or writer does not have."""
    allowed = _find_options(function)
    accepted = {*allowed, "progress", "z_unit"} & set(inspect.signature(function).parameters)
    unknown = [name for name in options if name not in accepted]
    if not unknown:
        return
    there_are = f"its options are {', '.join(allowed)}" if allowed else "it has no options"
    raise FormatError(
        f"Unknown option '{unknown[0]}' to {action} the format {chosen.name}: {there_are}.",
        known=allowed,
    )
