"""Outputs of several kinds: which file holds what, planned before any work is done."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from .files import describe_written, plan_outputs, write_figure, write_outputs
from .output.failures import Failure
from .paths import STANDARD, Named, describe_leftovers, require_separate, split_output

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from .files import Output
    from .options import Writing
    from .output.console import Console

__all__ = ["Products", "plan_products"]

_PICTURE = ".png"
_TABLES = (".csv", ".tsv", ".txt", ".json")
_DOTS = 150


@dataclass(frozen=True, kw_only=True)
class Products:
    """Outputs by what they hold: tables, features, TINs and pictures."""

    console: Console
    outputs: dict[str, list[Output]]
    pictures: list[Path] = field(default_factory=list)

    def holds(self, kind: str) -> bool:
        """Whether something of a kind is to be written."""
        return bool(self.pictures if kind == "picture" else self.outputs.get(kind))

    def write(self, kind: str, product: Any) -> None:
        """Write a product to all outputs of its kind."""
        write_outputs(product, self.outputs.get(kind, []), self.console)

    def draw(self, make_figure: Callable[[], Any]) -> None:
        """Write the pictures."""
        for path in self.pictures:
            with self.console.step("Drawing"):
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

    What there will be is of the ``kinds`` "Table", "Features", "TIN" and "picture".
    """
    plain = [path for path in paths if split_output(path)[1] is None]
    require_separate(inputs, [Named(path, "--output") for path in plain])
    groups: dict[str, list[Path]] = {}
    for path in paths:
        groups.setdefault(_find_kind(split_output(path)[0], writing, kinds), []).append(path)
    pictures = groups.pop("picture", [])
    console.note(describe_leftovers(pictures))
    if sum(path == STANDARD for path in paths) > 1:
        raise Failure("'-o -' is given twice: standard output takes one thing.")
    planned = {
        kind: plan_outputs(group, writing, inputs=(), console=console, kinds=(kind,))
        for kind, group in groups.items()
    }
    return Products(console=console, outputs=planned, pictures=pictures)


def _find_kind(path: Path, writing: Writing, kinds: Sequence[str]) -> str:
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
