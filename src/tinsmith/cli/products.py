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

    from ..terrain import Features, Table
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
    tabulates: bool = False
    """Whether tables are those of the features' columns."""

    def holds(self, kind: str) -> bool:
        """Whether something of a kind is to be written."""
        return bool(self.pictures if kind == "picture" else self.outputs.get(kind))

    def write(self, kind: str, product: Any) -> None:
        """Write a product to all outputs of its kind."""
        write_outputs(product, self.outputs.get(kind, []), self.console)
        if kind == "Features" and self.tabulates and self.holds("Table"):
            table, note = _tabulate(product)
            self.console.note(note)
            write_outputs(table, self.outputs["Table"], self.console)

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

    What there will be is of the ``kinds`` "Table", "Features", "TIN" and "picture". Features that
    have no table of their own are written to tables too.
    """
    tabulates = "Features" in kinds and "Table" not in kinds
    if tabulates:
        kinds = (*kinds, "Table")
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
    return Products(console=console, outputs=planned, pictures=pictures, tabulates=tabulates)


def _tabulate(features: Features) -> tuple[Table, list[str]]:
    """Return features as a table: of points their coordinates too; and what it lacks, if any."""
    from ..base.results.table import tabulate_columns
    from ..io.tables.csv_tables import tabulate_points

    if features.kind == "points":
        return tabulate_points(features), []
    return tabulate_columns(features), [
        f"Tables hold the columns of the {features.kind}, not their geometries: GeoPackage and "
        "GeoJSON hold both."
    ]


def _find_suffix(path: Path) -> str:
    """Return the longest suffix of a format that a name ends in: .city.json before .json."""
    from ..io import known_formats

    suffixes = {suffix for one in known_formats() for suffix in one.suffixes}
    fitting = [suffix for suffix in suffixes if path.name.lower().endswith(suffix)]
    return max(fitting, key=len, default=path.suffix.lower())


def _find_kind(path: Path, writing: Writing, kinds: Sequence[str]) -> str:
    """Return what a suffix, or a format that is named, is meant for."""
    from ..io import known_formats

    name = writing.output_format
    suffix = _find_suffix(path) if name is None else f".{name.strip().lower().lstrip('.')}"
    if suffix in _TABLES and "Table" in kinds:
        return "Table"
    if suffix == _PICTURE and "picture" in kinds:
        return "picture"
    for kind in ("Features", "TIN"):
        able = [one for one in known_formats() if one.write is not None and kind in one.writes]
        if kind in kinds and any(suffix in (*one.suffixes, f".{one.name}") for one in able):
            return kind
    return next(kind for kind in kinds if kind != "picture")  # whose refusal names what it takes
