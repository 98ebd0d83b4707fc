"""CityJSONSeq: a CityJSON object on the first line, and a feature with vertices on each other.

References
----------
https://www.cityjson.org/cityjsonseq/
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["City", "SequenceError", "parse_city"]


class SequenceError(Exception):
    """What is wrong with the text of a file, for the end of a sentence."""


class City(NamedTuple):
    """A city: the object of a file, with the objects and vertices of its features."""

    document: dict[str, Any]
    ranges: dict[str, tuple[int, int]]
    """Of each object of a feature, the vertices of that feature: the first, and behind the last."""


def parse_city(content: bytes) -> City:
    """Return the city of CityJSON, or of a sequence.

    Raises
    ------
    SequenceError
        If the text is no JSON, or a line behind the first is no feature.
    """
    try:
        return City(json.loads(content), {})
    except json.JSONDecodeError as error:
        lines = list(_split(content))
        if len(lines) < 2 or not _is_object(lines[0][1]):
            raise SequenceError(f"line {error.lineno} is no JSON") from error
        return _join_features(lines)
    except (ValueError, RecursionError) as error:  # no UTF-8, endless numbers, endless brackets
        raise SequenceError("its text is no JSON") from error


def _split(content: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield the lines that are not empty, with their numbers from 1."""
    for number, line in enumerate(content.split(b"\n"), start=1):
        text = line.strip(b" \t\r\x1e")  # the last is the separator of RFC 8142
        if text:
            yield number, text


def _is_object(line: bytes) -> bool:
    try:
        return isinstance(json.loads(line), dict)
    except (ValueError, RecursionError):
        return False


def _join_features(lines: list[tuple[int, bytes]]) -> City:
    city = _parse_line(*lines[0])
    objects, vertices = dict(_require(city, "CityObjects", dict, 1)), []
    vertices += _require(city, "vertices", list, 1)
    ranges = dict.fromkeys(objects, (0, len(vertices)))
    for number, line in lines[1:]:
        feature = _parse_line(number, line)
        if feature.get("type") != "CityJSONFeature":
            raise SequenceError(f"line {number} is no CityJSONFeature")
        first = len(vertices)
        vertices += _require(feature, "vertices", list, number)
        for name, one in _require(feature, "CityObjects", dict, number).items():
            if name in objects:
                raise SequenceError(f"line {number} has the object '{name[:40]}', which is there")
            objects[name], ranges[name] = one, (first, len(vertices))
    return City({**city, "CityObjects": objects, "vertices": vertices}, ranges)


def _parse_line(number: int, line: bytes) -> dict[str, Any]:
    try:
        found = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise SequenceError(f"line {number} is no JSON") from error
    if not isinstance(found, dict):
        raise SequenceError(f"line {number} is no JSON object")
    return found


def _require(found: dict[str, Any], name: str, kind: type, number: int) -> Any:
    value = found.get(name)
    if not isinstance(value, kind):
        raise SequenceError(f"line {number} has no {name}")
    return value
