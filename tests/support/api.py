"""The public API as lines of text: names, signatures, members of classes.

``PYTHONPATH=tests python -m support.api`` prints it.
"""

import inspect
import sys
from functools import cached_property

import tinsmith as ts


def public_objects():
    """Return name and object of everything that ``tinsmith`` offers, packages and version aside."""
    names = sorted(ts.__all__, key=lambda name: (not name.isupper(), name))
    things = [(name, getattr(ts, name)) for name in names]
    return [(name, thing) for name, thing in things if callable(thing)]


def public_members(owner, thing):
    """Return name and object of the methods and properties of a class of ours, errors aside."""
    if not inspect.isclass(thing) or issubclass(thing, BaseException):
        return []
    found = {}
    for base in reversed(thing.__mro__):
        if base.__module__.startswith("tinsmith"):
            found |= vars(base)
    return [
        (f"{owner}.{name}", getattr(member, "__func__", member))
        for name, member in sorted(found.items())
        if not name.startswith("_") and _is_member(member)
    ]


def _is_member(member):
    kinds = (property, cached_property, classmethod, staticmethod)
    return isinstance(member, kinds) or inspect.isfunction(member)


def describe_api():
    """Return the API as lines, sorted within their class."""
    lines = []
    for name, thing in public_objects():
        lines.append(_line(name, thing))
        lines += [f"    {_line(*member)}" for member in public_members(name, thing)]
    return lines


def _line(name, thing):
    if inspect.isclass(thing) and issubclass(thing, BaseException):
        return f"error {name}({', '.join(base.__name__ for base in thing.__bases__)})"
    kind = "class " if inspect.isclass(thing) else ""
    if not callable(thing):
        return name
    return f"{kind}{name}({', '.join(map(_parameter, _parameters(thing)))})"


def _parameters(thing):
    return inspect.signature(thing).parameters.values()


def _parameter(parameter):
    """Return a parameter without its type: what a call needs, the same in every Python."""
    star = {parameter.VAR_POSITIONAL: "*", parameter.VAR_KEYWORD: "**"}.get(parameter.kind, "")
    only = "keyword " if parameter.kind is parameter.KEYWORD_ONLY else ""
    if parameter.default is parameter.empty:
        return f"{only}{star}{parameter.name}"
    default = parameter.default
    is_plain = isinstance(default, str | int | float | tuple | None)
    return f"{only}{parameter.name}={default!r}" if is_plain else f"{only}{parameter.name}=..."


if __name__ == "__main__":
    sys.stdout.write("".join(f"{line}\n" for line in describe_api()))
