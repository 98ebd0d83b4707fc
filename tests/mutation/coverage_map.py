"""Which tests run a place of the package, by what `mutation.tracing` noted of each test.

The map is built once (`python -m mutation map`) and kept in `build/mutants`. Tests written since
are added by `python -m mutation map --only test_of_mine`.
"""

from __future__ import annotations

import ast
import json
from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import cached_property
from pathlib import Path


class CoverageMap:
    """Tests by the lines that they run, and how long each test takes."""

    def __init__(self, folder: Path, durations: Path) -> None:
        self.folder = folder
        self.seconds: dict[str, float] = (
            json.loads(durations.read_text()) if durations.exists() else {}
        )

    @cached_property
    def runs(self) -> dict[str, dict[int, set[str]]]:
        """Tests by file of the package and line."""
        runs: dict[str, dict[int, set[str]]] = defaultdict(lambda: defaultdict(set))
        for test, files in self._records():
            for name, lines in files.items():
                for line in lines:
                    runs[name][line].add(test)
        return runs

    def _records(self) -> Iterator[tuple[str, dict[str, list[int]]]]:
        for path in self.folder.glob("tests-*.json"):
            yield from json.loads(path.read_text()).items()
        for path in self.folder.glob("child-*.json"):
            child = json.loads(path.read_text())
            yield child["test"], child["lines"]

    def tests_of(self, name: str, text: str, line: int) -> list[str]:
        """Return the tests that run a line of a module, those that take least time first.

        Where none does by this map, those that run its function, then those that run functions
        which name what the line assigns, then all that run functions of the module.
        """
        runs = self.runs.get(name, {})
        for lines in places_that_tell(ast.parse(text), line):
            tests = set().union(*(runs.get(one, set()) for one in lines))
            if tests:
                return sorted(tests, key=lambda test: (self.seconds.get(test, 0.05), test))
        return []


def places_that_tell(tree: ast.Module, line: int) -> Iterator[Iterable[int]]:
    """Yield sets of lines, from the statement of a line to all functions of the module."""
    functions = [
        n for n in ast.walk(tree) if isinstance(n, (ast.FunctionDef, ast.AsyncFunctionDef))
    ]
    around = [one for one in functions if first_line(one) <= line <= (one.end_lineno or 0)]
    if around:
        function = max(around, key=lambda one: one.lineno)
        if line >= function.body[0].lineno:
            yield own_lines(innermost_statement(function, line))
        yield body_lines(function)
    else:
        names = names_assigned(innermost_statement(tree, line))
        users = [one for one in functions if names & names_in(one)]
        yield [n for one in users for n in body_lines(one)]
    yield [n for one in functions for n in body_lines(one)]


def first_line(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    return min([function.lineno, *(one.lineno for one in function.decorator_list)])


def body_lines(function: ast.FunctionDef | ast.AsyncFunctionDef) -> range:
    return range(function.body[0].lineno, (function.end_lineno or 0) + 1)


def innermost_statement(parent: ast.AST, line: int) -> ast.AST:
    around = [
        node
        for node in ast.walk(parent)
        if isinstance(node, ast.stmt) and node.lineno <= line <= (node.end_lineno or 0)
    ]
    return max(around, key=lambda one: (one.lineno, -(one.end_lineno or 0)), default=parent)


def own_lines(statement: ast.AST) -> range:
    """Return the lines of a statement; of one with a body, those before it."""
    assert isinstance(statement, ast.stmt)
    body = getattr(statement, "body", None)
    stop = body[0].lineno if body else (statement.end_lineno or 0) + 1
    return range(statement.lineno, max(stop, statement.lineno + 1))


def names_assigned(statement: ast.AST) -> set[str]:
    targets = {n.id for n in ast.walk(statement) if isinstance(n, ast.Name) and is_stored(n)}
    return targets or {getattr(statement, "name", "")}


def is_stored(name: ast.Name) -> bool:
    return isinstance(name.ctx, ast.Store)


def names_in(function: ast.AST) -> set[str]:
    nodes = list(ast.walk(function))
    attributes = {node.attr for node in nodes if isinstance(node, ast.Attribute)}
    return attributes | {node.id for node in nodes if isinstance(node, ast.Name)}
