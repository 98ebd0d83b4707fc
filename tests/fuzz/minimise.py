"""Make a find small: delete items of lists, simplify numbers, as long as it stays the same find."""

from __future__ import annotations

import copy
import time
from collections.abc import Callable, Iterator
from typing import Any

Path = tuple[Any, ...]


def minimise(
    case: Any, is_same: Callable[[Any], bool], *, seconds: float = 30.0, tries: int = 2000
) -> Any:
    """Return a smaller case of which `is_same` still holds (delta debugging, Zeller 2002)."""
    end = time.monotonic() + seconds
    left = tries
    is_smaller = True
    while is_smaller:
        is_smaller = False
        for path in list(paths(case)):
            if not has(case, path):
                continue
            at = 0
            while True:
                candidate, at = next_candidate(case, path, at)
                if candidate is None:
                    break
                left -= 1
                if left < 0 or time.monotonic() > end:
                    return case
                if is_same(candidate):
                    case, is_smaller, at = candidate, True, 0
    return case


def paths(value: Any, path: Path = ()) -> Iterator[Path]:
    """Yield the path of every list, string and number, containers first."""
    if isinstance(value, (list, str, float, int)) and not isinstance(value, bool):
        yield path
    if isinstance(value, (dict, list)):
        for key, item in value.items() if isinstance(value, dict) else enumerate(value):
            yield from paths(item, (*path, key))


def has(case: Any, path: Path) -> bool:
    """Return whether a path still leads somewhere."""
    for key in path:
        if isinstance(case, list) and not key < len(case):
            return False
        case = case[key]
    return True


def next_candidate(case: Any, path: Path, at: int) -> tuple[Any, int]:
    """Return the case with the next simplification of the value at a path, or None."""
    value = case
    for key in path:
        value = value[key]
    smaller = simpler(value)
    for count, other in enumerate(smaller):
        if count == at:
            return replaced(case, path, other), at + 1
    return None, at


def replaced(case: Any, path: Path, value: Any) -> Any:
    """Return a copy of the case with another value at a path."""
    if not path:
        return value
    made = copy.deepcopy(case)
    holder = made
    for key in path[:-1]:
        holder = holder[key]
    holder[path[-1]] = value
    return made


def simpler(value: Any) -> Iterator[Any]:
    """Yield simpler values, the boldest first."""
    if isinstance(value, (list, str)):
        size = len(value)
        while size:
            for start in range(0, len(value), size):
                yield value[:start] + value[start + size :]
            size //= 2
    elif isinstance(value, float) and value == value and abs(value) != float("inf"):
        options = [0.0, float(round(value)), *(round(value, d) for d in (1, 2, 3, 6))]
        yield from (v for v in dict.fromkeys(options) if len(repr(v)) < len(repr(value)))
    elif isinstance(value, int) and value not in (0, 1):
        yield from (0, 1, value // 2)
