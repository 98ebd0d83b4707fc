"""Optional libraries, loaded when first needed."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .errors import MissingExtraError

__all__ = ["matplotlib", "meshio", "pyvista"]


def matplotlib(purpose: str) -> Any:
    """Return matplotlib's module of figures, or name the extra that brings it.

    Figures of this module are drawn without a screen and leave no state behind.

    Parameters
    ----------
    purpose : str
        Subject of the sentence: what needs the library.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed.
    """
    return _module("matplotlib.figure", "plot", purpose)


def meshio(purpose: str) -> Any:
    """Return the meshio module, or name the extra that brings it.

    Parameters
    ----------
    purpose : str
        Subject of the sentence: what needs the library.

    Raises
    ------
    MissingExtraError
        If meshio is not installed.
    """
    return _module("meshio", "mesh", purpose)


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
    return _module("pyvista", "view", purpose)


def _module(name: str, extra: str, purpose: str) -> Any:
    try:
        return import_module(name)
    except ImportError as error:
        library = name.partition(".")[0]
        raise MissingExtraError(library, extra=extra, purpose=purpose) from error
