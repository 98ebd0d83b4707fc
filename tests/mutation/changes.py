"""Small changes to Python (nodes of its syntax tree) and to C++ (tokens), as edits of the text."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from typing import NamedTuple


class Change(NamedTuple):
    """An edit of one file: the text from `start` to `stop` becomes `new`."""

    start: int
    stop: int
    new: str
    what: str

    def applied(self, text: str) -> str:
        return text[: self.start] + self.new + text[self.stop :]


OPERATORS = {
    "<": "<=",
    "<=": "<",
    ">": ">=",
    ">=": ">",
    "==": "!=",
    "!=": "==",
    "in": "not in",
    "not in": "in",
    "is": "is not",
    "is not": "is",
    "and": "or",
    "or": "and",
    "+": "-",
    "-": "+",
    "*": "/",
    "/": "*",
    "//": "*",
    "%": "*",
    "&": "|",
    "|": "&",
}
"""What each operator of Python becomes."""

SYMMETRIC = {"max", "min", "maximum", "minimum", "hypot", "gcd"}
"""Functions to which it is the same which argument comes first."""

UNSEEN = {
    "slots": "of a dataclass: memory only",
    "strict": "of zip: a guard against a mistake of our own, which no input makes",
    "maxsize": "of a cache: speed only",
}
"""Keywords whose values show nowhere, and why."""

_LENGTH_TO_FIND = re.compile(r"reshape\([^()]*-$")
"""Before a number that numpy takes for "as many as there are", whatever negative one it is."""


def python_changes(text: str) -> list[Change]:
    """Return all changes of a module; type hints, docstrings and `__all__` stay as they are."""
    return list(_Python(text).changes())


class _Python:
    def __init__(self, text: str) -> None:
        self.text = text
        self.tree = ast.parse(text)
        lines = text.splitlines(keepends=True)
        self.starts = [0]
        for line in lines:
            self.starts.append(self.starts[-1] + len(line))
        self.lines = lines

    def at(self, line: int, column: int) -> int:
        """Offset in characters of a place that the tree gives in bytes."""
        prefix = self.lines[line - 1].encode()[:column].decode()
        return self.starts[line - 1] + len(prefix)

    def span(self, node: ast.AST) -> tuple[int, int]:
        assert isinstance(node, (ast.expr, ast.stmt))
        stop = (node.end_lineno or node.lineno, node.end_col_offset or 0)
        return self.at(node.lineno, node.col_offset), self.at(*stop)

    def changes(self) -> Iterator[Change]:
        for node in self._nodes(self.tree):
            yield from filter(self._is_seen, self._of(node))

    def _is_seen(self, change: Change) -> bool:
        before = self.text[max(0, change.start - 40) : change.start]
        return not (change.what == "1 + 1" and _LENGTH_TO_FIND.search(before))

    def _nodes(self, node: ast.AST) -> Iterator[ast.AST]:
        """Walk what runs: no annotations, no docstrings, no imports, no `__all__`."""
        if isinstance(node, (ast.Import, ast.ImportFrom, ast.JoinedStr)):
            return
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            return
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return
        yield node
        if isinstance(node, ast.keyword) and node.arg in UNSEEN:
            return
        skipped = {"annotation", "returns", "type_comment"}
        for name, value in ast.iter_fields(node):
            if name in skipped:
                continue
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST):
                    yield from self._nodes(child)

    def _of(self, node: ast.AST) -> Iterator[Change]:
        if isinstance(node, ast.Compare) and len(node.ops) == 1:
            yield from self._operator(node.left, node.comparators[0])
        elif isinstance(node, ast.BinOp):
            yield from self._operator(node.left, node.right)
        elif isinstance(node, ast.BoolOp):
            yield from self._operator(node.values[0], node.values[1])
        elif isinstance(node, (ast.If, ast.While, ast.IfExp)):
            start, stop = self.span(node.test)
            yield Change(start, stop, f"(not ({self.text[start:stop]}))", "condition negated")
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.Not, ast.USub, ast.Invert)):
            start, stop = self.span(node)
            yield Change(
                start, stop, f"({self.text[slice(*self.span(node.operand))]})", "sign lost"
            )
        elif isinstance(node, ast.Constant):
            yield from self._constant(node)
        elif isinstance(node, (ast.Expr, ast.AugAssign, ast.Raise, ast.Continue, ast.Break)):
            yield from self._removed(node)
        elif isinstance(node, ast.Call):
            yield from self._swapped(node)
        elif isinstance(node, ast.Return) and node.value is not None:
            start, stop = self.span(node.value)
            if self.text[start:stop] not in ("None", "False"):  # as false as None
                yield Change(start, stop, "None", "returns None")

    def _operator(self, left: ast.expr, right: ast.expr) -> Iterator[Change]:
        start, stop = self.span(left)[1], self.span(right)[0]
        old = self.text[start:stop].strip(" ()\n")
        if old in OPERATORS:
            at = self.text.index(old, start, stop)
            yield Change(at, at + len(old), OPERATORS[old], f"{old} becomes {OPERATORS[old]}")

    def _constant(self, node: ast.Constant) -> Iterator[Change]:
        start, stop = self.span(node)
        if isinstance(node.value, bool):
            yield Change(start, stop, str(not node.value), f"{node.value} negated")
        elif isinstance(node.value, int):
            yield Change(start, stop, str(node.value + 1), f"{node.value} + 1")
            yield Change(start, stop, f"({node.value - 1})", f"{node.value} - 1")
        elif isinstance(node.value, float):
            yield Change(start, stop, f"({node.value!r} * 1.5 + 0.125)", f"{node.value} changed")

    def _removed(self, node: ast.stmt) -> Iterator[Change]:
        if isinstance(node, ast.Expr) and isinstance(node.value, (ast.Constant, ast.Yield)):
            return
        yield Change(*self.span(node), "pass", "statement removed")

    def _swapped(self, node: ast.Call) -> Iterator[Change]:
        given = node.args[:2]
        if ast.unparse(node.func).split(".")[-1] in SYMMETRIC:
            return
        if len(given) < 2 or any(isinstance(one, ast.Starred) for one in given):
            return
        (a, b), (c, d) = self.span(given[0]), self.span(given[1])
        one, other = self.text[a:b], self.text[c:d]
        if one != other and not isinstance(given[0], ast.Constant):
            yield Change(a, d, f"{other}{self.text[b:c]}{one}", "arguments swapped")


# ---------------------------------------------------------------------------- C++

TOKENS = {
    "<=": ("<", "=="),
    ">=": (">", "=="),
    "==": ("!=",),
    "!=": ("==",),
    "&&": ("||",),
    "||": ("&&",),
    " < ": (" <= ", " >= "),
    " > ": (" >= ", " <= "),
    " + ": (" - ",),
    " - ": (" + ",),
    " * ": (" / ",),
    "++": ("--",),
    "true": ("false",),
    "false": ("true",),
    "continue;": (";",),
    "break;": (";",),
}
_PATTERN = re.compile(
    r"(?P<skip>//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])+'|#[^\n]*|template\s*<[^>]*>"
    r"|\bfor \([^;]*;|operator[^(]*\()"
    r"|(?P<token><=(?!>)|>=|==|!=|&&(?=\s)|\|\|| < | > | \+ | - | \* |\+\+|\btrue\b|\bfalse\b"
    r"|continue;|break;)"
    r"|(?P<number>\b\d+\b(?![.\w']))"
    r"|(?P<call>(?<=\n)\s+[a-z_.>-]+\([^;{}]*\);)",
    re.DOTALL,
)


def cpp_changes(text: str) -> list[Change]:
    """Return all changes of a header: operators, constants, flow, calls whose value is unused."""
    found = []
    for match in _PATTERN.finditer(text):
        start, stop = match.span()
        if match["token"]:
            for new in TOKENS[match["token"]]:
                found.append(Change(start, stop, new, f"{match['token'].strip()} becomes {new}"))
        elif match["number"]:
            value = int(match["number"])
            found.append(Change(start, stop, str(value + 1), f"{value} + 1"))
        elif match["call"]:
            found.append(Change(start, stop, ";", f"removed: {match['call'].strip()[:50]}"))
    return found
