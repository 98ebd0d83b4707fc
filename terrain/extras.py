"""Optional libraries, loaded when first needed."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from ..tin import MissingExtraError

__all__ = ["pyvista"]


def pyvista(purpose: str) -> Any:
    """Return the pyvista module, or name the extra that brings it.

    Parameters
    ----------
    purpose : str
        Subject of the sentence: what needs the library.

    Raises
    ------
    MissingExtraError
        If pyvista is not installed.
    """
    try:
        return import_module("pyvista")
    except ImportError as error:
        raise MissingExtraError("pyvista", extra="view", purpose=purpose) from error
