"""Paths of a command: compared with each other before anything is read or written."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from .output import escape_unprintable

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from click.shell_completion import CompletionItem

_SHOWN = 5
STANDARD = Path("-")
"""Standard input or output; a file of that name is ``./-``."""


def name_file(path: Path) -> str:
    """Return what a file to read is called in summaries."""
    return "standard input" if path == STANDARD else escape_unprintable(str(path))


def name_files(paths: Sequence[Path]) -> str:
    """Return what files to read are called in summaries."""
    more = f" and {len(paths) - _SHOWN:,} more" if len(paths) > _SHOWN else ""
    return ", ".join(map(name_file, paths[:_SHOWN])) + more


def describe_inputs(paths: Sequence[Path]) -> str | list[str]:
    """Return the name of a file for a record, or those of several."""
    names = [str(path) for path in paths]
    return names[0] if len(names) == 1 else names


def make_title(path: Path) -> str:
    """Return the title of a picture of what is in a file."""
    return "" if path == STANDARD else path.stem.replace("_", " ")


def split_output(path: Path) -> tuple[Path, str | None]:
    """Split the name of a layer off a file to write (``site.gpkg:contours``), if there is one."""
    from ..io.registry import known_formats, list_claims

    before, colon, layer = str(path).rpartition(":")
    if not (colon and layer) or {"/", os.sep} & {*layer} or path.exists():
        return path, None
    is_layered = any(one.has_layers for one in list_claims(known_formats(), Path(before)))
    return (Path(before), layer) if is_layered else (path, None)


class Named(NamedTuple):
    """A path and where on the command line it stands, such as ``the input`` or ``--report``."""

    path: Path
    place: str


class _Name(click.ParamType["Path"]):
    """A file's name, of which ``-`` means the standard stream, and ``./-`` a file called so."""

    name = "file"

    def shell_complete(
        self,
        ctx: click.Context,  # noqa: ARG002 - click's signature
        param: click.Parameter,  # noqa: ARG002 - click's signature
        incomplete: str,
    ) -> list[CompletionItem]:
        """Let the shell complete names of files."""
        from click.shell_completion import CompletionItem

        return [CompletionItem(incomplete, type="file")]

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        """Return the path."""
        text = os.fsdecode(value)
        if not text or "\0" in text:
            self.fail("a name is needed, and there is none.", param, ctx)
        path = Path(text)
        if path == STANDARD and text != "-":
            return Path.cwd() / "-"
        return path


class _File(_Name):
    """A file's name where no standard stream can stand."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        """Return the path."""
        path = super().convert(value, param, ctx)
        if path == STANDARD:
            self.fail("'-' is a standard stream: name a file ('./-' if it is called so).")
        return path


INPUT = _Name()
OUTPUT = _File()
LINES = _File()


def require_separate(inputs: Iterable[Named], outputs: Sequence[Named]) -> None:
    """Refuse outputs that would overwrite an input, a file that is read with it, or each other.

    Files are compared by what they are, not by what they are called: links, other ways to the same
    folder, and capitals where the system does not tell them apart. An output that cannot be written
    where it should be is a WriteError.
    """
    from ..base.atomic import require_writable
    from ..io.registry import is_replaceable_folder, list_sources

    taken: dict[object, Named] = {}
    for one in _drop_streams(inputs, "input"):
        _require_outside(one, outputs)
        for path in [one.path, *list_sources(one.path)]:
            for key in _identify(path):
                taken.setdefault(key, one)
    files = _drop_streams(outputs, "output")
    for one in files:
        keys = _identify(one.path)
        for before in (taken[key] for key in keys if key in taken):
            raise click.UsageError(_describe_collision(one, before, is_input=before not in files))
        _require_spared(one, taken)
        taken.update(dict.fromkeys(keys, one))
    for one in files:
        if not is_replaceable_folder(one.path):
            require_writable(one.path)


def describe_leftovers(outputs: Iterable[Path]) -> list[str]:
    """Name what earlier runs left, which were killed before they could clear up."""
    from ..base.atomic import find_dead_scratch, find_leftovers

    beside = [
        f"'{name_file(one)}' was left by a run that did not end, unless one is writing "
        f"'{name_file(path)}' now: delete it."
        for path in dict.fromkeys(outputs)
        if path != STANDARD
        for one in find_leftovers(path)
    ]
    return beside + [
        f"'{name_file(one)}' was left by a run that was ended: delete it."
        for one in find_dead_scratch()
    ]


def _require_outside(folder: Named, outputs: Sequence[Named]) -> None:
    """Refuse outputs that would replace files of a folder that is read."""
    if not folder.path.is_dir():
        return
    place = Path(os.path.realpath(folder.path))
    for one in outputs:
        if one.path.is_file() and place in Path(os.path.realpath(one.path)).parents:
            raise click.UsageError(
                f"'{one.path}' is a file of '{folder.path}', {folder.place}: it cannot be the "
                f"output too ({one.place})."
            )


def _require_spared(output: Named, read: dict[object, Named]) -> None:
    """Refuse an output beside which files are written, or removed, that are read."""
    from ..io.registry import list_written_beside

    for path in list_written_beside(output.path):
        if os.path.lexists(path):
            for before in (read[key] for key in _identify(path) if key in read):
                is_part = _identify(path) != _identify(before.path)
                what = f" a part of '{before.path}'," if is_part else ""
                raise click.UsageError(
                    f"'{path}' is{what} {before.place}, and '{output.path}' ({output.place}) would "
                    "replace it: give the output another name."
                )


def _drop_streams(named: Iterable[Named], what: str) -> list[Named]:
    """Leave a standard stream aside, which can be named once."""
    given = list(named)
    files = [one for one in given if one.path != STANDARD]
    if len(given) - len(files) > 1:
        raise click.UsageError(f"'-' is named twice: there is one standard {what}.")
    return files


def _describe_collision(one: Named, before: Named, *, is_input: bool) -> str:
    if not is_input:
        if one.place == before.place:
            return f"'{one.path}' is named twice as output."
        return f"'{one.path}' is named twice as output, by {before.place} and by {one.place}."
    part = "" if _identify(one.path) & _identify(before.path) else f" a part of '{before.path}',"
    return f"'{one.path}' is{part} {before.place}: it cannot be the output too ({one.place})."


def _identify(path: Path) -> set[object]:
    """Return what identifies a file: its place, and its number in the file system."""
    place = Path(os.path.realpath(path))
    name = place.name.casefold() if _ignores_case(place.parent) else place.name
    keys: set[object] = {(str(place.parent), name)}
    try:
        found = place.stat()
    except (OSError, ValueError):
        return keys
    if found.st_ino:
        keys.add((found.st_dev, found.st_ino))
    return keys


def _ignores_case(folder: Path) -> bool:
    """Whether the system takes capitals in names for small letters, as far as the folder shows."""
    if not folder.name:
        return False
    other = folder.with_name(folder.name.swapcase())
    try:
        return other != folder and other.samefile(folder)
    except (OSError, ValueError):
        return False
