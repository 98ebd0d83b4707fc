"""Products: functions of surfaces, which begin from snapshots and return what is known of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextvars import ContextVar
from functools import wraps
from typing import TYPE_CHECKING, Any, Protocol, TypeVar, cast

if TYPE_CHECKING:
    from collections.abc import Callable

F = TypeVar("F", bound="Callable[..., Any]")


class _Surface(Protocol):
    """What products need of a surface here."""

    @property
    def notes(self) -> tuple[str, ...]:
        """What is known of it."""

    @property
    def source(self) -> str:
        """Name of its file, if it has one."""

    def snapshot(self) -> _Surface:
        """Return it as it is now."""


_is_inside: ContextVar[bool] = ContextVar("is_inside_product", default=False)
"""Whether a product is being made: what it makes on its way needs no notes."""


def product(function: F) -> F:
    """Make a function of surfaces a product.

    It gets snapshots in place of the surfaces among its arguments, also of those in a mapping or a
    list: so it sees one state of each, whatever other threads edit. What it returns has their notes
    in front of its own, if it takes notes (``with_notes``).
    """

    @wraps(function)
    def make(*given: Any, **options: Any) -> Any:
        surfaces: list[_Surface] = []
        still = [_freeze(value, surfaces) for value in given]
        of_name = {name: _freeze(value, surfaces) for name, value in options.items()}
        if _is_inside.get():
            return function(*still, **of_name)
        token = _is_inside.set(True)
        try:
            made = function(*still, **of_name)
        finally:
            _is_inside.reset(token)
        has_notes = hasattr(type(made), "with_notes")
        return made.with_notes(notes_of_surfaces(surfaces)) if has_notes else made

    make.__dict__["is_product"] = True
    return cast("F", make)


def is_product(function: object) -> bool:
    """Tell whether a function begins from snapshots."""
    return getattr(function, "is_product", False) is True


def _freeze(value: Any, surfaces: list[_Surface]) -> Any:
    """Return a value with snapshots in place of surfaces, which are gathered."""
    if _is_surface(value):
        surfaces.append(value.snapshot())
        return surfaces[-1]
    if isinstance(value, Mapping) and any(map(_is_surface, value.values())):
        return {name: _freeze(one, surfaces) for name, one in value.items()}
    if isinstance(value, list | tuple) and any(map(_is_surface, value)):
        return [_freeze(one, surfaces) for one in value]
    return value


def _is_surface(value: Any) -> bool:
    return hasattr(type(value), "snapshot") and hasattr(type(value), "triangulation")


def notes_of_surfaces(surfaces: Iterable[_Surface]) -> tuple[str, ...]:
    """Return the notes of surfaces; of several ones each with the name of its surface.

    They are named after their files, by number where these do not tell them apart.
    """
    named = list(surfaces)
    if len(named) == 1:
        return named[0].notes
    names = [surface.source for surface in named]
    if not all(names) or len(set(names)) < len(names):
        names = [
            f"Surface {number}" + (f" ({name})" if name else "")
            for number, name in enumerate(names, start=1)
        ]
    return tuple(
        f"{name}: {note}"
        for name, surface in zip(names, named, strict=True)
        for note in surface.notes
    )
