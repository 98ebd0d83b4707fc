"""Arguments of charts: titles, and features that a certain function returned; names of files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base.errors import OptionError
from ...base.results import Features

if TYPE_CHECKING:
    from collections.abc import Iterable


UNTITLED = "Terrain surface"
"""Title of what nobody gave one."""
PICTURE_SUFFIXES = (".png",)
"""File name endings of figures that can be written; asked for where nothing may be drawn."""


def parse_title(title: Any, usual: str) -> str:
    r"""Return a title on one line, the usual one if none is given.

    Raises OptionError if it is no text.

    Examples
    --------
    >>> parse_title("Two\n lines", "Profile"), parse_title(None, "Profile")
    ('Two lines', 'Profile')
    """
    return " ".join(parse_text("title", title, or_none=True).split()) or usual


def parse_text(option: str, text: Any, *, or_none: bool = False) -> str:
    """Return a text, or refuse what is none; None, where it is allowed, is an empty one."""
    if text is None and or_none:
        return ""
    if not isinstance(text, str):
        raise OptionError(option, text, "text", or_none=or_none)
    return text


def require_features(
    option: str, features: Any, *, kind: str, columns: Iterable[str], source: str
) -> None:
    """Refuse what is neither None nor features of a kind with some columns.

    ``option`` is the name of the parameter; ``source`` the function that returns such features, for
    the sentence.
    """
    if features is None:
        return
    is_features = isinstance(features, Features) and features.kind == kind
    if not is_features or not set(columns) <= set(features.columns):
        raise OptionError(option, features, f"features that {source} returned", or_none=True)
