"""Options of commands that are those of a product, made of its signature and docstring.

The source is read, since loading a product takes longer than all else that a help needs.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from importlib.util import find_spec
from inspect import cleandoc
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..base.sentences import name_options
from .format_options import find_parameters
from .parameters import Decorator, Words, parse_numbers

if TYPE_CHECKING:
    from ..io.registry import FormatOption

_MOST_LETTERS = 300
_REQUIRED = object()
_METAVARS = {
    r"\bdegrees": "DEGREES",
    r"\bmetres": "METRES",
    r"CRS units squared|square of CRS units": "AREA",
    r"CRS units": "LENGTH",
    r"unit of (the )?(elevations|ground)": "HEIGHT",
    r"\b[Ff]actor\b": "FACTOR",
}
"""What stands for a number, by words of its documentation."""


def product_options(function: str, names: str, **words: str) -> Decorator:
    """Return a decorator that adds options of a product, as :func:`list_product_options`."""

    def decorate(command: Any) -> Any:
        for option in reversed(list_product_options(function, names, **words)):
            command = option(command)
        return command

    return decorate


def list_product_options(function: str, names: str, **words: str) -> list[Decorator]:
    """Return decorators that each add an option of a product to a command.

    Parameters
    ----------
    function : str
        Such as ``"terrain.gridding.hillshades.hillshade"``.
    names : str
        The options, with blanks between them.
    **words : str
        Help of those for which the docstring does not say enough at a command line.
    """
    known = _read_parameters(function)
    return [_make_option(known[name], words.get(name, "")) for name in names.split()]


@cache
def _read_parameters(function: str) -> dict[str, FormatOption]:
    """Return what the source of a function says of its parameters."""
    from ..io.registry import FormatOption, describe_parameters

    package, *modules, name = function.split(".")
    spec: Any = find_spec(f"tinsmith.{package}")
    path = Path(spec.origin).parent.joinpath(*modules).with_suffix(".py")
    text = spec.loader.get_data(str(path)).decode()
    start = text.rindex(f"\ndef {name}(")  # the last one: overloads come before
    end = text.index('"""', text.index('"""', start) + 3) + 3
    node: Any = ast.parse(text[start:end]).body[0]
    documented = describe_parameters(cleandoc(ast.get_docstring(node) or ""))
    given = [*node.args.args, *node.args.kwonlyargs]
    least = len(node.args.args) - len(node.args.defaults)
    defaults = [*[None] * least, *node.args.defaults, *node.args.kw_defaults]
    options = [
        (one.arg, one.annotation, _REQUIRED if default is None else ast.literal_eval(default))
        for one, default in zip(given, defaults, strict=True)
        if default is None or isinstance(default, ast.Constant)
    ]
    if node.args.kwarg is not None:  # whose options have defaults, which the docstring tells
        options += [(*one, None) for one in _read_keywords(node, text, path, spec.loader)]
    return {
        one: FormatOption(one, ast.unparse(kind), default, *documented.get(one, ("", "")))
        for one, kind, default in options
    }


def _read_keywords(node: Any, text: str, path: Path, loader: Any) -> list[tuple[str, Any]]:
    """Return names and annotations of a function's keywords, those of a TypedDict beside it."""
    name = node.args.kwarg.annotation.slice.id
    (module,) = re.findall(rf"^from \.(\w+) import .*\b{name}\b", text, re.MULTILINE)
    classes: Any = ast.parse(loader.get_data(str(path.with_stem(module)))).body
    (found,) = (one for one in classes if getattr(one, "name", "") == name)
    fields: list[Any] = [one for one in found.body if isinstance(one, ast.AnnAssign)]
    return [(one.target.id, one.annotation) for one in fields]


def _make_option(one: FormatOption, words: str) -> Decorator:
    flag = f"--{one.name.replace('_', '-')}"
    how = _find_how(one, f"{one.kind} {one.text}")
    if one.default is _REQUIRED:
        how["required"] = True
    elif one.default is not None and not how.get("is_flag"):
        how |= {"default": one.default, "show_default": True}
    elif how.get("is_flag") and one.default is None:
        flag, how["default"] = f"{flag}/--no-{flag[2:]}", None
        del how["is_flag"]
    return click.option(flag, one.name, help=words or _shorten(one.text), **how)


def _find_how(one: FormatOption, said: str) -> dict[str, Any]:
    """Return what click needs to know of a value."""
    if "ArrayLike" in one.annotation:
        return {"callback": parse_numbers, "metavar": "NUMBER,..."}
    if one.annotation.startswith("tuple[float, float]"):
        return {"callback": parse_numbers, "metavar": "NUMBER,NUMBER"}
    if one.kind.startswith("{"):
        return {"type": Words(re.findall(r'"(.*?)"', one.kind.partition("}")[0]))}
    how = find_parameters(one)
    if how.get("metavar") == "NUMBER":
        found = (word for pattern, word in _METAVARS.items() if re.search(pattern, said))
        how["metavar"] = next(found, "NUMBER")
    return how


def _shorten(text: str) -> str:
    """Return as many whole sentences as fit, and flags in place of the options that they name."""
    plain = re.sub(r":\w+:`\.?(.*?)`", r"\1", text).replace("``", "`")
    flagged = name_options(plain, lambda name: f"--{name.replace('_', '-')}").replace("`", "")
    first, *more = re.split(r"(?<=\.) (?=[A-Z])", flagged)
    while more and len(first) + len(more[0]) < _MOST_LETTERS:
        first = f"{first} {more.pop(0)}"
    return first
