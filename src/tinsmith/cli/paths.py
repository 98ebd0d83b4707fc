"""Paths of a command: compared with each other before anything is read or written."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from .output.streams import escape_unprintable

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from click.shell_completion import CompletionItem

__all__ = [
    "INPUT",
    "LINES",
    "OUTPUT",
    "STANDARD",
    "Named",
    "describe_inputs",
    "make_title",
    "name_file",
    "name_files",
    "require_separate",
    "split_output",
]

_SHOWN = 5
STANDARD = Path("-")
"""Standard input or output; a file of that name is ``./-``."""

_RASTER = (".prj", ".hdr", ".aux", ".ovr", ".msk", ".tfw", ".wld", ".stx", ".clr", ".rrd")
_PARTS = {
    ".shp": (".shx", ".dbf", ".prj", ".cpg", ".qpj", ".sbn", ".sbx", ".qix", ".idx"),
    ".tab": (".dat", ".map", ".id", ".ind"),
    ".mif": (".mid",),
    ".obj": (".mtl",),
    **dict.fromkeys((".tif", ".tiff", ".img", ".bil", ".bip", ".bsq", ".flt", ".asc"), _RASTER),
    **dict.fromkeys((".png", ".jpg", ".jp2"), (*_RASTER, ".pgw", ".jgw", ".j2w")),
}
"""Suffixes of files that stand beside one and belong to it."""
_MORE_PARTS = (".aux.xml", ".xml", ".ovr", ".msk", "-wal", "-shm", "-journal")
"""What is appended to the whole name of the file that they belong to."""


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


_LAYERED = (".gpkg",)
"""Suffixes of files of several layers."""


def split_output(path: Path) -> tuple[Path, str | None]:
    """Split the name of a layer off a file to write (``site.gpkg:contours``), if there is one."""
    before, colon, layer = str(path).rpartition(":")
    is_layered = before.lower().endswith(_LAYERED) and not {"/", os.sep} & {*layer}
    if colon and layer and is_layered and not path.exists():
        return Path(before), layer
    return path, None


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
    """Refuse outputs that would overwrite an input, a part of one, or each other.

    Files are compared by what they are, not by what they are called: links, other ways to the same
    folder, and capitals where the system does not tell them apart.

    Raises
    ------
    click.UsageError
    WriteError
        If an output cannot be written where it should be.
    """
    from .._atomic import require_writable

    taken: dict[object, Named] = {}
    for one in _drop_streams(inputs, "input"):
        for path in [one.path, *_list_parts(one.path)]:
            for key in _identify(path):
                taken.setdefault(key, one)
    files = _drop_streams(outputs, "output")
    for one in files:
        keys = _identify(one.path)
        for before in (taken[key] for key in keys if key in taken):
            raise click.UsageError(_describe_collision(one, before, is_input=before not in files))
        taken.update(dict.fromkeys(keys, one))
    for one in files:
        if not _is_tile_folder(one.path):
            require_writable(one.path)


def _is_tile_folder(path: Path) -> bool:
    """Whether a folder of tiles is there, which only a writer of such folders replaces."""
    return path.is_dir() and (path / "layer.json").is_file()


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


def _list_parts(path: Path) -> list[Path]:
    """Return the files that belong to a file and are there, such as the parts of a shapefile."""
    if not path.name:
        return []
    suffixes = _PARTS.get(path.suffix.lower(), ())
    names = [path.with_name(path.name + more) for more in _MORE_PARTS]
    names += [path.with_suffix(one) for low in suffixes for one in (low, low.upper())]
    return [name for name in names if os.path.lexists(name)]
