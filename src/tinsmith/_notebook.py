"""Notebooks: cards that an object shows, made by a package that stands above its own."""

from __future__ import annotations

from importlib import import_module
from typing import Any

__all__ = ["make_card", "register_card"]

_MAKERS: dict[str, str] = {}


def register_card(kind: str, maker: str) -> None:
    """Name the function that makes the card of a class; it is loaded when first used.

    Parameters
    ----------
    kind : str
        Name of the class.
    maker : str
        The function as ``package.module:name``; it takes the object and returns HTML.
    """
    _MAKERS[kind] = maker


def make_card(thing: object) -> str | None:
    """Return the HTML of an object's card, None if there is no function that makes it."""
    maker = _MAKERS.get(type(thing).__name__)
    if maker is None:
        return None
    module, _, name = maker.partition(":")
    card: Any = getattr(import_module(module), name)
    return str(card(thing))
