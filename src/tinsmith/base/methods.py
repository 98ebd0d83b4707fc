"""Methods whose work is done by a package that stands above the one of their class."""

from __future__ import annotations

from importlib import import_module
from typing import Any

__all__ = ["call_method", "make_html_repr", "register_methods"]

_FUNCTIONS: dict[str, str] = {}


def register_methods(functions: dict[str, str]) -> None:
    """Name the functions that do the work of methods; each is loaded when first called.

    Parameters
    ----------
    functions : dict of str to str
        By class and method (``"TIN.plot"``), the function as ``package.module:name``; it takes the
        object first.
    """
    _FUNCTIONS.update(functions)


def call_method(method: str, *given: Any, **options: Any) -> Any:
    """Call the function that does the work of a method."""
    module, _, name = _FUNCTIONS[method].partition(":")
    function: Any = getattr(import_module(module), name)
    return function(*given, **options)


def make_html_repr(thing: object) -> str:
    """Return the HTML that an object shows in a notebook."""
    return str(call_method(f"{type(thing).__name__}._repr_html_", thing))
