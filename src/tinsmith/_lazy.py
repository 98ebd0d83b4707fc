"""Public names that are loaded when they are first used."""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

from ._optional import describe_missing

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

__all__ = ["lazy_names"]


class _Package(ModuleType):
    """A package whose public names are not hidden by modules of the same names.

    Python binds a module to its package as soon as it is loaded: ``slope``, once the function
    ``slope`` of the module ``slope`` is used.
    """

    def __setattr__(self, name: str, value: Any) -> None:
        is_hiding = isinstance(value, ModuleType) and name in self.__dict__.get("_lazy_names", ())
        if not is_hiding:
            super().__setattr__(name, value)


def lazy_names(
    package: str, names_of: Mapping[str, tuple[str, ...]]
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return ``__getattr__`` and ``__dir__`` of a package whose names are in other modules.

    Parameters
    ----------
    package : str
        Its ``__name__``.
    names_of : mapping
        Names by the module that has them, relative to the package: ``".registry"``. A module
        within the package can be used as an attribute, too.
    """
    module_of = {name: module for module, names in names_of.items() for name in names}
    modules = {module.split(".")[1] for module in names_of if not module.startswith("..")}
    this = sys.modules[package]
    this.__dict__["_lazy_names"] = frozenset(module_of)
    this.__class__ = _Package

    def load(name: str) -> Any:
        if name in module_of:
            try:
                return getattr(import_module(module_of[name], package), name)
            except ModuleNotFoundError as error:
                missing = describe_missing(error)
                if missing is None:
                    raise
                raise missing from error
        if name in modules:
            return import_module(f".{name}", package)
        raise AttributeError(f"module '{package}' has no attribute '{name}'")

    return load, lambda: sorted({*module_of, *modules})
