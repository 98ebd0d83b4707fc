"""The door of readers and writers: errors and warnings of what is behind it name the file."""

from __future__ import annotations

from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

from ..base.notes import naming_file

if TYPE_CHECKING:
    from collections.abc import Callable

F = TypeVar("F", bound="Callable[..., Any]")


def names_its_file(function: F) -> F:
    """Let a function whose first argument is a path name that file in errors and warnings."""

    @wraps(function)
    def call(path: Any, *given: Any, **options: Any) -> Any:
        with naming_file(Path(path) if isinstance(path, str) else path):
            return function(path, *given, **options)

    return cast("F", call)
