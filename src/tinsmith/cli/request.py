"""What a command on surfaces was asked for, and the steps that all of them take."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import wraps
from time import perf_counter
from typing import TYPE_CHECKING, Any

from .files import (
    add_lines,
    build_tin,
    list_inputs,
    note_surfaces,
    plan_outputs,
    read_input,
    read_tin,
)
from .options import (
    CODE_FLAGS,
    console_options,
    reading_options,
    triangulating_options,
    writing_options,
)
from .output.failures import Failure
from .paths import Named
from .products import Products, plan_products

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from contextlib import AbstractContextManager
    from pathlib import Path

    from ..tin import TIN
    from .options import Reading, Triangulating, Writing
    from .output.console import Console, Row
    from .parameters import Decorator

__all__ = ["Request", "surface_options"]


@dataclass(frozen=True, kw_only=True)
class Request:
    """Options that commands on surfaces share, and the steps from them to the last words."""

    outputs: tuple[Path, ...]
    reading: Reading
    how: Triangulating
    writing: Writing
    console: Console
    started: float = field(default_factory=perf_counter)
    """When the command began."""

    def plan(self, inputs: Sequence[Named], kind: str, *, report: Path | None = None) -> Products:
        """Choose the formats of outputs that all hold one thing, before any work is done."""
        planned = plan_outputs(
            self.outputs,
            self.writing,
            inputs=inputs,
            console=self.console,
            report=report,
            kinds=(kind,),
        )
        return Products(console=self.console, outputs={kind: planned})

    def plan_products(self, inputs: Sequence[Named], *kinds: str) -> Products:
        """Choose what each output holds, of several things, before any work is done."""
        return plan_products(
            self.outputs, self.writing, inputs=inputs, console=self.console, kinds=kinds
        )

    def list_inputs(self, *files: Path, more: Sequence[Named] = ()) -> list[Named]:
        """Return all files that are read: surfaces, lines, and others."""
        return [*list_inputs(*files, how=self.how), *more]

    def step(self, text: str) -> AbstractContextManager[Callable[[float], None]]:
        """Return the context in which long work shows its progress."""
        return self.console.step(text)

    def read_tin(self, file: Path) -> TIN:
        """Read a TIN, or points and build theirs."""
        return read_tin(file, self.reading, self.how, self.console)[0]

    def read_tins(self, files: Sequence[Path]) -> list[TIN]:
        """Read TINs, or points and build theirs; files of lines are for the one file of points.

        Codes, and the longest edge, are for each file of points.

        Raises
        ------
        Failure
            If it cannot be told for which file an option is.
        """
        from ..tin import TIN

        found = [read_input(file, self.reading, self.console) for file in files]
        self._require_points(sum(not isinstance(one, TIN) for one in found))
        surfaces = [
            one
            if isinstance(one, TIN)
            else build_tin(add_lines(one, self.how, self.console), self.how, self.console)
            for one in found
        ]
        note_surfaces(surfaces, self.console)
        return surfaces

    def _require_points(self, n_surveys: int) -> None:
        of_each = [f"--{name.replace('_', '-')}" for name in ("max_edge", *CODE_FLAGS)]
        given = self.how.shaping
        named = [flag for flag in given if flag not in of_each]
        if (named and n_surveys != 1) or (given and n_surveys == 0):
            flag = (named or given)[0]
            raise Failure(
                f"{flag} needs {'a' if n_surveys == 0 else 'one'} file of points, and there are "
                f"{n_surveys}: 'tinsmith build' makes TINs of them first."
            )

    def finish(
        self, planned: Products, rows: Sequence[Row], describe: Callable[[], dict[str, Any]]
    ) -> None:
        """Tell what was done: a summary for people, and a record as JSON if it was asked for."""
        written = [("Written", planned.text)] if planned.paths else []
        seconds = perf_counter() - self.started
        self.console.summarise([*rows, *written, ("Time", f"{seconds:.2f} s")])
        if self.console.as_json:
            record = describe()
            record.setdefault("outputs", [str(path) for path in planned.paths])
            self.console.emit_record(record)


def surface_options(reading_options: Decorator = reading_options) -> Decorator:
    """Return a decorator that adds the shared options, and hands them over as ``request``.

    The options of reading may be those that a command has in their place.
    """
    groups = (reading_options, triangulating_options, writing_options, console_options)

    def decorate(function: Any) -> Any:
        @wraps(function)
        def gathering(**given: Any) -> Any:
            shared = ("outputs", "reading", "how", "writing", "console")
            request = Request(**{name: given.pop(name) for name in shared})
            return function(**given, request=request)

        decorated: Any = gathering
        for group in reversed(groups):
            decorated = group(decorated)
        return decorated

    return decorate
