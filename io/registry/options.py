"""Options of readers and writers, as their signatures and docstrings say."""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass, fields
from functools import wraps
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Sequence

_OWN_PARAMETERS = frozenset({"crs", "elevation_unit", "progress"})
"""What every reader or writer may take, which is no option of its format."""


@dataclass(frozen=True, slots=True)
class FormatOption:
    """An option of a reader or writer.

    Attributes
    ----------
    name : str
        As ``read`` and ``write`` take it.
    annotation : str
        Its type as the signature has it, such as ``"float | None"``; empty if it has none.
    default : object
    kind : str
        Its type as the docstring has it, such as ``"(4,) sequence of int, optional"``.
    text : str
        What the docstring says of it, on one line.
    """

    name: str
    annotation: str
    default: Any
    kind: str
    text: str


_SHARED = {
    "faces": (
        'FacePolicy = "most"',
        "Triangles of a mesh to read, where some make no surface, because they have no area seen "
        'from above or overlap larger ones: "surface" leaves them out, "most" does so up to one '
        'percent of the area, "all" refuses the file.',
    ),
    "encoding": ("str, optional", "Encoding of the text; found by looking if it is not given."),
    "source_crs": ("CRS, str or int, optional", "CRS of the coordinates, if it is not ``crs``."),
    "nodata": (
        "float or sequence of float, optional",
        "Elevations that stand for none, besides those that the file declares.",
    ),
}
"""Options of several readers, which their docstrings need not say again."""


def taking(options: type[Any]) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Let a function whose last argument is of a class take the fields of the class as options.

    Parameters
    ----------
    options : type
        A dataclass; each field is an option of a reader, or what every reader may take.
    """

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def call(*given: Any, **named: Any) -> Any:
            return function(*given, options(**named))

        whole = inspect.signature(function)
        own = list(whole.parameters.values())[:-1]
        of_class = [
            inspect.Parameter(
                one.name, inspect.Parameter.KEYWORD_ONLY, default=one.default, annotation=one.type
            )
            for one in fields(options)
        ]
        vars(call)["__signature__"] = whole.replace(parameters=[*own, *of_class])
        return call

    return decorate


def list_options(function: Callable[..., Any]) -> tuple[FormatOption, ...]:
    """Return the options of a reader or writer in the order of its signature."""
    documented = _SHARED | describe_parameters(inspect.getdoc(function) or "")
    return tuple(
        FormatOption(
            one.name,
            one.annotation if isinstance(one.annotation, str) else "",
            one.default,
            *documented.get(one.name, ("", "")),
        )
        for one in inspect.signature(function).parameters.values()
        if one.kind is one.KEYWORD_ONLY and one.name not in _OWN_PARAMETERS
    )


def find_option_not_taken(given: Iterable[str], outputs: Sequence[Collection[str]]) -> str | None:
    """Return the first of the options given that no output takes; None if there is none.

    To append must be possible in all outputs, since a file of another format would be replaced;
    to overwrite is what formats do that have no such option.
    """
    for name in given:
        able = [name in taken for taken in outputs]
        if name != "overwrite" and not (all(able) if name == "append" else any(able)):
            return name
    return None


def describe_parameters(docstring: str) -> dict[str, tuple[str, str]]:
    """Return the types and the texts of the parameters of a numpydoc docstring, by name.

    Examples
    --------
    >>> describe_parameters('''Read.
    ...
    ... Parameters
    ... ----------
    ... band : int, optional
    ...     Band to read,
    ...     from 1.
    ...
    ... Returns
    ... -------
    ... Survey
    ... ''')
    {'band': ('int, optional', 'Band to read, from 1.')}
    """
    found: dict[str, tuple[str, str]] = {}
    _, _, section = docstring.partition("Parameters\n----------\n")
    names: list[str] = []
    parameters = re.split(r"^\S.*\n---", section, maxsplit=1, flags=re.MULTILINE)[0]
    for line in parameters.splitlines():
        if line.startswith(" "):
            for name in names:
                kind, text = found[name]
                found[name] = kind, f"{text} {line.strip()}".strip()
        elif line:
            given, _, kind = line.partition(" : ")
            names = [name.strip() for name in given.split(",")]
            found.update(dict.fromkeys(names, (kind, "")))
    return found
