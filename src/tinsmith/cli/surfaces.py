"""What commands that compare two surfaces share: reading both, and outputs of several kinds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .files import (
    add_lines,
    build_tin,
    describe_written,
    list_inputs,
    plan_outputs,
    read_input,
    write_figure,
    write_outputs,
)
from .options import CODE_FLAGS
from .output.failures import Failure
from .paths import STANDARD, Named, require_separate

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from ..tin import TIN
    from .files import Output
    from .options import Reading, Triangulating, Writing
    from .output.console import Console

__all__ = ["Products", "plan_products", "read_surfaces", "surface_inputs"]

_PICTURE = ".png"
_TABLES = (".csv", ".tsv", ".txt", ".json")
_DOTS = 150


@dataclass(frozen=True, kw_only=True)
class Products:
    """Outputs by what they hold: tables, features, TINs and pictures."""

    outputs: dict[str, list[Output]]
    pictures: list[Path]

    def holds(self, kind: str) -> bool:
        """Whether something of a kind is to be written."""
        return bool(self.pictures if kind == "picture" else self.outputs.get(kind))

    def write(self, kind: str, product: Any, console: Console) -> None:
        """Write a product to all outputs of its kind."""
        write_outputs(product, self.outputs.get(kind, []), console)

    def draw(self, make_figure: Callable[[], Any], console: Console) -> None:
        """Write the pictures."""
        for path in self.pictures:
            with console.steps() as steps, steps.step("Drawing"):
                write_figure(make_figure(), path, dpi=_DOTS)

    @property
    def paths(self) -> list[Path]:
        """All of them."""
        return [one.path for group in self.outputs.values() for one in group] + self.pictures

    @property
    def text(self) -> str:
        """What was written, a line each."""
        from .output.summaries import describe_file_size

        texts = [describe_written(group) for group in self.outputs.values() if group]
        return "\n".join(texts + [f"{path} ({describe_file_size(path)})" for path in self.pictures])


def plan_products(
    paths: Sequence[Path],
    writing: Writing,
    *,
    inputs: Sequence[Named],
    console: Console,
    kinds: Sequence[str],
) -> Products:
    """Choose what each output holds, before any work is done.

    Parameters
    ----------
    paths : sequence of Path
    writing : Writing
    inputs : sequence of Named
    console : Console
    kinds : sequence of str
        What there will be, of "Table", "Features", "TIN" and "picture".
    """
    require_separate(inputs, [Named(path, "--output") for path in paths])
    groups: dict[str, list[Path]] = {}
    for path in paths:
        groups.setdefault(_kind_of(path, writing, kinds), []).append(path)
    pictures = groups.pop("picture", [])
    if sum(path == STANDARD for path in paths) > 1:
        raise Failure("'-o -' is given twice: standard output takes one thing.")
    planned = {
        kind: plan_outputs(group, writing, inputs=(), console=console, kinds=(kind,))
        for kind, group in groups.items()
    }
    return Products(outputs=planned, pictures=pictures)


def _kind_of(path: Path, writing: Writing, kinds: Sequence[str]) -> str:
    """Return what a suffix, or a format that is named, is meant for."""
    from ..io import known_formats

    name = writing.output_format
    suffix = path.suffix.lower() if name is None else f".{name.strip().lower().lstrip('.')}"
    if suffix in _TABLES:
        return "Table"
    if suffix == _PICTURE and "picture" in kinds:
        return "picture"
    for kind in ("Features", "TIN"):
        able = [one for one in known_formats() if one.write is not None and kind in one.writes]
        if kind in kinds and any(suffix in (*one.suffixes, f".{one.name}") for one in able):
            return kind
    return next(kind for kind in kinds if kind != "picture")  # whose refusal names what it takes


def surface_inputs(files: Sequence[Path], how: Triangulating) -> list[Named]:
    """Return all files that are read."""
    return [Named(file, "the input") for file in files] + list_inputs(files[0], how)[1:]


def read_surfaces(
    files: Sequence[Path], reading: Reading, how: Triangulating, console: Console
) -> list[TIN]:
    """Read TINs, or points and build theirs; files of lines are for the one file of points.

    Raises
    ------
    Failure
        If it cannot be told for which file an option is.
    """
    from ..tin import TIN

    found = [read_input(file, reading, console) for file in files]
    n_surveys = sum(not isinstance(one, TIN) for one in found)
    of_codes = [f"--{name.replace('_', '-')}" for name in CODE_FLAGS]
    named = [flag for flag in how.shaping if flag not in of_codes]
    if (named and n_surveys != 1) or (how.has_codes and n_surveys == 0):
        flag = (named or how.shaping)[0]
        raise Failure(
            f"{flag} needs {'a' if n_surveys == 0 else 'one'} file of points, and there are "
            f"{n_surveys}: 'tinsmith build' makes TINs of them first."
        )
    return [
        one if isinstance(one, TIN) else build_tin(add_lines(one, how, console), how, console)
        for one in found
    ]
